"""Morphing: blades on their way between their own places and their painted places (paper, section 4.2)."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...around.appearance import handed_over
from ...around.outlook import Outlook
from ...around.window import window_rows
from ..strips.gather import lies_ahead
from ..strips.pool import StripPool
from ..strips.representation import StripRepresentation
from .pool import BLADE, BladePool
from .shown import Standing

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


def gather_morph(
    outlook: Outlook, pool: BladePool, strips: StripRepresentation, shown: Standing, /, *, fade: bool
) -> Morph:
    """Return the blades of patches that are on their way in this frame, and the edges of their strips.

    `fade` says that blades disappear gradually while they are handed over.
    """
    ring, along = strips.ring_and_axis(outlook, shown.rows)
    parts, first = [], 0
    for number in np.unique(ring).tolist():
        here = ring == number
        chosen = Standing.whole(shown.rows[here], shown.slots[here])
        part = _of_ring(outlook, pool, strips, chosen, number, along[here], first, fade=fade)
        parts.append(part)
        first += len(part.edges)
    if not parts:
        return Morph(np.zeros(0, BLADE), np.zeros(0, MOVING), np.zeros(0, EDGE))
    return Morph(
        np.concatenate([part.blades for part in parts]),
        np.concatenate([part.moving for part in parts]),
        np.concatenate([part.edges for part in parts]),
    )


def _of_ring(
    outlook: Outlook,
    pool: BladePool,
    representation: StripRepresentation,
    shown: Standing,
    ring: int,
    along: NDArray[np.int32],
    first: int,
    *,
    fade: bool,
) -> Morph:
    patches, stock, appears = outlook.patches, representation.stock, outlook.appearance
    assert appears is not None
    strips, rows = representation.pools(outlook)[ring], shown.rows
    at = window_rows(patches.cell[rows], side=strips.side) + along.astype(np.int64) * strips.side**2
    model, turn = patches.model[rows], patches.turn[rows]
    own = (along + turn) % 2
    plane = stock.slices[ring][model, own]
    _, kinds, count, edges = strips.ground.shape
    stacked = np.argsort(strips.layer[at, 0].astype(np.int64) % count, axis=1)
    stack = np.take_along_axis(stacked, plane.astype(np.int64), axis=1)
    ahead = lies_ahead(patches.cell[rows], outlook.viewer.centre, along)
    place = np.where(ahead[:, None], count - 1 - stack, stack)
    left, _ = handed_over(appears.handed[rows], fade=fade)
    blade = pool.blade[shown.slots]
    moving = np.zeros(place.shape, MOVING)
    moving["message"], moving["fade"] = pool.message[shown.slots], left[:, None]
    moving["morph"] = appears.morph[rows][:, None]
    strip = (np.arange(len(rows))[:, None] * kinds + blade["kind"].astype(np.int64)) * count + stack
    moving["edge"] = first + strip * edges
    moving["painted"] = ((model * 2 + own) * place.shape[1])[:, None] + np.arange(place.shape[1])
    queue = _far_slices_first(place, pool.place[shown.slots], outlook.viewer.eye)
    kept = np.take_along_axis(pool.present[shown.slots] & (left > 0.0)[:, None], queue, axis=1)
    return Morph(
        np.take_along_axis(blade, queue, axis=1)[kept],
        np.take_along_axis(moving, queue, axis=1)[kept],
        _edges(strips, representation, ring, at, appears.growth[rows]),
    )


def _far_slices_first(slices: Integers, place: Floats, eye: tuple[float, float, float]) -> Integers:
    """Return the order of each patch's blades (m, n): slice after slice, and far to near in a slice."""
    away = place - np.array([eye[0], eye[2]], np.float32)
    distance = np.sqrt(np.einsum("ijk,ijk->ij", away, away))
    nearness = (1.0 - distance / max(float(distance.max(initial=0.0)), 1e-6)) * 65535.0
    return np.argsort(slices * 65536 + nearness.astype(np.int64), axis=1, kind="stable")


def _edges(
    pool: StripPool, representation: StripRepresentation, ring: int, at: Integers, growth: Floats
) -> NDArray[np.void]:
    fineness = representation.quality.strip_rings[ring]
    edges = np.zeros(pool.ground[at].shape, EDGE)
    edges["foot"][..., ::2], edges["foot"][..., 1] = pool.place[at], pool.ground[at]
    tall = np.array([strips.height for strips in representation.stock.strips[ring]], np.float32)
    edges["height"] = growth[:, None, None, None] * tall[:, None, None]
    edges["message"] = pool.message[at]
    edges["columns"], edges["sections"] = fineness.columns, fineness.sections
    flat: NDArray[np.void] = edges.reshape(-1)
    return flat
