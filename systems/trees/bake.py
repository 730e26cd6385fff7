"""Drawing what trees are drawn with: a twig on its card, and a whole tree from all around."""

from collections.abc import Callable

import moderngl
import numpy as np

from ...components.arrays import Bytes, Doubles, Floats
from ...engine.gl.mipmaps import mipmapped
from ...engine.gl.stream import release_all
from .far import COLUMNS, EACH_ROW, FINER, FIRST_ROW, ROWS, SIDE

CARD = 256
"""Pixels of a twig's card across and up."""

LEVELS = 5
"""Sizes of a picture that are kept, each half the one before: coarser ones would mix neighbours."""

DEPTHS = 4.0, 2.0
"""How far the pictures of a tree and of a twig go to the front and back: half sides, and usual lengths."""

PICTURES = COLUMNS, ROWS, SIDE
"""Of a tree from all around: side by side, in rows, and pixels of one across and up."""

Draw = Callable[[int], None]
"""Draws the picture of a number into the viewport that is set."""


def pictures(ctx: moderngl.Context, columns: int, rows: int, side: int, draw: Draw, /) -> list[Bytes]:
    """Return pictures drawn side by side in rows, of `side` pixels each, as `smaller` has them.

    What two outputs have are two layers of them.
    """
    fine = side * FINER
    size, before = (columns * fine, rows * fine), ctx.fbo
    colors = [ctx.texture(size, 4) for _ in range(2)]
    depth = ctx.depth_renderbuffer(size)
    target = ctx.framebuffer(colors, depth)
    try:
        target.use()
        target.clear()
        ctx.enable_only(moderngl.DEPTH_TEST)
        for number in range(columns * rows):
            target.viewport = number % columns * fine, number // columns * fine, fine, fine
            draw(number)
        ctx.enable_only(moderngl.NOTHING)
        texels = np.stack([np.frombuffer(each.read(), np.uint8).reshape(size[1], size[0], 4) for each in colors])
    finally:
        before.use()  # what is bound when it is released is bound again later
        release_all(target, depth, *colors)
    return smaller(texels)


def filtered(ctx: moderngl.Context, made: list[Bytes], /) -> moderngl.TextureArray:
    """Return a texture of such pictures."""
    texture = mipmapped(ctx, made)
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def smaller(texels: Bytes, /) -> list[Bytes]:
    """Return two layers (2, rows, columns, 4) of what was drawn, `FINER` times too large, at `LEVELS` sizes.

    Texels are premultiplied by the last channel of the first layer, the coverage: each is the mean of what it shows.
    """
    values = texels.astype(np.float32)
    values[1] *= np.float32(1.0 / 255.0) * values[0, ..., 3:]
    for _ in range(FINER.bit_length() - 1):
        values = _halved(values)
    found = []
    for _ in range(LEVELS):
        found.append(np.ascontiguousarray(np.round(values).astype(np.uint8)))
        values = _halved(values)
    return found


def _halved(values: Floats) -> Floats:
    quarter = np.float32(0.25)
    return np.asarray(
        quarter * (values[:, ::2, ::2] + values[:, 1::2, ::2] + values[:, ::2, 1::2] + values[:, 1::2, 1::2]),
        np.float32,
    )


def covers(made: list[Bytes], /) -> Bytes:
    """Return how much of it each picture of a tree from all around covers, shape (pictures, rows, columns)."""
    columns, rows, side = PICTURES
    texels = made[0][0, ..., 3].reshape(rows, side, columns, side)
    return np.asarray(texels.transpose(0, 2, 1, 3).reshape(rows * columns, side, side))


def from_around(number: int, middle: float, half: float, /) -> Doubles:
    """Return the matrix (4, 4) that shows a tree from one of its sides: a square of half a side about a height [m]."""
    azimuth, up = 2.0 * np.pi * (number % COLUMNS) / COLUMNS, FIRST_ROW + EACH_ROW * (number // COLUMNS)
    to = np.array([np.cos(up) * np.sin(azimuth), np.sin(up), np.cos(up) * np.cos(azimuth)])
    across = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
    shown = np.eye(4)
    shown[:3, :3] = np.stack([across, np.cross(to, across), -to]) / half
    shown[2, :3] /= DEPTHS[0]
    shown[:3, 3] = -shown[:3, :3] @ (0.0, middle, 0.0)
    return shown


def on_card(reach: tuple[float, float, float], usual: float, /) -> Doubles:
    """Return the matrix (4, 4) that shows a twig on its card, which reaches so far aside, back and on [its lengths]."""
    wide, back, on = reach
    shown = np.eye(4)
    shown[0, 0] = 1.0 / (wide * usual)
    shown[1, 1], shown[1, 3] = 2.0 / ((on - back) * usual), -1.0 - 2.0 * back / (on - back)
    shown[2, 2] = -1.0 / (DEPTHS[1] * usual)
    return shown
