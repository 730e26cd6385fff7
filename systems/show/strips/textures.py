"""The strips of all rings as textures."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Mask
from ....engine.gl.mipmaps import levels, mipmapping
from ...grow.record import Growth
from .grow import Strips, strips_of
from .pages import SPARE, WHOLE, Pages, packed


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """The pictures of all strips on pages, finest level first. They stand by ring, kind, model, orientation, strip."""

    texels: list[Bytes]
    """What texels mean, each (pages, rows, columns, 4)."""

    ranks: list[Bytes]
    """Their ranks, each (pages, rows, columns): asked for only where some blades do not show."""

    extents: NDArray[np.float32]
    """Where each picture is painted, by column, (pictures, columns + 1, 4): from and to, across the column, and up to,
    in [0, 1]; and its page. A texel more on every side is taken for painted. In the last column is where all of it
    would begin on its page, across and up, and how far it would reach, in [0, 1]: what is empty is left out."""


def strip_stock(growths: Sequence[Growth], ring: int) -> list[list[Strips]]:
    """Return a ring's strips by kind and model."""
    return [[strips_of(model)[ring] for model in growth.models] for growth in growths]


def strip_stocks(growths: Sequence[Growth]) -> list[list[list[Strips]]]:
    """Return the strips of all rings, by ring, kind and model."""
    return [strip_stock(growths, ring) for ring in range(len(strips_of(growths[0].models[0])))]


def strip_atlas(stock: Sequence[list[list[Strips]]], columns: Sequence[int]) -> Atlas:
    """Return the atlas of all strips; `columns` are those of each ring's strips."""
    every = _each(stock)
    boxes = np.concatenate([_painted_box(strips) for strips in every])
    kinds = [
        kind
        for ring in stock
        for kind, models in enumerate(ring)
        for strips in models
        for _ in range(_pictures(strips))
    ]
    pages = packed(boxes[:, 1] - boxes[:, 0], np.array(kinds))
    return Atlas(
        texels=levels(_laid([strips.texels for strips in every], boxes, pages)),
        ranks=levels(_laid([strips.ranks for strips in every], boxes, pages)),
        extents=_extents(stock, columns, boxes[:, 0], pages),
    )


def _painted_box(strips: Strips) -> NDArray[np.int64]:
    """Return from where to where each picture is painted, and `SPARE` beyond: row and column, (pictures, 2, 2).

    All begin at the ground, and at a multiple of `WHOLE` columns: mip-maps have the same texels in common as of all.
    """
    painted: Mask = np.asarray(strips.texels[..., 3].reshape(-1, *strips.texels.shape[2:4]) > 0)
    (_, top), (left, right) = (_ends(np.asarray(painted.any(axis=axis))) for axis in (2, 1))
    low, high = [0 * top, (left - SPARE) // WHOLE * WHOLE], [top + SPARE, right + SPARE]
    box: NDArray[np.int64] = np.clip(np.array([low, high]).transpose(2, 0, 1), 0, painted.shape[1:])
    return box


def _laid(pictures: Sequence[Bytes], boxes: NDArray[np.int64], pages: Pages) -> Bytes:
    """Return pages with parts of pictures (orientations, strips, rows, columns, ...) on them, nothing between."""
    laid = np.zeros((*pages.shape, *pictures[0].shape[4:]), np.uint8)
    each = (picture for some in pictures for picture in some.reshape(-1, *some.shape[2:]))
    for (page, row, column), (low, high), picture in zip(pages.places.tolist(), boxes.tolist(), each, strict=True):
        shown = picture[low[0] : high[0], low[1] : high[1]]
        laid[page, row : row + shown.shape[0], column : column + shown.shape[1]] = shown
    return laid


def sending_strips(ctx: moderngl.Context, made: list[Bytes]) -> Generator[None, None, moderngl.TextureArray]:
    """Return the texels or the ranks of an atlas as a texture, a piece at a time."""
    texture = yield from mipmapping(ctx, made)
    texture.repeat_x = texture.repeat_y = False
    return texture


def _extents(
    stock: Sequence[list[list[Strips]]], columns: Sequence[int], begins: NDArray[np.int64], pages: Pages
) -> NDArray[np.float32]:
    extents = np.zeros((len(pages.places), max(columns) + 1, 4), np.float32)
    side = np.array(pages.shape[:0:-1])
    extents[:, :-1, 3] = pages.places[:, :1]
    extents[:, -1, :2] = (pages.places[:, 1:] - begins)[:, ::-1] / side
    first = 0
    for ring, count in zip(stock, columns, strict=True):
        for strips in _each([ring]):
            own = slice(first, first + _pictures(strips))
            extents[own, :count, :3] = painted_extents(strips, count)
            extents[own, -1, 2:] = np.array(strips.texels.shape[3:1:-1]) / side
            first = own.stop
    return extents


def extent_texture(ctx: moderngl.Context, extents: NDArray[np.float32]) -> moderngl.Texture:
    """Return the extents of an atlas as a texture."""
    texture = ctx.texture((extents.shape[1], len(extents)), 4, extents.tobytes(), dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def painted_extents(strips: Strips, columns: int, /) -> NDArray[np.float32]:
    """Return from where to where across each column there is paint, and up to where: shape (pictures, columns, 3).

    All are fractions of the column and of the strip's height, with a texel to spare; pictures as in the atlas.
    """
    painted: Mask = np.asarray(strips.texels[..., 3].reshape(-1, *strips.texels.shape[2:4]) > 0)
    width = painted.shape[2]
    extents = np.zeros((len(painted), columns, 3), np.float32)
    for column in range(columns):
        low, high = column * width / columns, (column + 1) * width / columns
        first = int(low)
        mine = painted[:, :, first : int(np.ceil(high))]
        (start, end), (_, top) = _ends(np.asarray(mine.any(axis=1))), _ends(np.asarray(mine.any(axis=2)))
        extents[:, column, 0] = (start - 1 + first - low) / (high - low)
        extents[:, column, 1] = (end + 1 + first - low) / (high - low)
        extents[:, column, 2] = (top + 1) / painted.shape[1]
        extents[~mine.any(axis=(1, 2)), column] = 0.0
    return np.clip(extents, 0.0, 1.0)


def _ends(painted: Mask) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the first painted place in each row (m, n), and the one after the last, shape (m,) each."""
    return painted.argmax(axis=1), painted.shape[1] - painted[:, ::-1].argmax(axis=1)


def _each(stock: Sequence[list[list[Strips]]]) -> list[Strips]:
    return [strips for kinds in stock for models in kinds for strips in models]


def _pictures(strips: Strips) -> int:
    return 2 * len(strips.plane)
