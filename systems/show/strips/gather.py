"""Gathering: the patches with strips that are seen, and their polygon strips in the order of drawing."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ...around.appearance import Appearance, handed_over
from ...around.patches import PatchTable
from .shown import StripsOfRing

RUNS_ALONG, LIES_AHEAD, OF_RING = 4, 8, 16
"""What `stand` of a record has besides the patch's quarter turns: where strips run along z, where the patch lies
ahead of the viewer along the axis that they are stacked on, and for each ring."""

MOST_DRAWS = 8
"""Draws of strips in a frame at most."""

STOOD = np.dtype(
    [
        ("cell", "2f4"),
        ("model", "f4"),
        ("stand", "f4"),
        ("fade", "f4"),
        ("growth", "f4"),
        ("ranks", "f4"),
        ("receiver", "f4"),
    ]
)
"""A patch with strips: its cell and model, how its strips stand, how much they show, and how high they are, of their
full height; which of their blades show, and its first receiver.

`stand` is the patch's quarter turns, with `RUNS_ALONG`, `LIES_AHEAD` and `OF_RING`. The blades that show are those
whose rank is below `ranks`, or where that is negative those whose rank is not below -`ranks`. The shader reads two
texels."""


def lies_ahead(cell: NDArray[np.int32], centre: NDArray[np.int32], along: NDArray[np.int32], /) -> NDArray[np.bool_]:
    """Return whether cells (m, 2) lie ahead of the viewer on the axis that their strips are stacked along, (m,)."""
    apart = cell - centre
    return np.asarray(np.where(along == 0, apart[:, 1], apart[:, 0]) > 0)


def gather_strips(
    rings: Sequence[StripsOfRing],
    receivers: Sequence[tuple[int, int]],
    appears: Appearance,
    patches: PatchTable,
    centre: NDArray[np.int32],
    /,
    *,
    fade: bool = True,
) -> NDArray[np.void]:
    """Return the patches shown, ring after ring, as records of `STOOD`, shape (m,).

    `receivers` gives by ring the number of the first receiver, and how many each patch has: they follow one another.
    `fade` says that a strip appears gradually while blades are handed over to it.
    """
    rows, along, fades, least, most = (
        np.concatenate([getattr(ring, name) for ring in rings]) for name in ("rows", "along", "fade", "least", "most")
    )
    counts = [len(ring.rows) for ring in rings]
    cell = patches.cell.take(rows, axis=0)
    stood = np.zeros(len(rows), STOOD)
    stood["cell"], stood["model"] = cell, patches.model.take(rows)
    stand = np.repeat(OF_RING * np.arange(len(rings), dtype=np.int32), counts)
    stand += patches.turn.take(rows) + RUNS_ALONG * along + LIES_AHEAD * lies_ahead(cell, centre, along)
    stood["stand"] = stand
    stood["fade"] = fades * handed_over(appears.handed.take(rows), fade=fade)[1]
    stood["growth"] = appears.growth.take(rows)
    stood["ranks"] = np.where(least > 0.0, -least, most)
    stood["receiver"] = np.concatenate([
        first + each * np.arange(count) for (first, each), count in zip(receivers, counts, strict=True)
    ])  # fmt: skip
    return stood


def polygon_strips(
    stood: NDArray[np.void],
    patch: NDArray[np.int64],
    present: NDArray[np.bool_],
    fineness: list[tuple[int, int]],
    /,
    *,
    most: int,
) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """Return the polygon strips of patches in the order of drawing, and how many there are on each.

    `stood` are the records of all patches, `patch` (m,) the numbers of those that are drawn, from far to near, and
    `present` (m, kinds) says which kinds grow on them; `fineness` gives strips and columns by ring. A polygon strip's
    number is `most` times its patch's, plus (its strip's place on the way from far to near * kinds + its turn among the
    kinds) * columns + its column, shape (n,).
    """
    kinds = present.shape[1]
    stand = stood["stand"][patch].astype(np.int64)
    strips, columns = np.array(fineness, np.int64).take(stand // OF_RING, axis=0).T
    amount = strips * columns * kinds
    start = np.cumsum(amount) - amount
    numbers = np.arange(amount.sum(), dtype=np.uint32)
    numbers += np.repeat((patch * most - start).astype(np.uint32), amount)
    if present.all():
        return numbers, amount
    index = np.repeat(np.arange(len(patch)), amount)
    own = numbers - patch[index] * most
    strip, turn = np.divmod(own // columns[index], kinds)
    ahead = stand[index] // LIES_AHEAD % 2 == 1
    drawn = present[index, (turn + np.where(ahead, strips[index] - 1 - strip, strip)) % kinds]
    return numbers[drawn], np.bincount(index[drawn], minlength=len(patch))


def runs(ranked: NDArray[np.int8], amount: NDArray[np.int64], /) -> list[tuple[int, int, int]]:
    """Return the draws that show strips from far to near: first strip, number of strips, how.

    `ranked` says which patches have to be drawn by rank, 1, and which with edges of density, 2; `amount` how many
    strips each has, both in their order, (m,). Patches that follow one another are drawn together; where that would
    make more draws than `MOST_DRAWS`, some are drawn in a way that does for more, which takes longer for each pixel and
    shows the same.
    """
    if not len(ranked):
        return []
    first = np.concatenate([[0], np.cumsum(amount)])
    starts = _begins(ranked)
    if len(starts) > MOST_DRAWS:
        ranked = _alike(ranked, starts, first)
        starts = _begins(ranked)
    ends = [*starts[1:].tolist(), len(ranked)]
    return [
        (int(first[start]), int(first[end] - first[start]), int(ranked[start]))
        for start, end in zip(starts.tolist(), ends, strict=True)
    ]


def _begins(ranked: NDArray[np.int8]) -> NDArray[np.intp]:
    """Return where patches (m,) begin that are drawn otherwise than the one before, shape (n,)."""
    return np.flatnonzero(np.diff(ranked, prepend=np.int8(-1)))


def _alike(ranked: NDArray[np.int8], starts: NDArray[np.intp], first: NDArray[np.int64]) -> NDArray[np.int8]:
    """Return how patches (m,) are drawn in `MOST_DRAWS` at most: in the dearest way all but for the longest stretches.

    `starts` is where others begin, and `first` the first strip of each patch, and of none, (m + 1,).
    """
    dearest = ranked.max()
    cheaper = np.maximum.reduceat(ranked, starts) < dearest
    lies_in = np.cumsum(np.diff(cheaper, prepend=~cheaper[:1]))  # by stretch of those that are as dear, or cheaper
    index = np.repeat(lies_in - 1, np.diff(starts, append=len(ranked)))
    strips = np.bincount(index, np.diff(first)) * (np.bincount(index, ranked == dearest) == 0.0)
    kept = np.argsort(strips)[-(MOST_DRAWS // 2 - 1) :]
    ways = np.where(np.isin(index, kept) & (ranked < dearest), ranked, dearest)
    if len(_begins(ways)) > MOST_DRAWS:
        ways[ways < dearest] = ways[ways < dearest].max()
    return ways
