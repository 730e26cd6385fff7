"""Terrains of ground that streams: windows and single blocks, of a function's heights and a game's changes."""

import numpy as np

from .blocks import BLOCK, SPARE, SQUARE, Blocks, Numbers
from .record import Terrain
from .rectangle import Rectangle


def window_of(blocks: Blocks, first: Numbers, /) -> Terrain:
    """Return the terrain of the window that begins at the sample `first`, with a game's changes.

    It may be called on another thread.
    """
    made = _joined(blocks, first, blocks.cells // BLOCK, blocks)
    blocks.forget(first)
    return made


def tile_of(blocks: Blocks, row: int, column: int, /) -> Terrain:
    """Return the terrain of one block, with a game's changes."""
    with blocks.lock:
        found: Terrain | None = blocks.tiles.get((row, column))
        if found is None:
            if len(blocks.tiles) >= SPARE:
                blocks.tiles.clear()
            found = blocks.tiles[row, column] = _joined(blocks, (BLOCK * row, BLOCK * column), 1, None)
        return found


def _joined(blocks: Blocks, first: Numbers, count: int, own: Blocks | None) -> Terrain:
    side = BLOCK * count + 1
    heights, holes = np.empty((side, side), np.float32), np.zeros((side, side), np.bool_)
    for down in range(count):
        for right in range(count):
            here = np.s_[BLOCK * down : BLOCK * (down + 1) + 1, BLOCK * right : BLOCK * (right + 1) + 1]
            heights[here], block_holes = blocks.block(first[0] // BLOCK + down, first[1] // BLOCK + right)
            if block_holes is not None:
                holes[here] = block_holes
    made = Terrain(heights, blocks.cell, holes if holes.any() else None, first=first, blocks=own)
    with blocks.lock:
        changed = [*blocks.changed]
    for square in changed:
        paste(blocks, made, square)
    return made


def paste(blocks: Blocks, onto: Terrain, square: Numbers, /) -> None:
    """Copy a square's present heights and holes into a terrain, where they overlap."""
    assert onto.first is not None
    row, column = (SQUARE * at - low for at, low in zip(square, onto.first, strict=True))
    part = Rectangle(row, column, SQUARE, SQUARE).within(*onto.heights.shape)
    if part is not None:
        own = part.moved(-row, -column).slices
        heights, holes = blocks.square(square)
        onto.put(part, heights[own], holes[own])
