"""A drive through the night: headlights sweep over tall grass, lanterns come by, and tail lights glow behind.

The road is cleared in the prairie itself. Headlights are entities with a `Lamp` and a `Pose`, which the game moves in
every frame; the car is the game's own, drawn before the prairie. Up and down change the speed. Run it with
`python night_drive.py`.
"""

from math import cos, pi, radians, sin
from typing import Any

import esper
import numpy as np
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.window import key

from tallgrass import Lamp, Pose, Prairie, Road

SIZE, UP = (960, 540), Vec3(0.0, 1.0, 0.0)
PAINT, GLASS, TYRE, RED = (0.30, 0.05, 0.05), (0.03, 0.04, 0.05), (0.02, 0.02, 0.02), (3.0, 0.1, 0.05)
IRON, BULB, POST = (0.05, 0.05, 0.06), (3.0, 1.9, 0.8), 3.2
Boxes = tuple[tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]], ...]
CAR = (  # middle and half size of boxes (right, up, ahead) [m], and their colours; above 1 they shine
    ((0.0, 0.62, 0.0), (0.85, 0.27, 2.1), PAINT),
    ((0.0, 1.08, -0.25), (0.70, 0.26, 1.05), GLASS),
    ((0.0, 1.36, -0.25), (0.66, 0.03, 0.95), PAINT),
    *(((x, 0.32, z), (0.12, 0.32, 0.32), TYRE) for x in (-0.78, 0.78) for z in (-1.35, 1.35)),
    *(((x, 0.72, -2.11), (0.16, 0.07, 0.02), RED) for x in (-0.62, 0.62)),
)
HEADLIGHT = Lamp("#fff1d8", candela=14_000, range=70.0, cone=radians(17.0), pitch=radians(-3.5))
GLOW, LANTERN = Lamp("#ff3018", candela=9.0, range=6.0), Lamp("#ffc37a", candela=500.0, range=26.0)

VERTEX = """#version 330 core
in vec3 place;
in vec3 color;
uniform WindowBlock { mat4 projection; mat4 view; } window;
uniform mat4 model;
out vec3 world;
out vec3 paint;
void main() {
    world = (model * vec4(place, 1.0)).xyz;
    paint = color;
    gl_Position = window.projection * window.view * vec4(world, 1.0);
}"""
FRAGMENT = """#version 330 core
in vec3 world;
in vec3 paint;
out vec4 pixel;
void main() {
    vec3 normal = normalize(cross(dFdx(world), dFdy(world)));
    float sky = 0.5 + 0.5 * normal.y;
    vec3 light = max(max(paint.r, paint.g), paint.b) > 1.0 ? vec3(1.0) : vec3(0.10, 0.13, 0.2) * (0.3 + sky);
    pixel = vec4(sqrt(paint * light), 1.0);
}"""


def road(part: float) -> tuple[float, float]:
    """Return the road's place (x, z) [m] at a fraction of its round."""
    turn = 2.0 * pi * part
    far = 70.0 + 16.0 * sin(3.0 * turn + 1.0) + 7.0 * cos(5.0 * turn)
    return far * sin(turn), -far * cos(turn)


def boxes(parts: Boxes) -> dict[str, Any]:
    """Return triangles of boxes for a vertex list."""
    faces = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            quad = np.array([(a, b, side) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, -1), (1, 1), (-1, 1))])
            faces.append(np.roll(quad, axis + 1, axis=1))
    cube = np.concatenate(faces)
    places = np.concatenate([np.array(middle) + cube * half for middle, half, _ in parts]) * (1.0, 1.0, -1.0)
    colors = np.concatenate([np.tile(color, (36, 1)) for _, _, color in parts])
    return {"place": ("f", places.ravel().tolist()), "color": ("f", colors.ravel().tolist())}


class Game:
    """The window, the prairie, the car and its lights."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="A drive by night", resizable=True)
        grass = {"height": (0.5, 1.0), "width": 0.016, "tip": "#c8b780", "root": "#4c5a2c"}
        self.prairie = Prairie.load(
            {
                "tallgrass": 2,
                "terrain": {"noise": "rolling", "seed": 6, "size": (240, 240), "feature": 70, "scale": 5},
                "grass": {"hay": grass, "clover": {"plant": "flower", "height": (0.3, 0.6), "tip": "#e9dff0"}},
                "wind": [{"kind": "breeze", "direction": 70, "strength": 0.3}],
                "light": {"hour": 22.6, "clouds": 0.5, "ground": "#6b6358", "haze": 900},
            },
            preset="medium",
        )
        self.prairie.clear(Road(tuple(road(part / 160.0) for part in range(161)), width=5.0), soft=0.7)
        self.lights = [(esper.create_entity(HEADLIGHT), x, 0.72, 2.1) for x in (-0.62, 0.62)]
        self.lights.append((esper.create_entity(GLOW), 0.0, 0.72, -2.3))
        posts: Boxes = ()
        for part in (0.06, 0.19, 0.44, 0.71):
            x, z = (1.06 * each for each in road(part))
            y = float(self.prairie.height_at([(x, z)])[0]) + POST
            esper.create_entity(LANTERN, Pose(x, z, y=y))
            posts += ((x, y - 0.5 * POST, -z), (0.04, 0.5 * POST, 0.04), IRON), ((x, y, -z), (0.1, 0.12, 0.1), BULB)
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.car, self.posts = (
            self.program.vertex_list(36 * len(each), gl.GL_TRIANGLES, **boxes(each)) for each in (CAR, posts)
        )
        self.part, self.speed = 0.0, 14.0
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)
        self.update(0.0)

    def update(self, dt: float) -> None:
        """Drive on for `dt` [s]: the car follows the road, and its lights the car."""
        self.prairie.advance(dt)
        self.speed = min(max(self.speed + 8.0 * dt * (self.keys[key.UP] - self.keys[key.DOWN]), 0.0), 30.0)
        (x, z), (ahead_x, ahead_z) = road(self.part), road(self.part + 0.002)
        way = float(np.hypot(ahead_x - x, ahead_z - z))
        self.part = (self.part + 0.002 * dt * self.speed / way) % 1.0
        self.yaw = float(np.arctan2(ahead_x - x, z - ahead_z))
        self.at = Vec3(x, float(self.prairie.height_at([(x, z)])[0]), z)
        for lamp, right, high, ahead in self.lights:
            place = self.at + self.along(right, ahead)
            esper.add_component(lamp, Pose(place.x, place.z, self.yaw, y=place.y + high))

    def along(self, right: float, ahead: float) -> Vec3:
        """Return a vector of the car's frame in the world's."""
        s, c = sin(self.yaw), cos(self.yaw)
        return Vec3(right * c + ahead * s, 0.0, right * s - ahead * c)

    def on_draw(self) -> None:
        """Draw posts and car, then the prairie around them, from behind the car."""
        eye = self.at + self.along(0.0, -7.5)
        eye = Vec3(eye.x, max(self.at.y, float(self.prairie.height_at([(eye.x, eye.z)])[0])) + 2.3, eye.z)
        self.window.clear()
        self.window.view = Mat4.look_at(eye, self.at + self.along(0.0, 6.0) + UP * 1.0, UP)
        self.window.projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 50.0)
        self.program.use()
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.program["model"] = Mat4()
        self.posts.draw(gl.GL_TRIANGLES)
        self.program["model"] = Mat4.from_translation(self.at) @ Mat4.from_rotation(-self.yaw, UP)
        self.car.draw(gl.GL_TRIANGLES)
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(self.window.view, self.window.projection)


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
