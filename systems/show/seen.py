"""Seeing: which patches are drawn in this frame, how fine each of them, and on its way from what to what.

A `Shown` record names patches drawn in one representation; what follows works on all of them at once, in a few numpy
passes.
"""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.quality import Representation
from ..around.cone import far_to_near
from ..around.patches import PatchTable
from ..around.window import window_rows
from ..field import Field
from ..lod import weights
from ..around.appearance import Looks, kept_near, looks

Floats = NDArray[np.float32]
Ints = NDArray[np.int32]
Rows = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """The patches drawn in one ring of one representation, far to near.

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

    slide: Floats
    """How far the joints of each one's blades have slid together to those of the next ring, shape (m,)."""

    least: Floats
    """Rank from which on blades are painted on each one's strips, shape (m,)."""

    most: Floats
    """Rank up to which they are, shape (m,)."""

    @classmethod
    def whole(cls, rows: Rows, slots: Rows) -> "Shown":
        """Return patches all of whose blades show, wholly."""
        ones, zeros = np.ones(len(rows), np.float32), np.zeros(len(rows), np.float32)
        return cls(rows, slots, ones, np.zeros(len(rows), np.int32), np.arange(len(rows)), zeros, zeros, ones)


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """All patches that are drawn in this frame."""

    standing: Shown
    """Those with blades, each once."""

    blades: list[Shown]
    """By ring, those with blades that stand in their own places."""

    morphing: Shown
    """Those whose blades are on their way to their painted places, or back."""

    strips: list[Shown]
    """By ring, those with strips, or with blades on their way to them."""

    looks: Looks
    """How each patch of the table shows."""


def look(field: Field, weight: Floats, /) -> Looks:
    """Return how each patch of the table shows, where `weight` (3, rows) says how far it is each representation."""
    table, eye, patch = field.table, field.sight.eye, np.float32(field.quality.patch)
    away = np.abs((table.cell + np.float32(0.5)) * patch - np.array([eye[0], eye[2]], np.float32)).max(axis=1)
    kept = kept_near(away / patch, reach=field.reach[Representation.STRIPS])
    return looks(weight, kept, transitions=field.transitions)


def see(field: Field, shows: Looks, /) -> Seen:
    """Return the patches to draw in this frame: those inside the view cone, in each representation that they show."""
    table, centre = field.table, field.sight.centre
    seen = np.flatnonzero(table.alive & table.visible & ((shows.blades > 0.0) | (shows.strips > 0.0)))
    seen = seen[far_to_near(table.cell[seen], centre)]
    near = seen[shows.blades[seen] > 0.0]
    moving = shows.morph[near] > 0.0
    slots = window_rows(table.cell[near], side=field.blades.side)
    still = near[~moving]
    ring, slide = _blade_rings(table, still)
    painted = (shows.strips[seen] > 0.0) & ((shows.handed[seen] > 0.0) | (shows.morph[seen] > 0.0))
    strips = _entries(table, seen[painted & (table.sublevel[1, seen] >= 0)])  # farther out there is no room for them
    return Seen(
        standing=Shown.whole(near, slots),
        blades=[
            _blades(shows, still, slots[~moving], slide, np.flatnonzero(ring == number))
            for number in range(len(field.quality.blade_rings))
        ],
        morphing=Shown.whole(near[moving], slots[moving]),
        strips=[_strips(field, shows, strips, number, pool.side) for number, pool in enumerate(field.strips)],
        looks=shows,
    )


def _blade_rings(table: PatchTable, rows: Rows) -> tuple[NDArray[np.int8], Floats]:
    """Return the ring that each patch's blades are drawn in, and how far they have become those of the next."""
    now, before = table.sublevel[0, rows], table.sublevel_before[0, rows]
    part = table.sublevel_progress[0, rows]
    slide = np.where(now > before, part, np.where(now < before, np.float32(1.0) - part, np.float32(0.0)))
    over = part >= 1.0
    return np.where(over, now, np.minimum(now, before)), np.where(over, np.float32(0.0), slide)


def _blades(shows: Looks, rows: Rows, slots: Rows, slide: Floats, queue: Rows) -> Shown:
    whole = Shown.whole(rows[queue], slots[queue])
    return replace(whole, fade=shows.blades[whole.rows], queue=queue, slide=slide[queue])


@dataclass(frozen=True, slots=True, eq=False)
class _Entries:
    """Patches with strips, each once for every sub-level that it shows, all of shape (m,)."""

    rows: Rows
    ring: NDArray[np.int64]
    along: Ints
    least: Floats
    most: Floats


def _entries(table: PatchTable, rows: Rows) -> _Entries:
    now, before, part = table.sublevel[1, rows], table.sublevel_before[1, rows], table.sublevel_progress[1, rows]
    changing = (part < 1.0) & (now != before)
    index = np.repeat(np.arange(len(rows)), 1 + changing)
    twice, part = changing[index], part[index]
    old = twice & (np.diff(index, append=-1) != 0)
    # Neighbours that change alike are drawn together, or each would take two draws of its own.
    kind = np.where(changing, 256 * (before.astype(np.int64) + 1) + now + 1, 0)
    alike = np.cumsum(np.diff(kind, prepend=-1) != 0)[index]
    queue = np.argsort(2 * alike + ~old, kind="stable")
    index, twice, part, old = index[queue], twice[queue], part[queue], old[queue]
    sublevel = np.where(old, before[index], now[index]).astype(np.int64)
    return _Entries(
        rows=rows[index],
        ring=sublevel >> 1,
        along=(sublevel & 1).astype(np.int32),
        least=np.where(old, part, np.float32(0.0)),
        most=np.where(twice & ~old, part, np.float32(1.0)),
    )


def _strips(field: Field, shows: Looks, entries: _Entries, number: int, side: int) -> Shown:
    queue = np.flatnonzero(entries.ring == number)
    rows, along = entries.rows[queue], entries.along[queue]
    slots = window_rows(field.table.cell[rows], side=side) + along.astype(np.int64) * (side * side)
    zeros = np.zeros(len(rows), np.float32)
    return Shown(rows, slots, shows.strips[rows], along, queue, zeros, entries.least[queue], entries.most[queue])


def seen_now(field: Field, /) -> Seen:
    """Return the patches drawn in the frame that the field's table tells of."""
    return see(field, look(field, weights(field.table)))


def carpet_shares(field: Field, /) -> Floats:
    """Return how much the carpet shows on each patch of the table, shape (rows,); beyond the terrain's edge, whole."""
    return np.where(field.table.alive, look(field, weights(field.table)).carpet, np.float32(1.0))
