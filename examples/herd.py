"""Two hundred animals wander over a prairie as a herd, tread the grass down, and leave paths.

Each is an esper entity: `Animal` is the game's own; tallgrass knows where it is (`Pose`) and what it treads with
(`Presser`). The window shows the time of a frame. Run it with `python herd.py`.
"""

from dataclasses import dataclass
from time import perf_counter

import esper
import numpy as np
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3

import tallgrass
from tallgrass import Pose, Prairie, Presser

MANY, NEAR, APART, FAR = 200, 5.0, 2.4, 20.0  # how many; who is minded; too near; too far from the middle [m]
BALLS = np.array([(-0.5, 0.8, 0.4), (-0.05, 0.8, 0.42), (0.4, 0.85, 0.38), (0.85, 1.1, 0.22)])  # ahead, high, large
RANDOM = np.random.default_rng(3)

VERTEX = """#version 330 core
in vec4 ball;
uniform WindowBlock { mat4 projection; mat4 view; } window;
void main() {
    gl_Position = window.projection * window.view * vec4(ball.xyz, 1.0);
    gl_PointSize = 540.0 * window.projection[1][1] * ball.w / gl_Position.w;
}"""
FRAGMENT = """#version 330 core
out vec4 pixel;
void main() {
    vec2 at = 2.0 * gl_PointCoord - 1.0;
    if (dot(at, at) > 1.0) discard;
    pixel = vec4(vec3(0.5, 0.33, 0.21) * (0.65 + 0.35 * dot(at, vec2(0.5, -0.87))), 1.0);
}"""


@dataclass
class Animal:
    """The game's own component of an animal: its speed [m/s]."""

    speed: float


class Wander(esper.Processor):
    """Moves all animals at once: apart where they crowd, along with their neighbours, and back from too far out."""

    def process(self, dt: float) -> None:
        """Walk on for `dt` [s]."""
        found = esper.get_components(Animal, Pose)
        x, z, yaw = np.array([(pose.x, pose.z, pose.yaw) for _, (_, pose) in found]).T
        place, ahead = x + 1j * z, np.sin(yaw) - 1j * np.cos(yaw)
        apart = place[:, None] - place
        far = np.abs(apart) + np.eye(MANY) * NEAR
        around = (far < NEAR) / np.maximum((far < NEAR).sum(axis=1), 1)[:, None]
        wish = ahead + 0.7 * around @ ahead - 0.04 * place * (np.abs(place) > FAR)
        wish += (apart / far**2 * (far < APART) - 0.1 * around * apart).sum(axis=1)
        yaw += dt * np.clip(np.angle(wish / ahead) + RANDOM.normal(0.0, 0.3, MANY), -1.5, 1.5)
        way = dt * np.array([animal.speed for _, (animal, _) in found])
        for (entity, _), *pose in zip(found, x + way * np.sin(yaw), z - way * np.cos(yaw), yaw, strict=True):
            esper.add_component(entity, Pose(*map(float, pose)))


class Game:
    """The window, the herd, and the time of a frame."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(960, 540, caption="A herd")
        self.prairie = Prairie.load("plain", preset="medium")
        tallgrass.install()
        esper.add_processor(Wander(), priority=1)
        for x, z, yaw in RANDOM.normal((0.0, 0.0, 0.6), (8.0, 8.0, 0.4), (MANY, 3)).tolist():
            esper.create_entity(Animal(RANDOM.uniform(1.1, 1.5)), Pose(x, z, yaw), Presser(radius=0.35, length=0.9))
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.balls = self.program.vertex_list(MANY * len(BALLS), gl.GL_POINTS, ball="f")
        self.text, self.begun = pyglet.text.Label("", 20, 20, font_size=14), perf_counter()
        self.window.push_handlers(self.on_draw)

    def on_draw(self) -> None:
        """Draw the herd, then the prairie around it, then the time since the last frame."""
        x, z, yaw = np.array([(at.x, at.z, at.yaw) for _, (_, at) in esper.get_components(Animal, Pose)]).T[..., None]
        ahead, high, large = BALLS.T[:, None] + 0.0 * x
        balls = np.stack([x + np.sin(yaw) * ahead, high, z - np.cos(yaw) * ahead, large], axis=-1)
        self.balls.set_attribute_data("ball", balls.ravel().tolist())
        middle, back = Vec3(x.mean(), 0.0, z.mean()), Vec3(-np.sin(yaw).mean(), 0.2, np.cos(yaw).mean())
        self.window.clear()
        flat, self.window.projection = self.window.projection, Mat4.perspective_projection(16 / 9, 0.1, 2000.0, 40.0)
        self.window.view = Mat4.look_at(middle + 26.0 * back.normalize(), middle, Vec3(0.0, 1.0, 0.0))
        gl.glEnable(gl.GL_DEPTH_TEST)
        gl.glEnable(gl.GL_PROGRAM_POINT_SIZE)
        self.program.use()
        self.balls.draw(gl.GL_POINTS)
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(self.window.view, self.window.projection)
        self.window.projection, self.window.view = flat, Mat4()
        self.text.text = f"{MANY} animals, {1e3 * (perf_counter() - self.begun):.0f} ms a frame"
        self.text.draw()
        self.begun = perf_counter()


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(esper.process, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
