"""Gathering: what is seen of the pools, laid out for the graphics card."""

import numpy as np
from numpy.typing import NDArray

from ..components.patch import PatchTable
from ..components.receivers import BladePool, StripPool
from .draw.strips import STRIP
from .receive import Shown

Floats = NDArray[np.float32]


def gather_blades(pool: BladePool, shown: Shown, /) -> tuple[NDArray[np.void], Floats, Floats]:
    """Return the records (n,), messages (n, 2) and fades (n,) of the blades that grow on the patches shown."""
    present = pool.present[shown.slots]
    fade = np.broadcast_to(shown.fade[:, None], present.shape)
    if present.all():
        return pool.blade[shown.slots].reshape(-1), pool.message[shown.slots].reshape(-1, 2), fade.reshape(-1)
    return pool.blade[shown.slots][present], pool.message[shown.slots][present], fade[present]


def gather_strips(
    pool: StripPool, shown: Shown, table: PatchTable, centre: NDArray[np.int32], /
) -> tuple[NDArray[np.void], NDArray[np.int64]]:
    """Return the polygon strips of the patches shown, far to near, and how many there are on each patch.

    They are records of `STRIP`, shape (n,); the counts have shape (m,).

    Strips are stored by rising place in their stack; where the viewer is on the low side they are walked backwards.
    """
    cell = table.cell[shown.rows]
    ahead = np.take_along_axis(cell - centre, 1 - shown.along[:, None], axis=1)[:, 0] > 0
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
    span = np.linspace(0.0, 1.0, columns + 1, dtype=np.float32)
    records["u"] = np.stack([span[:-1], span[1:]], axis=-1)
    records["layer"] = pool.layer[at][..., None]
    records["kind"] = kind[..., None]
    records["turn"] = table.turn[shown.rows][:, None, None, None]
    records["fade"] = shown.fade[:, None, None, None]
    grows = pool.present[at[:2]]
    grown: NDArray[np.void] = records[grows].reshape(-1)
    return grown, grows.sum(axis=(1, 2)) * columns


def runs(shown: list[Shown], counts: list[NDArray[np.int64]], /) -> list[tuple[int, int, int]]:
    """Return the draws that show all rings' strips from far to near: ring, first strip, number of strips.

    `counts` are the numbers of strips on each patch, by ring. Patches of one ring that follow one another are drawn
    at once.
    """
    total = sum(len(ring.queue) for ring in shown)
    ring_of, amount = np.zeros(total, np.int64), np.zeros(total, np.int64)
    for number, (ring, count) in enumerate(zip(shown, counts, strict=True)):
        ring_of[ring.queue], amount[ring.queue] = number, count
    if not total:
        return []
    starts = np.flatnonzero(np.diff(ring_of, prepend=-1))
    done = [0] * len(shown)
    draws = []
    for start, end in zip(starts.tolist(), [*starts[1:].tolist(), total], strict=True):
        number, size = int(ring_of[start]), int(amount[start:end].sum())
        draws.append((number, done[number], size))
        done[number] += size
    return draws
