"""Baking pictures: of a twig for its card, and of a whole tree from all around."""

from collections.abc import Callable
from itertools import accumulate
from math import ceil
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Bytes, Doubles, Floats
from ...engine.gl.guest import clear
from ...engine.gl.mipmaps import mipmapped
from ...engine.gl.stream import release_all
from .far import COARSER, COLUMNS, EACH_ROW, FINER, FIRST_ROW, LEVELS, LINES, ROWS
from .twig import MEAN_TONE

CARD = 256
"""Side of a twig's card [pixels]."""

DEPTH_RANGES = 4.0, 2.0
"""Depth range of pictures to the front and back: of a tree, in half heights; of a twig, in its usual lengths."""

KNOWN = 0x5A
"""Value by which a texel that was drawn is known again [bytes]; memory that was not drawn into hardly has it."""

COARSEST = 1 << (LEVELS - 1)
"""Texels in a row of the finest mip level that the coarsest has one of."""

Draw = Callable[[int], None]
"""Draws the picture of a number into the viewport that is set."""


def picture_size(breadth: float, /) -> tuple[int, int]:
    """Return the height and width of a tree's pictures [texels]; `breadth` is the tree's, relative to their height."""
    lines = _rounded_up(LINES)
    return lines, _rounded_up(lines * breadth)


def pictures(ctx: moderngl.Context, columns: int, rows: int, wide: int, tall: int, draw: Draw, /) -> Floats:
    """Return pictures drawn side by side in rows, each of `wide` by `tall` texels; two outputs are two layers.

    They have shape (2, rows, columns, 4), and are premultiplied by the coverage, the last channel of the first layer:
    each texel is the mean of what it shows [bytes]. They are empty where the driver draws nothing.
    """
    fine = wide * FINER, tall * FINER
    size, before = (columns * fine[0], rows * fine[1]), ctx.fbo
    colors = [ctx.texture(size, 4) for _ in range(2)]
    depth = ctx.depth_renderbuffer(size)
    target = ctx.framebuffer(colors, depth)
    try:
        target.use()
        clear(target, depth=1.0)
        ctx.enable_only(moderngl.DEPTH_TEST)
        for number in range(columns * rows):
            target.viewport = number % columns * fine[0], number // columns * fine[1], *fine
            draw(number)
        ctx.enable_only(moderngl.NOTHING)
        texels = np.stack([np.frombuffer(each.read(), np.uint8).reshape(size[1], size[0], 4) for each in colors])
        if not _is_drawn(target):
            texels[...] = 0  # what was read is whatever lay in memory
    finally:
        before.use()  # a target bound when released would be bound again
        release_all(target, depth, *colors)
    return _levels(texels, FINER.bit_length())[-1]  # empty texels are 0 in both


def _is_drawn(target: moderngl.Framebuffer) -> bool:
    """Return whether what is drawn into a framebuffer, which is bound, can be read: not after its context was lost.

    Drivers that draw nothing, as for measurements, leave in it what lay in memory.
    """
    clear(target, color=KNOWN / 255.0)
    read = (target.read(viewport=(0, 0, 1, 1), components=4, attachment=number) for number in range(2))
    return all(texel == bytes([KNOWN] * 4) for texel in read)


def texture_of(ctx: moderngl.Context, levels: list[Bytes], /) -> moderngl.TextureArray:
    """Return a texture of mip levels."""
    texture = mipmapped(ctx, levels)
    texture.filter = (moderngl.LINEAR_MIPMAP_LINEAR, moderngl.LINEAR)
    texture.repeat_x = texture.repeat_y = False
    return texture


def mip_levels(values: Floats, /) -> list[Bytes]:
    """Return layers (n, rows, columns, 4) at all mip levels."""
    return [_as_bytes(each) for each in _levels(values, LEVELS)]


def dilated(values: Floats, cover: Floats, levels: int, /) -> list[Bytes]:
    """Return the mip levels of a layer (1, rows, columns, 4), unpremultiplied by a coverage (rows, columns).

    Texels without coverage take the values around them, so that interpolation stays right.
    """
    both = np.concatenate([values, cover[..., None]], axis=-1)[None]
    found = list[Floats]()
    for one in reversed(_levels(both, levels)):
        covered = one[..., 4:] > 0.0
        own = 255.0 * one[..., :4] / np.where(covered, one[..., 4:], 1.0)
        mean = own[covered[..., 0]].mean() if covered.any() else 0.0
        around = found[-1].repeat(2, axis=1).repeat(2, axis=2) if found else np.full_like(own, mean)
        found.append(np.where(covered, own, around))
    return [_as_bytes(each) for each in reversed(found)]


