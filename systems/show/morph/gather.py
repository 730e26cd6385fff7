"""Morphing: blades on their way between their own places and their painted places (paper, section 4.2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...field import Field
from ...tile import window_rows
from ..blades.pool import BLADE
from ..looks import handed_over
from ..seen import Seen, Shown
from ..strips.gather import lies_ahead

Floats = NDArray[np.float32]
Integers = NDArray[np.int64]

MOVING = np.dtype([("message", "2f4"), ("fade", "f4"), ("morph", "f4"), ("edge", "f4"), ("painted", "f4")])
"""What changes each frame about a blade on its way: its receiver's message, how much it shows, how far it has moved,
the first edge of its strip, and which row of the targets is its."""

EDGE = np.dtype([("foot", "3f4"), ("height", "f4"), ("message", "2f4"), ("columns", "f4"), ("sections", "f4")])
"""A vertical edge of a strip: its foot [m], the strip's height [m], its message, and how many columns and sections its
strip has. The shader reads it as two texels."""


@dataclass(frozen=True, slots=True, eq=False)
class Morph:
    """Blades on their way, and the strips that they go to."""

    blades: NDArray[np.void]
    """Records of `BLADE`, far to near, shape (n,)."""

    moving: NDArray[np.void]
    """Records of `MOVING`, shape (n,)."""

    edges: NDArray[np.void]
    """Records of `EDGE`, those of one strip one after another, shape (e,)."""


def gather_morph(field: Field, seen: Seen, /) -> Morph:
    """Return the blades that are on their way in this frame, and the edges of their strips."""
    sublevel = field.table.sublevel[1, seen.morphing.rows].astype(np.int64)
    parts, first = [], 0
    for ring in np.unique(sublevel >> 1).tolist():
        here = sublevel >> 1 == ring
        shown = Shown.whole(seen.morphing.rows[here], seen.morphing.slots[here])
        part = _of_ring(field, seen, shown, ring, (sublevel[here] & 1).astype(np.int32), first)
        parts.append(part)
        first += len(part.edges)
    if not parts:
        return Morph(np.zeros(0, BLADE), np.zeros(0, MOVING), np.zeros(0, EDGE))
    return Morph(
        np.concatenate([part.blades for part in parts]),
        np.concatenate([part.moving for part in parts]),
        np.concatenate([part.edges for part in parts]),
    )


def _of_ring(field: Field, seen: Seen, shown: Shown, ring: int, along: NDArray[np.int32], first: int) -> Morph:
    table, pool, stock = field.table, field.blades, field.stock
    strips = field.strips[ring]
    rows, looks = shown.rows, seen.looks
    at = window_rows(table.cell[rows], side=strips.side) + along.astype(np.int64) * strips.side**2
    model, turn = table.model[rows], table.turn[rows]
    own = (along + turn) % 2
    order = stock.blades.order[model * 4 + turn, pool.stamp[shown.slots, 2]]
    plane = np.take_along_axis(stock.slices[ring][model, own], order, axis=1)
    _, kinds, count, edges = strips.ground.shape
    stacked = np.argsort(strips.layer[at, 0].astype(np.int64) % count, axis=1)
    stack = np.take_along_axis(stacked, plane.astype(np.int64), axis=1)
    ahead = lies_ahead(table.cell[rows], field.sight.centre, along)
    place = np.where(ahead[:, None], count - 1 - stack, stack)
    fade, _ = handed_over(looks.handed[rows], fade=field.transitions.fade)
    blade = pool.blade[shown.slots]
    moving = np.zeros(place.shape, MOVING)
    moving["message"], moving["fade"] = pool.message[shown.slots], fade[:, None]
    moving["morph"] = looks.morph[rows][:, None]
    strip = (np.arange(len(rows))[:, None] * kinds + blade["kind"].astype(np.int64)) * count + stack
    moving["edge"] = first + strip * edges
    moving["painted"] = ((model * 2 + own) * order.shape[1])[:, None] + order
    # Slice after slice: so they lie one behind another on their strips, too.
    queue = np.argsort(place, axis=1, kind="stable")
    kept = np.take_along_axis(pool.present[shown.slots] & (fade > 0.0)[:, None], queue, axis=1)
    return Morph(
        np.take_along_axis(blade, queue, axis=1)[kept],
        np.take_along_axis(moving, queue, axis=1)[kept],
        _edges(field, ring, at, looks.growth[rows]),
    )


def _edges(field: Field, ring: int, at: Integers, growth: Floats) -> NDArray[np.void]:
    pool, quality = field.strips[ring], field.quality.strip_rings[ring]
    edges = np.zeros(pool.ground[at].shape, EDGE)
    edges["foot"][..., ::2], edges["foot"][..., 1] = pool.place[at], pool.ground[at]
    tall = np.array([strips.height for strips in field.stock.strips[ring]], np.float32)
    edges["height"] = growth[:, None, None, None] * tall[:, None, None]
    edges["message"] = pool.message[at]
    edges["columns"], edges["sections"] = quality.columns, quality.sections
    flat: NDArray[np.void] = edges.reshape(-1)
    return flat
