"""Drawing what trees are drawn with: a twig on its card, and a whole tree from all around."""

from collections.abc import Callable
from math import ceil

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Floats
from ...engine.gl.mipmaps import mipmapped
from ...engine.gl.stream import release_all
from .far import COARSER, COLUMNS, EACH_ROW, FINER, FIRST_ROW, LEVELS, LINES, ROWS

CARD = 256
"""Pixels of a twig's card across and up."""

DEPTHS = 4.0, 2.0
"""How far the pictures of a tree and of a twig go to the front and back: of half their height, and usual lengths."""

WHOLE = 1 << (LEVELS - 1)
"""Texels in a row that the coarsest picture has one of."""

Draw = Callable[[int], None]
"""Draws the picture of a number into the viewport that is set."""


def lines_of(breadth: float, /) -> tuple[int, int]:
    """Return the texels up and across of a tree's pictures where it is so broad, of their height."""
    lines = _whole(LINES)
    return lines, _whole(lines * breadth)


def pictures(ctx: moderngl.Context, columns: int, rows: int, wide: int, tall: int, draw: Draw, /) -> Floats:
    """Return pictures drawn side by side in rows, each of `wide` by `tall` texels; two outputs are two layers.

    They have shape (2, rows, columns, 4), and are premultiplied by the last channel of the first layer, the coverage:
    each texel is the mean of what it shows [bytes].
    """
    fine = wide * FINER, tall * FINER
    size, before = (columns * fine[0], rows * fine[1]), ctx.fbo
    colors = [ctx.texture(size, 4) for _ in range(2)]
    depth = ctx.depth_renderbuffer(size)
    target = ctx.framebuffer(colors, depth)
    try:
        target.use()
        target.clear()
        ctx.enable_only(moderngl.DEPTH_TEST)
        for number in range(columns * rows):
            target.viewport = number % columns * fine[0], number // columns * fine[1], *fine
            draw(number)
        ctx.enable_only(moderngl.NOTHING)
        texels = np.stack([np.frombuffer(each.read(), np.uint8).reshape(size[1], size[0], 4) for each in colors])
    finally:
        before.use()  # what is bound when it is released is bound again later
        release_all(target, depth, *colors)
    values = _halved(texels)  # what is not covered is 0 in both
    for _ in range(FINER.bit_length() - 2):
        values = _halved(values)
    return values


def filtered(ctx: moderngl.Context, made: list[Bytes], /) -> moderngl.TextureArray:
    """Return a texture of such pictures."""
    texture = mipmapped(ctx, made)
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def smaller(values: Floats, levels: int = LEVELS, /) -> list[Bytes]:
    """Return layers (n, rows, columns, 4) at so many sizes."""
    each = [values]
    for _ in range(levels - 1):
        each.append(_halved(each[-1]))
    return [np.ascontiguousarray(np.round(one).astype(np.uint8)) for one in each]


def spread(values: Floats, cover: Floats, levels: int, /) -> list[Bytes]:
    """Return a layer (1, rows, columns, 4) that is premultiplied by a coverage (rows, columns), each without it.

    Where nothing is covered it has what is about that, so that texels can be read between. It has so many sizes.
    """
    both = np.concatenate([values, cover[..., None]], axis=-1)[None]
    each = [both]
    for _ in range(levels - 1):
        each.append(_halved(each[-1]))
    found = list[Floats]()
    for one in reversed(each):
        there = one[..., 4:] > 0.0
        own = 255.0 * one[..., :4] / np.where(there, one[..., 4:], 1.0)
        around = (
            found[-1].repeat(2, axis=1).repeat(2, axis=2) if found else np.full_like(own, own[there[..., 0]].mean())
        )
        found.append(np.where(there, own, around))
    return [np.ascontiguousarray(np.round(one).astype(np.uint8)) for one in reversed(found)]


def of_tree(values: Floats, /) -> tuple[list[Bytes], list[Bytes]]:
    """Return what pictures of a tree show, and how light has come to that."""
    coarser = values
    for _ in range(COARSER.bit_length() - 1):
        coarser = _halved(coarser)
    return smaller(values[:1]), spread(coarser[1], coarser[0, ..., 3], LEVELS - COARSER.bit_length() + 1)


def on_cards(layers: Bytes, /) -> Bytes:
    """Return what cards are drawn with of a twig's pictures (2 n, rows, columns, 4): tone, normal across, along, cover.

    Leaves face out of their card, so that part of the normal is told by the others.
    """
    shows, faces = layers[::2], layers[1::2]
    return np.ascontiguousarray(np.concatenate([shows[..., :1], faces[..., :2], shows[..., 3:]], axis=-1))


def evened(pictures: Bytes, solid: float, /) -> Bytes:
    """Return pictures of cards (n, rows, columns, 4) with what covers so much, and more, no brighter than the rest.

    That alone is seen where leaves are behind it, and coarse texels with a stem or an edge among leaves cover less.
    """
    result = pictures.copy()
    for each in result:
        tone, cover = (each[..., one].astype(np.float64) for one in (0, 3))
        mean = tone.sum() / max(cover.sum(), 1.0)
        for some in (cover >= solid, cover < solid):
            own = tone[some].sum()
            if own > 0.0:
                tone[some] *= mean * cover[some].sum() / own
        each[..., 0] = np.round(np.minimum(tone, cover))
    return result


def _whole(texels: float) -> int:
    return -(-ceil(texels) // WHOLE) * WHOLE


def _halved(values: NDArray[np.generic]) -> Floats:
    wide = np.uint16 if values.dtype == np.uint8 else np.float32
    rows = np.add(values[:, ::2], values[:, 1::2], dtype=wide)
    pairs = rows.reshape(*rows.shape[:2], -1, 2, rows.shape[-1])  # faster than every other column
    return np.asarray(np.float32(0.25) * np.add(pairs[..., 0, :], pairs[..., 1, :], dtype=np.float32))


def covers(texels: Bytes, wide: int, lines: int, /) -> Bytes:
    """Return how much of it each picture of a tree from all around covers, shape (pictures, lines, wide)."""
    cover = texels[0, ..., 3].reshape(ROWS, lines, COLUMNS, wide)
    return np.asarray(cover.transpose(0, 2, 1, 3).reshape(ROWS * COLUMNS, lines, wide))


def from_around(number: int, middle: float, half: float, slim: float, /) -> Doubles:
    """Return the matrix (4, 4) that shows a tree from one of its sides, half so high about a height [m].

    It is `slim` times as high as wide.
    """
    azimuth, up = 2.0 * np.pi * (number % COLUMNS) / COLUMNS, FIRST_ROW + EACH_ROW * (number // COLUMNS)
    to = np.array([np.cos(up) * np.sin(azimuth), np.sin(up), np.cos(up) * np.cos(azimuth)])
    across = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
    shown = np.eye(4)
    shown[:3, :3] = np.stack([across, np.cross(to, across), -to]) / half
    shown[0, :3] *= slim
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
