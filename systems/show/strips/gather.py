"""Gathering: what is seen of the pools, laid out for the graphics card."""

import numpy as np
from numpy.typing import NDArray

from ...around.appearance import Appearance, handed_over
from ...around.patches import PatchTable
from .draw import KINDS, STRIP
from .pool import StripPool
from .shown import StripsOfRing

MOST = 8
"""Draws of strips in a frame at most."""


def lies_ahead(cell: NDArray[np.int32], centre: NDArray[np.int32], along: NDArray[np.int32], /) -> NDArray[np.bool_]:
    """Return whether cells (m, 2) lie ahead of the viewer on the axis that their strips are stacked along, (m,)."""
    return np.asarray(np.take_along_axis(cell - centre, 1 - along[:, None], axis=1)[:, 0] > 0)


def gather_strips(
    pool: StripPool,
    shown: StripsOfRing,
    appears: Appearance,
    patches: PatchTable,
    centre: NDArray[np.int32],
    /,
    *,
    ring: int = 0,
    first_layer: int = 0,
    fade: bool = True,
) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """Return the polygon strips of a ring's patches shown, far to near, and how many there are on each patch.

    They are records of `STRIP`, shape (n,), and those of one strip follow one another; the counts have shape (m,).
    The pictures of the `ring` begin at the `first_layer`. `fade` says that a strip appears gradually while blades are
    handed over to it.

    Strips are stored by rising place in their stack; where the viewer is on the low side they are walked backwards.
    """
    ahead = lies_ahead(patches.cell[shown.rows], centre, shown.along)
    _, kinds, count = pool.layer.shape
    order = np.where(ahead[:, None], np.arange(count)[::-1], np.arange(count))[..., None]
    # Strips of several kinds share a plane: each kind comes to lie in front as often as behind.
    kind = (np.arange(kinds) + order) % kinds
    at = shown.slots[:, None, None], kind, order
    place, ground, message = pool.place[at], pool.ground[at], pool.message[at]
    columns = place.shape[3] - 1
    records = np.zeros((*place.shape[:3], columns), STRIP)
    for side, edge in (("a", slice(None, -1)), ("b", slice(1, None))):
        records[side][..., ::2] = place[..., edge, :]
        records[side][..., 1] = ground[..., edge]
        records["wind"][..., slice(0, 2) if side == "a" else slice(2, 4)] = message[..., edge, :]
    records["layer"] = pool.layer[at][..., None] + np.float32(first_layer)
    records["picture"] = KINDS * ring + kind[..., None]
    records["stand"] = 4 * np.arange(columns) + patches.turn[shown.rows][:, None, None, None]
    records["growth"] = appears.growth[shown.rows][:, None, None, None]
    records["ranks"] = np.where(shown.least > 0.0, -shown.least, shown.most)[:, None, None, None]
    covers = shown.fade * handed_over(appears.handed[shown.rows], fade=fade)[1]
    records["fade"] = covers[:, None, None, None]
    grows = pool.present[at[:2]] & (covers > 0.0)[:, None, None]
    # `take` copies records whole, many times as fast as an index does field by field.
    grown: NDArray[np.void] = records.reshape(-1, columns).take(np.flatnonzero(grows), axis=0).reshape(-1)
    return grown, grows.sum(axis=(1, 2)) * columns


def in_one_queue(
    shown: list[StripsOfRing], gathered: list[tuple[NDArray[np.void], NDArray[np.int64]]], /
) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """Return the strips of all rings from far to near, and how many each patch has in that order.

    `gathered` are the strips of each ring and how many there are on each of its patches.
    """
    place = np.concatenate([ring.queue for ring in shown])
    amount = np.concatenate([counts for _, counts in gathered])
    order = np.argsort(place, kind="stable")
    start = np.cumsum(amount) - amount
    end = np.cumsum(amount[order])
    rows = np.arange(end[-1] if len(end) else 0) + np.repeat(start[order] - (end - amount[order]), amount[order])
    return np.concatenate([records for records, _ in gathered]).take(rows), amount[order]


def runs(ranked: NDArray[np.bool_], amount: NDArray[np.int64], /) -> list[tuple[int, int, bool]]:
    """Return the draws that show strips from far to near: first strip, number of strips, whether by rank.

    `ranked` says which patches have to be drawn by rank, `amount` how many strips each has, both in their order, (m,).
    Patches that follow one another are drawn together; where that would make more than `MOST` draws, all are drawn
    by rank at once, which takes longer for each pixel and shows the same.
    """
    if not len(ranked):
        return []
    starts = np.flatnonzero(np.diff(ranked.astype(np.int8), prepend=-1))
    first = np.concatenate([[0], np.cumsum(amount)])
    if len(starts) > MOST:
        return [(0, int(first[-1]), True)]
    ends = [*starts[1:].tolist(), len(ranked)]
    return [
        (int(first[start]), int(first[end] - first[start]), bool(ranked[start]))
        for start, end in zip(starts.tolist(), ends, strict=True)
    ]
