"""A 2D game with a prairie behind its sprites: catch the butterflies that the wind carries over the meadow.

The prairie is one more group in the game's batch, under all others. Run it with `python sprites.py`.
"""

from math import cos, sin
from random import Random

import pyglet
from PIL import Image, ImageDraw
from pyglet.math import Mat4, Vec3

from tallgrass import Prairie

SIZE = (960, 540)
COLORS = ("#f2a33a", "#e8e4d8", "#6f9fe0", "#d9563f")


def butterfly(color: str) -> pyglet.image.ImageData:
    """Draw a butterfly with open wings, 48 pixels wide."""
    image = Image.new("RGBA", (192, 192))
    pen = ImageDraw.Draw(image)
    for left, right in ((8, 92), (100, 184)):
        pen.ellipse((left, 24, right, 100), fill=color, outline="#2a1d12", width=6)
        pen.ellipse((left + 14, 88, right - 14, 160), fill=color, outline="#2a1d12", width=6)
        pen.ellipse((left + 26, 44, right - 26, 76), fill="#fff1d0")
    pen.rounded_rectangle((88, 30, 104, 150), 8, fill="#2a1d12")
    small = image.resize((48, 48), Image.Resampling.LANCZOS).transpose(Image.Transpose.FLIP_TOP_BOTTOM)
    return pyglet.image.ImageData(48, 48, "RGBA", small.tobytes())


class Butterfly:
    """A butterfly: a sprite that flutters, and drifts with the wind of the place below it."""

    def __init__(self, random: Random, batch: pyglet.graphics.Batch, group: pyglet.graphics.Group) -> None:
        image = butterfly(random.choice(COLORS))
        image.anchor_x = image.anchor_y = 24
        place = random.uniform(0, SIZE[0]), random.uniform(60, 300)
        self.sprite = pyglet.sprite.Sprite(image, *place, batch=batch, group=group)
        self.phase, self.size = random.uniform(0.0, 6.0), random.uniform(0.6, 1.1)

    def fly(self, prairie: Prairie, dt: float) -> None:
        """Flap for `dt` [s], and let the wind carry it to the right or the left."""
        x, y = self.sprite.x, self.sprite.y
        ((across, _),) = prairie.wind_at([((x - SIZE[0] / 2) / 40.0, y / -20.0)])
        self.phase += dt * 9.0
        self.sprite.x = (x + dt * (220.0 * float(across) + 25.0 * cos(self.phase / 7.0)) + 30) % (SIZE[0] + 60) - 30
        self.sprite.y = min(330.0, max(40.0, y + dt * 40.0 * sin(self.phase / 5.0)))
        self.sprite.update(scale=self.size, scale_x=0.25 + 0.75 * abs(cos(self.phase)), rotation=70.0 * float(across))


class Game:
    """The window, its batch, and the score."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Butterflies")
        self.prairie = Prairie.load("gust", preset="medium")
        self.batch = pyglet.graphics.Batch()
        self.prairie.group(self.batch, self.camera, order=0)
        front, text = pyglet.graphics.Group(1), pyglet.graphics.Group(2)
        random = Random(4)  # noqa: S311 - nobody guards a secret with butterflies
        self.flying = [Butterfly(random, self.batch, front) for _ in range(14)]
        self.score = pyglet.text.Label("", 20, SIZE[1] - 36, font_size=18, batch=self.batch, group=text)
        self.caught = 0
        self.window.push_handlers(self.on_draw, self.on_mouse_press)

    def camera(self) -> tuple[Mat4, Mat4]:
        """Return the prairie's view and projection: those of a camera that never moves."""
        eye = Vec3(0.0, float(self.prairie.height_at([(0.0, 60.0)])[0]) + 3.0, 60.0)
        view = Mat4.look_at(eye, eye + Vec3(0.0, -0.1, -1.0), Vec3(0.0, 1.0, 0.0))
        return view, Mat4.perspective_projection(SIZE[0] / SIZE[1], 0.1, 2000.0, 40.0)

    def update(self, dt: float) -> None:
        """Move everything on by `dt` [s]."""
        self.prairie.advance(dt)
        for one in self.flying:
            one.fly(self.prairie, dt)
        self.score.text = f"{self.caught} caught, {len(self.flying)} to go"

    def on_draw(self) -> None:
        """Draw the batch, and the prairie with it."""
        self.window.clear()
        self.batch.draw()

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Catch what is under the mouse."""
        near = [one for one in self.flying if abs(one.sprite.x - x) < 24 and abs(one.sprite.y - y) < 24]
        self.caught += len(near)
        for one in near:
            self.flying.remove(one)
            one.sprite.delete()


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
