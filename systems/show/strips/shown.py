"""The patches that show strips in a frame, by ring, and the ranks of the blades that show on them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Ints, Rows
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...space.window import window_rows
from .sublevel import axis_of, ring_of


@dataclass(frozen=True, slots=True, eq=False)
class StripsOfRing:
    """The patches that show strips of one ring, far to near.

    A patch that is changing its sub-level has two entries: one with the blades that have changed already, and one with
    the others.
    """

    rows: Rows
    """Rows of the patch table, shape (m,)."""

    slots: Rows
    """Slots of the ring's pool, shape (m,)."""

    cover: Floats
    """Opacity of each patch's strips, in [0, 1], shape (m,)."""

    along: Ints
    """Axis along which each patch's strips run, shape (m,)."""

    queue: Rows
    """Place of each entry in the far-to-near order of all rings, shape (m,)."""

    least: Floats
    """Lowest rank of the blades that show, shape (m,)."""

    most: Floats
    """Upper limit of the ranks that show, shape (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class StripsShown:
    """All patches that show strips in a frame, or blades on their way to strips."""

    rings: list[StripsOfRing]


def show_strips(outlook: Outlook, cover: Floats, /, *, level: int, side: int, rings: int) -> StripsShown:
    """Return the patches that show strips to a viewer; `cover` (rows,) is the opacity of the strips on each patch.

    `level` is the number of the representation, `side` the number of patches along a side of each ring's pool.
    """
    patches, appears = outlook.patches, outlook.appearance
    reached = (appears.handed > 0.0) | (appears.morph > 0.0)
    # Beyond the room of the strips' pools, patches have no sub-level.
    seen = (patches.shown & (cover > 0.0) & reached & (patches.sublevel[level] >= 0)).nonzero()[0]
    entries = _entries(patches, patches.far_to_near(seen), level)
    cell = patches.cell.take(entries.rows, axis=0)
    slots = window_rows(cell, side=side) + side * side * entries.along.astype(np.int64)
    return StripsShown([_of_ring(cover, entries, slots, number) for number in range(rings)])


@dataclass(frozen=True, slots=True, eq=False)
class _Entries:
    """Patches that show strips, an entry for every sub-level that a patch shows, all of shape (m,)."""

    rows: Rows
    ring: NDArray[np.int64]
    along: Ints
    least: Floats
    most: Floats


def _entries(patches: PatchTable, rows: Rows, level: int) -> _Entries:
    now, before = patches.sublevel[level, rows], patches.sublevel_before[level, rows]
    progress = patches.sublevel_progress[level, rows]
    changing = (progress < 1.0) & (now != before)
    if not changing.any():
        whole = np.ones(len(rows), np.float32)
        return _Entries(rows, ring_of(now), axis_of(now), least=0.0 * whole, most=whole)
    # Neighbours with the same change are drawn together: their old entries, then their new ones. Otherwise each patch
    # would take two draw calls.
    change = np.where(changing, 256 * (before.astype(np.int64) + 1) + now + 1, 0)
    group = np.concatenate([[0], np.cumsum(change[1:] != change[:-1])])
    index = np.concatenate([np.arange(len(rows)), np.flatnonzero(changing)])
    is_old = np.arange(len(index)) >= len(rows)
    queue = np.argsort(2 * group[index] + ~is_old, kind="stable")
    index, is_old = index[queue], is_old[queue]
    sublevel, other = (np.where(is_old, a[index], b[index]) for a, b in ((before, now), (now, before)))
    # The lower sub-level shows the lower ranks: a change that is reversed half-way goes back the way it came.
    progress, lower, higher = progress[index], sublevel < other, sublevel > other
    limit = np.where(lower == is_old, np.float32(1.0) - progress, progress)
    return _Entries(
        rows=rows[index],
        ring=ring_of(sublevel),
        along=axis_of(sublevel),
        least=np.where(higher & changing[index], limit, np.float32(0.0)),
        most=np.where(lower & changing[index], limit, np.float32(1.0)),
    )


def _of_ring(cover: Floats, entries: _Entries, slots: Rows, number: int) -> StripsOfRing:
    queue = (entries.ring == number).nonzero()[0]
    rows, along = entries.rows[queue], entries.along[queue]
    return StripsOfRing(rows, slots[queue], cover[rows], along, queue, entries.least[queue], entries.most[queue])
