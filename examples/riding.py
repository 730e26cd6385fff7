"""Seeds and the sound of the wind ride on the wind that the grass feels: `Prairie.wind_at` at many places at once.

Seeds are points of the game's own, carried along; the murmur is as loud as the wind around the listener. Run it with
`python riding.py`.
"""

import io
import wave

import numpy as np
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3

from tallgrass import Prairie

SIZE = (960, 540)
EYE = (2.0, 66.0)
"""Place of the listener (x, z) [m]."""

SEEDS, SPREAD, CARRY = 900, np.array([24.0, 1.8, 30.0]), 9.0
"""Number of seeds, extent of their cloud (x, y, z) [m], and their speed in a full wind [m/s]."""
MIDDLE = np.array([EYE[0], 2.0, EYE[1] - SPREAD[2]])
SWITCHES = gl.GL_DEPTH_TEST, gl.GL_BLEND, gl.GL_PROGRAM_POINT_SIZE

VERTEX = """#version 330 core
in vec3 position;
uniform WindowBlock { mat4 projection; mat4 view; } window;
void main() {
    gl_Position = window.projection * window.view * vec4(position, 1.0);
    gl_PointSize = clamp(60.0 / gl_Position.w, 1.5, 14.0);
}"""
FRAGMENT = """#version 330 core
out vec4 pixel;
void main() {
    float edge = 1.0 - smoothstep(0.2, 1.0, 2.0 * length(gl_PointCoord - 0.5));
    pixel = vec4(1.0, 0.98, 0.9, 0.85 * edge);
}"""


def murmur() -> pyglet.media.Source:
    """Return a loop of four seconds of noise, softer at higher frequencies."""
    tones = np.fft.rfft(np.random.default_rng(1).normal(size=4 * 22050))
    sound = np.fft.irfft(tones / np.maximum(np.fft.rfftfreq(4 * 22050, 1 / 22050), 120.0) ** 1.2)
    file = io.BytesIO()
    with wave.open(file, "wb") as out:
        out.setparams((1, 2, 22050, 0, "NONE", ""))
        out.writeframes((sound / np.abs(sound).max() * 32000).astype("<i2").tobytes())
    return pyglet.media.load("murmur.wav", io.BytesIO(file.getvalue()), streaming=False)


class Game:
    """The window, the seeds, and the murmur."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Riding on the wind", resizable=True)
        self.prairie = Prairie.load("gust", preset="medium")
        self.random = np.random.default_rng(2)
        self.place = self.random.uniform(-1.0, 1.0, (SEEDS, 3)) * SPREAD + MIDDLE
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.points = self.program.vertex_list(SEEDS, gl.GL_POINTS, position="f")
        self.player, self.level = pyglet.media.Player(), 0.0
        self.player.queue(murmur())
        self.player.loop = True
        self.window.push_handlers(self.on_draw)

    def update(self, dt: float) -> None:
        """Carry the seeds for `dt` [s], and make the murmur as loud as the wind within 15 m."""
        self.prairie.advance(dt)
        wind = self.prairie.wind_at(self.place[:, ::2])
        self.place[:, ::2] += CARRY * dt * wind
        self.place[:, 1] += dt * (1.5 * np.hypot(*wind.T) - 0.25)
        self.place = MIDDLE + np.mod(self.place - MIDDLE + SPREAD, 2.0 * SPREAD) - SPREAD
        around = self.prairie.wind_at(np.array(EYE) + self.random.uniform(-15.0, 15.0, (32, 2)))
        self.level += (float(np.hypot(*around.T).mean()) - self.level) * min(1.0, 3.0 * dt)
        self.player.volume = min(1.0, 1.6 * self.level)

    def on_draw(self) -> None:
        """Draw the prairie, then the seeds: they are hidden behind the ground and the nearest blades, and blend."""
        flat, x, z = self.window.projection, *EYE
        eye = Vec3(x, float(self.prairie.height_at([EYE])[0]) + 2.2, z)
        self.window.clear()
        self.window.projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 45.0)
        self.window.view = Mat4.look_at(eye, eye + Vec3(-0.2, -0.12, -1.0), Vec3(0.0, 1.0, 0.0))
        self.prairie.draw(self.window.view, self.window.projection)
        ground = self.prairie.height_at(self.place[:, ::2])
        self.points.set_attribute_data("position", (self.place + np.outer(ground, (0.0, 1.0, 0.0))).ravel().tolist())
        for switch in SWITCHES:
            gl.glEnable(switch)
        gl.glBlendFunc(gl.GL_SRC_ALPHA, gl.GL_ONE_MINUS_SRC_ALPHA)
        self.program.use()
        self.points.draw(gl.GL_POINTS)
        for switch in SWITCHES:
            gl.glDisable(switch)
        self.window.projection, self.window.view = flat, Mat4()
        pyglet.shapes.Rectangle(20, 20, 300 * self.player.volume, 8, (255, 255, 255, 200)).draw()


if __name__ == "__main__":
    game = Game()
    game.player.play()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.player.delete()
    game.prairie.release()
