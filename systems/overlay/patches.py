"""Patches: which representation each one has, and how far it is on its way to another (paper, figure 5)."""

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.quality import Representation
from ..field import Field
from ..lod import weights
from ..around.appearance import kept_near
from .marks import Marks, filled, on_ground, split, stroked, together
from .paint import ring_shades

Floats = NDArray[np.float32]
Rows = NDArray[np.int64]

FILL = 0.48
"""Opacity of a patch's square."""

INNER = 0.7
"""Opacity of the finer representation's share of it."""

OUTLINED = 20.0
"""Distance up to which the outlines of changing patches are bright [m]; farther off there are too many."""

GAP = 0.035
"""Width of the gap inside a patch's border, of its side."""

SETTLED = 0.995
"""Weight from which on a patch has one representation alone."""


def shown_level(field: Field, /) -> NDArray[np.int8]:
    """Return the representation that each patch is shown in, or of two the one that it has or is coming to, (rows,)."""
    share = patch_weights(field)
    alone = share.max(axis=0) >= SETTLED
    return np.where(alone, share.argmax(axis=0), field.table.representation).astype(np.int8)


def patch_colors(field: Field, /) -> Floats:
    """Return the colour of each patch's representation, shape (rows, 3).

    Its shade tells the ring, blended where the patch is on its way from one ring to another.
    """
    table, here = field.table, shown_level(field)
    color = np.tile(ring_shades(Representation.CARPET, 1), (len(here), 1))
    rings = len(field.quality.blade_rings), len(field.quality.strip_rings)
    for level, count in zip((Representation.BLADES, Representation.STRIPS), rings, strict=True):
        shades, fold = ring_shades(level, count), int(level == Representation.STRIPS)
        rows = np.flatnonzero(here == level)
        part = table.sublevel_progress[level, rows, None]
        now, before = (
            shades[np.maximum(ring[level, rows] >> fold, 0)] for ring in (table.sublevel, table.sublevel_before)
        )
        color[rows] = before + (now - before) * part
    return color


def patch_weights(field: Field, /) -> Floats:
    """Return how much each representation counts on each patch, shape (3, rows): the border of the strips included."""
    table, patch = field.table, np.float32(field.quality.patch)
    eye = np.array(field.sight.eye, np.float32)[[0, 2]]
    away = np.abs((table.cell + np.float32(0.5)) * patch - eye).max(axis=1) / patch
    share = weights(table)
    handed = share[Representation.STRIPS] * (1.0 - kept_near(away, reach=field.reach[Representation.STRIPS]))
    share[Representation.STRIPS] -= handed
    share[Representation.CARPET] += handed
    return share


def squares(cell: NDArray[np.int32], /, *, patch: float, part: Floats | float = 1.0) -> Floats:
    """Return the corners (x, z) [m] of squares in the middle of cells (n, 2), going round: shape (n, 4, 2).

    `part` is their side, of the patch's without its gap: one number, or one each (n,).
    """
    half = np.broadcast_to(np.asarray(part, np.float32) * np.float32(0.5 - GAP), (len(cell),))
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]], np.float32)
    middle = cell.astype(np.float32)[:, None] + np.float32(0.5)
    return np.asarray((middle + corner * half[:, None, None]) * np.float32(patch), np.float32)


def mixed(field: Field, /) -> NDArray[np.bool_]:
    """Return which patches have two representations at once, shape (rows,)."""
    share = patch_weights(field)
    return np.asarray((share.max(axis=0) < SETTLED) & (share.sum(axis=0) > 0.0))


def level_marks(field: Field, /, *, settled: bool = False) -> Marks:
    """Return a square on each patch in view, in the colour of its representation.

    With `settled`, those that have two at once are left out.
    """
    shown = field.table.alive & field.table.visible
    rows = np.flatnonzero(shown & ~mixed(field) if settled else shown)
    return _tiles(field, rows, patch_colors(field)[rows], FILL)


def weight_marks(field: Field, /) -> Marks:
    """Return the patches in view that have two representations at once, in the coarser one's colour.

    Inside each is a square of the finer one's, whose area is the finer one's share. Those that are changing are
    outlined; the others lie where strips give way to the carpet.
    """
    table, share = field.table, patch_weights(field)
    rows = np.flatnonzero(table.alive & table.visible & mixed(field))
    here = share[:, rows] > 1.0 - SETTLED
    finer, coarser = here.argmax(axis=0), len(Representation) - 1 - here[::-1].argmax(axis=0)
    part = np.sqrt(share[finer, rows] / share[:, rows].sum(axis=0))
    shades = np.concatenate([ring_shades(level, 1) for level in Representation])
    moving = rows[table.progress[rows] < 1.0]
    around = on_ground(field.terrain, squares(table.cell[moving], patch=field.quality.patch))
    away = np.linalg.norm(around.mean(axis=1) - np.array(field.sight.eye, np.float32), axis=1)
    bright = np.ones((len(moving), 4), np.float32)
    bright[:, 3] = 0.9 * np.minimum(1.0, OUTLINED / np.maximum(away, 1e-3)) ** 2
    return together(
        _tiles(field, rows, shades[coarser], FILL),
        _tiles(field, rows, shades[finer], INNER, part=part),
        stroked(
            around.reshape(-1, 3), np.roll(around, -1, axis=1).reshape(-1, 3), np.repeat(bright, 4, axis=0), width=1.5
        ),
    )  # fmt: skip


def _tiles(field: Field, rows: Rows, color: Floats, opacity: float, *, part: Floats | float = 1.0) -> Marks:
    flat = squares(field.table.cell[rows], patch=field.quality.patch, part=part)
    shown = np.column_stack([color, np.full(len(rows), opacity, np.float32)])
    return filled(split(on_ground(field.terrain, flat)), np.repeat(shown, 2, axis=0)[:, None, :])
