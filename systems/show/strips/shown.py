"""Which patches have strips in a frame, in which ring, and with which of their blades."""

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
    """The patches with strips of one ring, far to near.

    A patch whose strips are on their way to another sub-level is there twice: with the blades that have gone over, and
    with those that have not.
    """

    rows: Rows
    """Rows of the patch table, shape (m,)."""

    slots: Rows
    """Slots of the ring's pool, shape (m,)."""

    fade: Floats
    """How much of each shows, in [0, 1], shape (m,)."""

    along: Ints
    """Axis along which each patch's strips run, shape (m,)."""

    queue: Rows
    """Place of each in the far-to-near order of all rings' patches, shape (m,)."""

    least: Floats
    """Rank from which on blades are painted on each one's strips, shape (m,)."""

    most: Floats
    """Rank up to which they are, shape (m,)."""


@dataclass(frozen=True, slots=True, eq=False)
class StripsShown:
    """All patches with strips in a frame."""

    rings: list[StripsOfRing]
    """By ring, those with strips, or with blades on their way to them."""


def show_strips(outlook: Outlook, cover: Floats, /, *, level: int, side: int, rings: int) -> StripsShown:
    """Return the patches with strips that a viewer is shown, where `cover` (rows,) says how much they cover.

    `level` is the number of the representation, `side` that of patches along a side of each ring's pool.
    """
    patches, appears = outlook.patches, outlook.appearance
    assert appears is not None
    reached = (appears.handed > 0.0) | (appears.morph > 0.0)
    # Farther out than there is room for strips, patches have no sub-level.
    seen = (patches.shown & (cover > 0.0) & reached & (patches.sublevel[level] >= 0)).nonzero()[0]
    entries = _entries(patches, patches.far_to_near(seen), level)
    cell = patches.cell.take(entries.rows, axis=0)
    slots = window_rows(cell, side=side) + side * side * entries.along.astype(np.int64)
    return StripsShown([_of_ring(cover, entries, slots, number) for number in range(rings)])


@dataclass(frozen=True, slots=True, eq=False)
class _Entries:
    """Patches with strips, each once for every sub-level that it shows, all of shape (m,)."""

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
    # Neighbours that change alike are drawn together, or each would take two draws of its own.
    kind = np.where(changing, 256 * (before.astype(np.int64) + 1) + now + 1, 0)
    alike = np.concatenate([[0], np.cumsum(kind[1:] != kind[:-1])])
    index = np.concatenate([np.arange(len(rows)), np.flatnonzero(changing)])
    old = np.arange(len(index)) >= len(rows)
    queue = np.argsort(2 * alike[index] + ~old, kind="stable")
    index, old = index[queue], old[queue]
    sublevel, other = (np.where(old, a[index], b[index]) for a, b in ((before, now), (now, before)))
    # The lower number shows the lower ranks: so a change that is reversed half-way goes back the way it came.
    progress, lower, higher = progress[index], sublevel < other, sublevel > other
    parted = np.where(lower == old, np.float32(1.0) - progress, progress)
    return _Entries(
        rows=rows[index],
        ring=ring_of(sublevel),
        along=axis_of(sublevel),
        least=np.where(higher & changing[index], parted, np.float32(0.0)),
        most=np.where(lower & changing[index], parted, np.float32(1.0)),
    )


def _of_ring(cover: Floats, entries: _Entries, slots: Rows, number: int) -> StripsOfRing:
    queue = (entries.ring == number).nonzero()[0]
    rows, along = entries.rows[queue], entries.along[queue]
    return StripsOfRing(rows, slots[queue], cover[rows], along, queue, entries.least[queue], entries.most[queue])
