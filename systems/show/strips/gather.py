"""Gathering: what is seen of the pools, laid out for the graphics card."""

import numpy as np
from numpy.typing import NDArray

from ...around.appearance import Appearance, handed_over
from ...around.patches import PatchTable
from .draw import STRIP
from .pool import StripPool
from .shown import StripsOfRing


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
    fade: bool = True,
) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """Return the polygon strips of the patches shown, far to near, and how many there are on each patch.

    They are records of `STRIP`, shape (n,), and those of one strip follow one another; the counts have shape (m,).
    `fade` says that a strip appears gradually while blades are handed over to it.

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
    records["layer"] = pool.layer[at][..., None]
    records["kind"] = kind[..., None]
    records["turn"] = patches.turn[shown.rows][:, None, None, None]
    records["growth"] = appears.growth[shown.rows][:, None, None, None]
    records["ranks"] = np.where(shown.least > 0.0, -shown.least, shown.most)[:, None, None, None]
    covers = shown.fade * handed_over(appears.handed[shown.rows], fade=fade)[1]
    records["fade"] = covers[:, None, None, None]
    grows = pool.present[at[:2]] & (covers > 0.0)[:, None, None]
    grown: NDArray[np.void] = records[grows].reshape(-1)
    return grown, grows.sum(axis=(1, 2)) * columns


def runs(
    shown: list[StripsOfRing], counts: list[NDArray[np.int64]], thin: list[bool], /
) -> list[tuple[int, int, int, bool]]:
    """Return the draws that show all rings' strips from far to near: ring, first strip, number of strips, by rank.

    `counts` are the numbers of strips on each patch, by ring. Patches of one ring that follow one another are drawn
    together. Patches that show only some of their blades, and all of a ring that is `thin`, are drawn by rank, in
    draws of their own.
    """
    total = sum(len(ring.queue) for ring in shown)
    ring_of, amount, ranked = np.zeros(total, np.int64), np.zeros(total, np.int64), np.zeros(total, np.bool_)
    for number, (ring, count) in enumerate(zip(shown, counts, strict=True)):
        ring_of[ring.queue], amount[ring.queue] = number, count
        ranked[ring.queue] = thin[number] | (ring.most < 1.0) | (ring.least > 0.0)
    if not total:
        return []
    starts = np.flatnonzero(np.diff(2 * ring_of + ranked, prepend=-1))
    done = [0] * len(shown)
    draws = []
    for start, end in zip(starts.tolist(), [*starts[1:].tolist(), total], strict=True):
        number, size = int(ring_of[start]), int(amount[start:end].sum())
        draws.append((number, done[number], size, bool(ranked[start])))
        done[number] += size
    return draws
