"""A day over the hills that the player turns: its hours go by, and the grass never waits for the sun.

The game keeps the hour and hands it to the prairie in every frame (`Prairie.shine`). The left and right arrow keys turn
the day back and on, the others bring clouds and take them away, Escape ends. Run it with `python day.py`.
"""

import pyglet
from pyglet.math import Mat4, Vec3
from pyglet.window import key

from tallgrass import Prairie

SIZE = (960, 540)
EYE, AHEAD = (40.0, 60.0), Vec3(0.6, -0.08, -1.0)
HOURS, CLOUDS = 0.2, 0.25  # how fast they go by themselves and by the keys [1/s]


class Game:
    """The window, the prairie, the hour and the clouds."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="A day", resizable=True)
        self.prairie = Prairie.load("hills", preset="medium")
        self.text = pyglet.text.Label("", 20, 20, font_size=14)
        self.hour, self.clouds = 7.0, 0.2
        x, z = EYE
        self.eye = Vec3(x, float(self.prairie.height_at([EYE])[0]) + 1.7, z)
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)

    def update(self, dt: float) -> None:
        """Advance the time by `dt` [s]."""
        turned, more = self.keys[key.RIGHT] - self.keys[key.LEFT], self.keys[key.UP] - self.keys[key.DOWN]
        self.hour = (self.hour + dt * (HOURS + 2.0 * turned)) % 24.0
        self.clouds = min(max(self.clouds + dt * CLOUDS * more, 0.0), 1.0)
        self.prairie.shine(hour=self.hour, clouds=self.clouds)
        self.prairie.advance(dt)

    def on_draw(self) -> None:
        """Draw the prairie, then the hour over it."""
        self.window.clear()
        view = Mat4.look_at(self.eye, self.eye + AHEAD, Vec3(0.0, 1.0, 0.0))
        self.prairie.draw(view, Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 3000.0, 45.0))
        self.text.text = f"{int(self.hour):02d}:{int(self.hour % 1.0 * 60.0):02d}, {self.clouds:.0%} clouds"
        self.text.draw()


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
