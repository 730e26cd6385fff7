"""Two walkers look for each other in tall reeds, each on a half of the window, with a map of both between them.

Both halves and the map are viewers of one prairie, by names of their own; the map's projection is orthographic. Each
walker leaves a way in the grass for the other to find. W, A and D lead the one, the arrow keys the other. Run it with
`python split_screen.py`.
"""

from math import cos, sin
from typing import Any

import esper
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.model import MaterialGroup
from pyglet.window import key

from tallgrass import Pose, Prairie, Presser

SIZE, MAP, ACROSS = (960, 540), 200, 50.0  # pixels; of a side of the map; what that shows [m]
UP, RED, BLUE, INK = Vec3(0.0, 1.0, 0.0), (205, 40, 25, 255), (30, 75, 190, 255), (20, 22, 18, 255)


Color = tuple[int, int, int, int]


class Walker:
    """One of the two: its pose, its feet on the grass, and its model for the other one's view."""

    def __init__(self, name: str, pose: Pose, color: Color, keys: tuple[int, int, int]) -> None:
        self.name, self.color, (self.ahead, self.left, self.right) = name, color, keys
        self.pose, self.batch = pose, pyglet.graphics.Batch()
        self.entity = esper.create_entity(pose, Presser(radius=0.5))
        sphere: Any = pyglet.model.Sphere  # pyglet declares no types of its arguments
        source = MaterialGroup.default_vert_src, MaterialGroup.default_frag_src
        shader = ShaderProgram(Shader(source[0], "vertex"), Shader(source[1], "fragment"))
        self.parts = [
            sphere(1.0, 20, 24, tuple(part / 255 for part in color), batch=self.batch, program=shader) for _ in range(2)
        ]

    def walk(self, dt: float, keys: key.KeyStateHandler, prairie: Prairie) -> None:
        """Walk on for `dt` [s]."""
        yaw = self.pose.yaw + 1.6 * dt * (keys[self.right] - keys[self.left])
        way = 3.0 * dt * keys[self.ahead]
        self.pose = Pose(self.pose.x + way * sin(yaw), self.pose.z - way * cos(yaw), yaw)
        esper.add_component(self.entity, self.pose)
        self.feet = Vec3(self.pose.x, float(prairie.height_at([(self.pose.x, self.pose.z)])[0]), self.pose.z)
        for part, (high, wide, tall) in zip(self.parts, ((0.75, 0.6, 1.5), (1.65, 0.34, 0.38)), strict=True):
            part.matrix = Mat4.from_translation(self.feet + UP * high) @ Mat4.from_scale(Vec3(wide, tall, wide))

    def view(self) -> Mat4:
        """Return its view matrix."""
        eye = self.feet + UP * 2.1
        return Mat4.look_at(eye, eye + Vec3(sin(self.pose.yaw), -0.12, -cos(self.pose.yaw)), UP)


class Game:
    """The window, the prairie and its two walkers."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Hide and seek", resizable=True)
        self.prairie = Prairie.load("meadow", preset="medium")
        self.walkers = (
            Walker("red", Pose(-4.0, 14.0, 0.5), RED, (key.W, key.A, key.D)),
            Walker("blue", Pose(2.0, 1.0, 3.4), BLUE, (key.UP, key.LEFT, key.RIGHT)),
        )
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)

    def update(self, dt: float) -> None:
        """Let both walk on for `dt` [s]."""
        self.prairie.advance(dt)
        for walker in self.walkers:
            walker.walk(dt, self.keys, self.prairie)

    def draw_half(self, walker: Walker, other: Walker, left: int, width: int, height: int) -> None:
        """Draw a walker's view into half of the window, from a column on."""
        gl.glViewport(left, 0, width, height)
        self.window.projection = Mat4.perspective_projection(width / height, 0.1, 2000.0, 50.0)
        self.window.view = walker.view()
        gl.glEnable(gl.GL_DEPTH_TEST)
        other.batch.draw()
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(self.window.view, self.window.projection, viewer=walker.name)

    def draw_map(self, left: int, bottom: int, side: int) -> None:
        """Draw the land between the two from above, north up, into a square of the window, and both on it."""
        one, other = (walker.feet for walker in self.walkers)
        middle, half = (one + other) * 0.5, ACROSS / 2.0
        gl.glViewport(left, bottom, side, side)
        gl.glScissor(left, bottom, side, side)
        gl.glEnable(gl.GL_SCISSOR_TEST)
        gl.glClear(gl.GL_DEPTH_BUFFER_BIT)  # that of the halves
        gl.glDisable(gl.GL_SCISSOR_TEST)
        self.window.projection = Mat4.orthogonal_projection(-half, half, -half, half, 1.0, 400.0)
        self.window.view = Mat4.look_at(middle + UP * 40.0, middle, Vec3(0.0, 0.0, -1.0))
        self.prairie.draw(self.window.view, self.window.projection, viewer="map")
        self.window.view = Mat4()
        self.window.projection = Mat4.orthogonal_projection(-half, half, -half, half, -1.0, 1.0)
        for walker in self.walkers:
            at, color = walker.feet - middle, walker.color
            pyglet.shapes.Circle(at.x, -at.z, 1.6, color=color).draw()
            pyglet.shapes.Line(
                at.x, -at.z, at.x + 5.0 * sin(walker.pose.yaw), -at.z + 5.0 * cos(walker.pose.yaw), 0.8, color
            ).draw()

    def on_draw(self) -> None:
        """Draw both halves, then the map over them."""
        self.window.clear()
        flat, (width, height) = self.window.projection, self.window.get_framebuffer_size()
        for number, walker in enumerate(self.walkers):
            self.draw_half(walker, self.walkers[1 - number], number * width // 2, width // 2, height)
        self.draw_map((width - MAP) // 2, 12, MAP)
        gl.glViewport(0, 0, width, height)
        self.window.projection, self.window.view = flat, Mat4()
        pyglet.shapes.Line(width / 2, MAP + 12, width / 2, height, 2, INK).draw()
        pyglet.shapes.Box((width - MAP) / 2, 12, MAP, MAP, 2, INK).draw()


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
