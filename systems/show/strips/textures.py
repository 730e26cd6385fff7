"""The strips of all rings as textures."""

from collections.abc import Generator, Sequence
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Bytes, Mask
from ....engine.gl.mipmaps import levels, mipmapping
from ....engine.gl.texture import by_texel
from ...grow.record import Growth
from .grow import Strips, strips_of
from .pages import ALIGNMENT, SPARE, Pages, packed


@dataclass(frozen=True, slots=True, eq=False)
class Atlas:
    """The pictures of all strips on pages, ordered by ring, kind, model, orientation and strip."""

    texels: list[Bytes]
    """Texels as in `Strips.texels`, an array (pages, rows, columns, 4) for each mip level, finest first."""

    ranks: list[Bytes]
    """Ranks of the texels, an array (pages, rows, columns) for each mip level; used where blades are missing."""

    extents: NDArray[np.float32]
    """Painted part of each picture's columns, shape (pictures, columns + 1, 4): left and right end as fractions of the
    column, top end as a fraction of the height, and the page. A texel on every side counts as painted. The last entry
    is the whole picture's rectangle on its page: left, bottom, width, height, as fractions of the page. It includes
    empty parts that the page leaves out."""


def strip_stocks(growths: Sequence[Growth]) -> list[list[list[Strips]]]:
    """Return the strips of all rings, by ring, kind and model."""
    rings = range(len(strips_of(growths[0].models[0])))
    return [[[strips_of(model)[ring] for model in growth.models] for growth in growths] for ring in rings]


def strip_atlas(stock: Sequence[list[list[Strips]]], columns: Sequence[int]) -> Atlas:
    """Return the atlas of all strips; `columns` gives the number of columns of a strip by ring."""
    every = _flat(stock)
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
    """Return the first (row, column) of each picture's painted part, and the end after the last, (pictures, 2, 2).

    `SPARE` texels are added on all sides. Boxes begin at the ground, and at a multiple of `ALIGNMENT` columns, so that
    their mip levels consist of the same texels as those of the whole picture.
    """
    painted = _painted(strips)
    (_, top), (left, right) = (_ends(np.asarray(painted.any(axis=axis))) for axis in (2, 1))
    low, high = [0 * top, (left - SPARE) // ALIGNMENT * ALIGNMENT], [top + SPARE, right + SPARE]
    box: NDArray[np.int64] = np.clip(np.array([low, high]).transpose(2, 0, 1), 0, painted.shape[1:])
    return box


def _laid(pictures: Sequence[Bytes], boxes: NDArray[np.int64], pages: Pages) -> Bytes:
    """Return pages with the `boxes` of all pictures (orientations, strips, rows, columns, ...); the rest is 0."""
    laid = np.zeros((*pages.shape, *pictures[0].shape[4:]), np.uint8)
    flat = (picture for of_model in pictures for picture in of_model.reshape(-1, *of_model.shape[2:]))
    for (page, row, column), (low, high), picture in zip(pages.places.tolist(), boxes.tolist(), flat, strict=True):
        part = picture[low[0] : high[0], low[1] : high[1]]
        laid[page, row : row + part.shape[0], column : column + part.shape[1]] = part
    return laid


def sending_strips(ctx: moderngl.Context, mip_levels: list[Bytes]) -> Generator[None, None, moderngl.TextureArray]:
    """Upload the mip levels of an atlas's texels or ranks a piece at a time; return the texture."""
    texture = yield from mipmapping(ctx, mip_levels)
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
        for strips in _flat([ring]):
            rows = slice(first, first + _pictures(strips))
            extents[rows, :count, :3] = painted_extents(strips, count)
            extents[rows, -1, 2:] = np.array(strips.texels.shape[3:1:-1]) / side
            first = rows.stop
    return extents


def extent_texture(ctx: moderngl.Context, extents: NDArray[np.float32]) -> moderngl.Texture:
    """Return the extents of an atlas as a texture."""
    return by_texel(ctx.texture((extents.shape[1], len(extents)), 4, extents.tobytes(), dtype="f4"))


def painted_extents(strips: Strips, columns: int, /) -> NDArray[np.float32]:
    """Return the left, right and top end of the paint in each column, shape (pictures, columns, 3).

    They are fractions of the column's width and of the strip's height, a texel beyond the paint. Pictures are ordered
    as in the atlas.
    """
    painted = _painted(strips)
    width = painted.shape[2]
    extents = np.zeros((len(painted), columns, 3), np.float32)
    for column in range(columns):
        low, high = column * width / columns, (column + 1) * width / columns
        first = int(low)
        part = painted[:, :, first : int(np.ceil(high))]
        (start, end), (_, top) = _ends(np.asarray(part.any(axis=1))), _ends(np.asarray(part.any(axis=2)))
        extents[:, column, 0] = (start - 1 + first - low) / (high - low)
        extents[:, column, 1] = (end + 1 + first - low) / (high - low)
        extents[:, column, 2] = (top + 1) / painted.shape[1]
        extents[~part.any(axis=(1, 2)), column] = 0.0
    return np.clip(extents, 0.0, 1.0)


def _painted(strips: Strips) -> Mask:
    """Return which texels of each picture are painted, shape (pictures, rows, columns)."""
    return np.asarray(strips.texels[..., 3].reshape(-1, *strips.texels.shape[2:4]) > 0)


def _ends(painted: Mask) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the index of the first painted element of each row (m, n), and that after the last, shape (m,) each."""
    return painted.argmax(axis=1), painted.shape[1] - painted[:, ::-1].argmax(axis=1)


def _flat(stock: Sequence[list[list[Strips]]]) -> list[Strips]:
    return [strips for kinds in stock for models in kinds for strips in models]


def _pictures(strips: Strips) -> int:
    """Return the number of pictures of a patch model in a ring: one for each strip and orientation."""
    return 2 * len(strips.plane)
