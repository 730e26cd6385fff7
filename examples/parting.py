"""An esper game: a running character parts the grass by a small blast of air, and leaves a trodden way.

The character is an entity with the game's own components and three of tallgrass: where it is (`Pose`), its air
(`WindSource`) and its feet (`Presser`). Left and right turn it, up runs faster. Run it with `python parting.py`.
"""

from dataclasses import dataclass
from math import cos, sin
from typing import Any

import esper
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.model import MaterialGroup
from pyglet.window import key

import tallgrass
from tallgrass import Blast, Pose, Prairie, Presser, Shape, WindSource

SIZE = (960, 540)


@dataclass
class Runner:
    """A character: its speed [m/s], its turning to the right [rad/s], and the distance it has run [m]."""

    speed: float = 4.0
    turning: float = 0.0
    way: float = 0.0


class Run(esper.Processor):
    """Moves characters; their blast moves along, as it is on the same entity as their `Pose`."""

    def process(self, dt: float) -> None:
        """Run on for `dt` [s]."""
        for entity, (runner, pose) in esper.get_components(Runner, Pose):
            yaw, way = pose.yaw + runner.turning * dt, runner.speed * dt
            runner.way += way
            esper.add_component(entity, Pose(pose.x + way * sin(yaw), pose.z - way * cos(yaw), yaw))


class Figure:
    """The model of a character: a body and a head that bob as it runs."""

    def __init__(self) -> None:
        self.batch = pyglet.graphics.Batch()
        sphere: Any = pyglet.model.Sphere  # pyglet declares no types of its arguments
        source = MaterialGroup.default_vert_src, MaterialGroup.default_frag_src
        shader = ShaderProgram(Shader(source[0], "vertex"), Shader(source[1], "fragment"))
        red, skin = (0.75, 0.16, 0.1, 1.0), (0.85, 0.62, 0.45, 1.0)
        self.body = sphere(0.6, 20, 24, red, batch=self.batch, program=shader)
        self.head = sphere(0.38, 20, 24, skin, batch=self.batch, program=shader)

    def draw(self, place: Vec3, way: float) -> None:
        """Draw it in the window's own view, with its feet at a place."""
        up = place + Vec3(0.0, 0.06 * abs(sin(2.6 * way)), 0.0)
        self.body.matrix = Mat4.from_translation(up + Vec3(0.0, 0.75, 0.0)) @ Mat4.from_scale(Vec3(0.9, 1.5, 0.8))
        self.head.matrix = Mat4.from_translation(up + Vec3(0.0, 1.4, 0.0))
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.batch.draw()
        gl.glDisable(gl.GL_DEPTH_TEST)


class Game:
    """The window, the world, and the camera behind the character."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Parting", resizable=True)
        self.prairie = Prairie.load("gust", preset="medium")
        tallgrass.install()
        esper.add_processor(Run())
        step = Blast(outline=Shape(disc=1.9), strength=0.95, soft=0.8)
        treads = Pose(0.0, 45.0, 0.3), Presser(radius=0.35)
        self.runner = esper.create_entity(Runner(turning=0.12), WindSource(step, "runner"), *treads)
        self.figure = Figure()
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)

    def update(self, dt: float) -> None:
        """Let esper do everything: the prairie's time is one of its processors."""
        runner = esper.component_for_entity(self.runner, Runner)
        if any(self.keys.data.values()):
            runner.turning = 1.5 * (self.keys[key.RIGHT] - self.keys[key.LEFT])
            runner.speed = 7.0 if self.keys[key.UP] else 4.0
        esper.process(dt)

    def on_draw(self) -> None:
        """Draw the character, then the prairie around it."""
        pose = esper.component_for_entity(self.runner, Pose)
        behind = pose.x - 5.2 * sin(pose.yaw), pose.z + 5.2 * cos(pose.yaw)
        here, there = (float(y) for y in self.prairie.height_at([(pose.x, pose.z), behind]))
        feet, eye = Vec3(pose.x, here, pose.z), Vec3(behind[0], max(there + 1.5, here + 3.0), behind[1])
        self.window.clear()
        self.window.projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 45.0)
        self.window.view = Mat4.look_at(eye, feet + Vec3(0.0, 0.9, 0.0), Vec3(0.0, 1.0, 0.0))
        self.figure.draw(feet, esper.component_for_entity(self.runner, Runner).way)
        self.prairie.draw(self.window.view, self.window.projection)


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
