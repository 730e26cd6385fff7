"""A first-person game with pyglet's own camera: walk among boulders that stand in the grass, and leave a way in it.

The walker is an entity with a `Presser`. The game sets `window.view` and `window.projection` as any pyglet game does,
and hands both to the prairie. W, A, S and D walk, the mouse looks, Escape ends. Run it with `python first_person.py`.
"""

from math import cos, pi, radians, sin
from typing import Any

import esper
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.window import key

from tallgrass import Pose, Prairie, Presser, Shade

SIZE = (960, 540)
BOULDERS = ((-1.2, 60.5, 0.8), (3.5, 57.5, 1.2), (-6.5, 55.0, 1.5), (-1.0, 47.0, 1.8), (9.0, 50.0, 2.4))
"""Places (x, z) and sizes [m]."""

VERTEX = """#version 330 core
in vec3 POSITION;
in vec3 NORMAL;
uniform WindowBlock { mat4 projection; mat4 view; } window;
uniform mat4 model;
out vec3 normal;
out vec3 place;
void main() {
    float lumps = 1.0 + 0.09 * sin(5.0 * POSITION.x + 2.0) * sin(4.0 * POSITION.y) * cos(6.0 * POSITION.z);
    place = (model * vec4(POSITION * lumps, 1.0)).xyz;
    normal = NORMAL + 0.35 * vec3(sin(9.0 * place.x), cos(8.0 * place.y), sin(7.0 * place.z));
    gl_Position = window.projection * window.view * vec4(place, 1.0);
}"""
FRAGMENT = """#version 330 core
in vec3 normal;
in vec3 place;
out vec4 pixel;
void main() {
    float grain = fract(sin(dot(floor(place * 24.0), vec3(12.9, 78.2, 37.7))) * 43758.5);
    float light = 0.35 + 0.65 * max(0.0, dot(normalize(normal), normalize(vec3(0.7, 0.6, -0.4))));
    pixel = vec4(vec3(0.74, 0.71, 0.65) * light * (0.9 + 0.15 * grain), 1.0);
}"""


class Game:
    """The window, the boulders, and the walker among them."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Boulders", resizable=True)
        self.prairie = Prairie.load("gust", preset="medium")
        self.batch = pyglet.graphics.Batch()
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.models = [self.boulder(x, z, size) for x, z, size in BOULDERS]
        self.text = pyglet.text.Label("W A S D and the mouse", 20, 20, font_size=14)
        self.x, self.z, self.yaw, self.pitch = 1.5, 66.0, radians(-10), radians(-8)
        self.feet = esper.create_entity(Presser(radius=0.35), Pose(self.x, self.z))
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw, self.on_mouse_motion)

    def boulder(self, x: float, z: float, size: float) -> pyglet.model.Model:
        """Return a boulder on the ground, in the batch, that casts its shadow on the grass."""
        y = float(self.prairie.height_at([(x, z)])[0]) + 0.3 * size
        esper.create_entity(Shade((x, y, z), size, 1.4 * size))
        sphere: Any = pyglet.model.Sphere  # pyglet declares no types of its arguments
        made: pyglet.model.Model = sphere(2.0, 24, 32, batch=self.batch, program=self.program)
        made.matrix = Mat4.from_translation(Vec3(x, y, z)) @ Mat4.from_scale(Vec3(size, 0.7 * size, size))
        return made

    def update(self, dt: float) -> None:
        """Walk on for `dt` [s] as the held keys say."""
        self.prairie.advance(dt)
        ahead, right = self.keys[key.W] - self.keys[key.S], self.keys[key.D] - self.keys[key.A]
        self.x += 2.0 * dt * (ahead * sin(self.yaw) + right * cos(self.yaw))
        self.z += 2.0 * dt * (right * sin(self.yaw) - ahead * cos(self.yaw))
        esper.add_component(self.feet, Pose(self.x, self.z, self.yaw))

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Look around."""
        self.yaw += 0.003 * dx
        self.pitch = max(-pi / 2.1, min(pi / 2.1, self.pitch + 0.003 * dy))

    def on_draw(self) -> None:
        """Draw boulders, then the prairie, then text: opaque things first, 2D last."""
        flat = self.window.projection
        eye = Vec3(self.x, float(self.prairie.height_at([(self.x, self.z)])[0]) + 1.7, self.z)
        ahead = Vec3(sin(self.yaw) * cos(self.pitch), sin(self.pitch), -cos(self.yaw) * cos(self.pitch))
        self.window.clear()
        self.window.projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 45.0)
        self.window.view = Mat4.look_at(eye, eye + ahead, Vec3(0.0, 1.0, 0.0))
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.batch.draw()
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(self.window.view, self.window.projection)
        self.window.projection, self.window.view = flat, Mat4()
        self.text.draw()


if __name__ == "__main__":
    game = Game()
    game.window.set_exclusive_mouse()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
