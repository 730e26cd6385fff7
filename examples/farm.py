"""A farm: a mower cuts a field of hay, poppies are sown in it, and the day's work is saved to a file.

Up drives the mower, left and right turn it, P sows poppies where it stands, S saves and L loads what was saved, in
this run or in another. Run it with `python farm.py`.
"""

from math import cos, sin
from pathlib import Path
from tempfile import gettempdir
from typing import Any

import esper
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.model import MaterialGroup
from pyglet.window import key

from tallgrass import Footprint, Pose, Prairie, Shade

SIZE, SAVED, UP = (960, 540), Path(gettempdir()) / "tallgrass-farm.bin", Vec3(0.0, 1.0, 0.0)
FIELD, WIDTH, STUBBLE = 26.0, 2.4, 0.09  # half the field's side; how wide the mower cuts, and how high [m]
PARTS = (  # middle and size of boxes (right, up, ahead) [m], and their colours
    ((0.0, 0.85, -0.3), (1.1, 0.7, 1.9), (0.12, 0.35, 0.15, 1.0)),
    ((0.0, 1.6, -0.75), (1.0, 0.9, 0.9), (0.10, 0.12, 0.14, 1.0)),
    ((0.0, 0.35, 1.0), (WIDTH, 0.3, 0.8), (0.75, 0.55, 0.1, 1.0)),
    *(((x, 0.55, -0.9), (0.3, 1.1, 1.1), (0.05, 0.05, 0.05, 1.0)) for x in (-0.75, 0.75)),
)
SCENE = {
    "tallgrass": 2,
    "terrain": {"noise": "rolling", "seed": 4, "size": (160, 160), "feature": 80, "scale": 2},
    "grass": {
        "hay": {"height": (0.45, 0.75), "width": 0.016, "root": "#4c6a2b", "tip": "#cdbb72"},
        "poppy": {
            "plant": "flower", "height": (0.5, 0.8), "tip": "#e0301c", "head": {"size": (0.07, 0.1)}, "plants": 30,
            "place": "none",
        },
    },
    "wind": [{"kind": "breeze", "direction": 60, "strength": 0.3}],
    "light": {"hour": 16.0, "clouds": 0.12},
}  # fmt: skip


class Game:
    """The window, the field and the mower."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="A farm", resizable=True)
        self.prairie = Prairie.load(SCENE, preset="medium")
        source = MaterialGroup.default_vert_src, MaterialGroup.default_frag_src
        shader = ShaderProgram(Shader(source[0], "vertex"), Shader(source[1], "fragment"))
        self.batch = pyglet.graphics.Batch()
        cube: Any = pyglet.model.Cube  # pyglet declares no types of its arguments
        self.parts = [cube(*size, color=color, batch=self.batch, program=shader) for _, size, color in PARTS]
        self.pose, self.shadow = Pose(-FIELD + 5 * WIDTH, 8.0), esper.create_entity()
        self.text = pyglet.text.Label("Up, left, right; P, S, L", 20, 20, font_size=14)
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw, self.on_key_press)
        for row in range(5):  # what has been mown in the morning
            x = -FIELD + row * WIDTH
            height = STUBBLE * (1.0 + row % 2)  # every other swath stands higher: so one sees how it was mown
            self.prairie.cut(Footprint(radius=WIDTH / 2.0, length=2.0 * FIELD), height, pose=Pose(x, 0.0))
        for place in range(-24, 7, 3):
            self.prairie.sow("poppy", Footprint(radius=1.5), 0.9, soft=1.0, pose=Pose(-8.0, float(place)))

    def update(self, dt: float) -> None:
        """Drive on for `dt` [s], and cut the grass before the mower."""
        self.prairie.advance(dt)
        yaw = self.pose.yaw + 1.2 * dt * (self.keys[key.RIGHT] - self.keys[key.LEFT])
        way = 3.0 * dt * self.keys[key.UP]
        self.pose = Pose(self.pose.x + way * sin(yaw), self.pose.z - way * cos(yaw), yaw)
        self.prairie.cut(Footprint(radius=WIDTH / 2.0), STUBBLE, pose=self.pose)
        middle = float(self.prairie.height_at([(self.pose.x, self.pose.z)])[0]) + 1.1
        shade = Shade((self.pose.x, middle, self.pose.z), size=(1.7, 1.8, 2.6), yaw=self.pose.yaw)
        esper.add_component(self.shadow, shade)

    def on_key_press(self, symbol: int, modifiers: int) -> None:
        """Sow, save or load."""
        if symbol == key.P:
            self.prairie.sow("poppy", Footprint(radius=2.0), 0.7, soft=1.0, pose=self.pose)
        elif symbol == key.S:
            SAVED.write_bytes(self.prairie.state())
        elif symbol == key.L and SAVED.is_file():
            self.prairie.restore(SAVED.read_bytes())

    def on_draw(self) -> None:
        """Draw the mower, then the prairie around it, from behind."""
        s, c, at = sin(self.pose.yaw), cos(self.pose.yaw), (self.pose.x, self.pose.z)
        feet = Vec3(at[0], float(self.prairie.height_at([at])[0]), at[1])
        turned = Mat4.from_translation(feet) @ Mat4.from_rotation(-self.pose.yaw, UP)
        for part, (place, _, _) in zip(self.parts, PARTS, strict=True):
            part.matrix = turned @ Mat4.from_translation(Vec3(place[0], place[1], -place[2]))
        eye = feet + Vec3(-9.0 * s + 4.0 * c, 4.6, 9.0 * c + 4.0 * s)
        self.window.clear()
        flat = self.window.projection
        self.window.projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 48.0)
        self.window.view = Mat4.look_at(eye, feet + Vec3(7.0 * s, 0.4, -7.0 * c), UP)
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.batch.draw()
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(self.window.view, self.window.projection)
        self.window.projection, self.window.view = flat, Mat4()
        self.text.draw()


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