def tree_levels(values: Floats, /) -> tuple[list[Bytes], list[Bytes]]:
    """Return the mip levels of a tree's pictures, and those of the optical depths before what they show."""
    coarser = _levels(values, COARSER.bit_length())[-1]
    return mip_levels(values[:1]), dilated(coarser[1], coarser[0, ..., 3], LEVELS - COARSER.bit_length() + 1)


def card_texels(layers: Bytes, /) -> Bytes:
    """Return a twig's pictures (2 n, rows, columns, 4) as cards read them: tone, normal across and along, coverage.

    Leaves face out of their card, so the normal's third part follows from the others. The tones of one twig's few
    leaves are random, but all cards show them: they are scaled to the mean of all twigs. The first layer's second
    channel is the tone if all leaves had a tone of 1.
    """
    shows, faces = layers[::2], layers[1::2]
    drawn, brightest = shows[..., :2].sum(axis=(1, 2), dtype=np.float64).T
    gain = MEAN_TONE * brightest / np.maximum(drawn, 1.0)
    tone = np.round(np.minimum(gain[:, None, None] * shows[..., 0], shows[..., 3])).astype(np.uint8)
    return np.ascontiguousarray(np.concatenate([tone[..., None], faces[..., :2], shows[..., 3:]], axis=-1))


def equalised(pictures: Bytes, solid: float, /) -> Bytes:
    """Return pictures of cards (n, rows, columns, 4) whose dense texels are as bright in the mean as the others.

    Only texels of a coverage of `solid` or more are seen where leaves are behind, and coarse texels with a stem or an
    edge among leaves cover less.
    """
    result = pictures.copy()
    for each in result:
        tone, cover = (each[..., one].astype(np.float64) for one in (0, 3))
        mean = tone.sum() / max(cover.sum(), 1.0)
        for part in (cover >= solid, cover < solid):
            total = tone[part].sum()
            if total > 0.0:
                tone[part] *= mean * cover[part].sum() / total
        each[..., 0] = np.round(np.minimum(tone, cover))
    return result


def _rounded_up(texels: float) -> int:
    return -(-ceil(texels) // COARSEST) * COARSEST


def _as_bytes(values: Floats) -> Bytes:
    return np.ascontiguousarray(np.round(values).astype(np.uint8))


def _levels(values: NDArray[Any], count: int) -> list[NDArray[Any]]:
    """Return layers (n, rows, columns, ...) at so many mip levels, finest first."""
    return list(accumulate(range(count - 1), lambda finer, _: _halved(finer), initial=values))


def _halved(values: NDArray[np.generic]) -> Floats:
    wide = np.uint16 if values.dtype == np.uint8 else np.float32
    rows = np.add(values[:, ::2], values[:, 1::2], dtype=wide)
    pairs = rows.reshape(*rows.shape[:2], -1, 2, rows.shape[-1])  # faster than every other column
    return np.asarray(np.float32(0.25) * np.add(pairs[..., 0, :], pairs[..., 1, :], dtype=np.float32))


def coverage(texels: Bytes, wide: int, lines: int, /) -> Bytes:
    """Return the coverage of each picture of a tree from all around, shape (pictures, lines, wide)."""
    cover = texels[0, ..., 3].reshape(ROWS, lines, COLUMNS, wide)
    return np.asarray(cover.transpose(0, 2, 1, 3).reshape(ROWS * COLUMNS, lines, wide))


def view_matrix(number: int, middle: float, half: float, aspect: float, /) -> Doubles:
    """Return the matrix (4, 4) that shows a tree from one of its sides, `half` high about the height `middle` [m].

    The picture is `aspect` times as high as wide.
    """
    azimuth, up = 2.0 * np.pi * (number % COLUMNS) / COLUMNS, FIRST_ROW + EACH_ROW * (number // COLUMNS)
    to = np.array([np.cos(up) * np.sin(azimuth), np.sin(up), np.cos(up) * np.cos(azimuth)])
    across = np.array([np.cos(azimuth), 0.0, -np.sin(azimuth)])
    shown = np.eye(4)
    shown[:3, :3] = np.stack([across, np.cross(to, across), -to]) / half
    shown[0, :3] *= aspect
    shown[2, :3] /= DEPTH_RANGES[0]
    shown[:3, 3] = -shown[:3, :3] @ (0.0, middle, 0.0)
    return shown


def card_matrix(reach: tuple[float, float, float], twig_length: float, /) -> Doubles:
    """Return the matrix (4, 4) that shows a twig on its card; `reach` is aside, back and on [its usual lengths]."""
    wide, back, on = reach
    shown = np.eye(4)
    shown[0, 0] = 1.0 / (wide * twig_length)
    shown[1, 1], shown[1, 3] = 2.0 / ((on - back) * twig_length), -1.0 - 2.0 * back / (on - back)
    shown[2, 2] = -1.0 / (DEPTH_RANGES[1] * twig_length)
    return shown
