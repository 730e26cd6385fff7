"""Gathering: records of the patches with strips in the picture, and their polygon strips in the order of drawing."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...around.appearance import Appearance, handed_over
from ...around.patches import PatchTable
from .pool import StripPool
from .shown import StripsOfRing

RUNS_ALONG, LIES_AHEAD, OF_RING = 4, 8, 16
"""Summands of a placement's `code`: for strips that run along z; for a patch ahead of the viewer on the axis that its
strips are stacked along; and times the ring's number."""

MOST_DRAWS = 8
"""Largest number of draw calls for strips in a frame."""

FULL_DENSITY = 0.995
"""Density from which on no blade of a kind is missing."""

ALL_BLADES, BY_RANK, EDGED = range(3)
"""Drawing modes of patches, each dearer than the one before and able to draw its patches too: all blades show; some are
missing by their rank; and the density changes much on the patch."""

PLACEMENT = np.dtype(
    [
        ("cell", "2f4"),
        ("model", "f4"),
        ("code", "f4"),
        ("cover", "f4"),
        ("growth", "f4"),
        ("rank_limit", "f4"),
        ("receiver", "f4"),
    ]
)
"""A patch with strips: its cell and model, the orientation of its strips, their opacity, their height over their full
height, the limit of the ranks that show, and its first receiver.

`code` is the patch's number of quarter turns plus `RUNS_ALONG`, `LIES_AHEAD` and `OF_RING`. Blades show whose rank is
below `rank_limit`; where that is negative, those whose rank is at least -`rank_limit`. The shader reads two texels."""


class Batch(NamedTuple):
    """Polygon strips that one call draws."""

    first: int
    instances: int
    mode: int
    """`ALL_BLADES`, `BY_RANK` or `EDGED`."""


def lies_ahead(cell: NDArray[np.int32], centre: NDArray[np.int32], along: NDArray[np.int32], /) -> NDArray[np.bool_]:
    """Return whether cells (m, 2) lie ahead of the viewer along the axis that their strips are stacked on, (m,)."""
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
    fade: bool,
) -> NDArray[np.void]:
    """Return a `PLACEMENT` for each patch shown, ring after ring, shape (m,).

    `receivers` gives, by ring, the number of its first receiver and the number of receivers on a patch; patches follow
    one another. With `fade`, a strip appears gradually while blades are handed over to it.
    """
    rows, along, cover, least, most = (
        np.concatenate([getattr(ring, name) for ring in rings]) for name in ("rows", "along", "cover", "least", "most")
    )
    counts = [len(ring.rows) for ring in rings]
    cell = patches.cell.take(rows, axis=0)
    placements = np.zeros(len(rows), PLACEMENT)
    placements["cell"], placements["model"] = cell, patches.model.take(rows)
    code = np.repeat(OF_RING * np.arange(len(rings), dtype=np.int32), counts)
    code += patches.turn.take(rows) + RUNS_ALONG * along + LIES_AHEAD * lies_ahead(cell, centre, along)
    placements["code"] = code
    placements["cover"] = cover * handed_over(appears.handed.take(rows), fade=fade)[1]
    placements["growth"] = appears.growth.take(rows)
    placements["rank_limit"] = np.where(least > 0.0, -least, most)
    placements["receiver"] = np.concatenate([
        first + each * np.arange(count) for (first, each), count in zip(receivers, counts, strict=True)
    ])  # fmt: skip
    return placements


def polygon_strips(
    placements: NDArray[np.void],
    patch: NDArray[np.int64],
    present: NDArray[np.bool_],
    fineness: list[tuple[int, int]],
    /,
    *,
    stride: int,
) -> tuple[NDArray[np.uint32], NDArray[np.int64]]:
    """Return the polygon strips (n,) in the order of drawing, and the number of them on each drawn patch, shape (m,).

    A polygon strip is a column of a strip. `patch` (m,) gives the drawn patches from far to near, as indices into
    `placements`; `present` (m, kinds) says which kinds grow on them; `fineness` gives strips and columns by ring. The
    number of a polygon strip is patch * `stride` + (place * kinds + turn) * columns + column, where `place` counts the
    patch's strips from far to near, and `turn` is the kind's turn among those that share the place.
    """
    kinds = present.shape[1]
    code = placements["code"][patch].astype(np.int64)
    strips, columns = np.array(fineness, np.int64).take(code // OF_RING, axis=0).T
    count = strips * columns * kinds
    start = np.cumsum(count) - count
    numbers = np.arange(count.sum(), dtype=np.uint32)
    numbers += np.repeat((patch * stride - start).astype(np.uint32), count)
    if present.all():
        return numbers, count
    index = np.repeat(np.arange(len(patch)), count)
    on_patch = numbers - patch[index] * stride
    place, turn = np.divmod(on_patch // columns[index], kinds)
    ahead = code[index] // LIES_AHEAD % 2 == 1
    drawn = present[index, (turn + np.where(ahead, strips[index] - 1 - place, place)) % kinds]
    return numbers[drawn], np.bincount(index[drawn], minlength=len(patch))


def modes_of(rings: Sequence[tuple[StripPool, StripsOfRing]], /, *, changes: bool) -> NDArray[np.int8]:
    """Return the drawing mode of each patch, ring after ring.

    A patch is drawn `BY_RANK` where only some ranks show, where grass is thin anywhere in its ring, and everywhere
    while any kind `changes`.
    """
    modes = []
    for pool, ring in rings:
        is_thin = (pool.least.take(ring.slots) < FULL_DENSITY).any() | (ring.most < 1.0) | (ring.least > 0.0) | changes
        modes.append(np.where(pool.edged.take(ring.slots), EDGED, np.where(is_thin, BY_RANK, ALL_BLADES)))
    return np.concatenate(modes).astype(np.int8)


def batches(modes: NDArray[np.int8], count: NDArray[np.int64], /) -> list[Batch]:
    """Return the batches that draw all polygon strips from far to near, at most `MOST_DRAWS`.

    `modes` (m,) and `count` (m,) are the drawing mode of each patch and the number of its polygon strips, in the order
    of drawing. Neighbours of the same mode are drawn together. Where that makes too many batches, some patches get a
    dearer mode, which shows the same and takes longer for each pixel.
    """
    if not len(modes):
        return []
    first = np.concatenate([[0], np.cumsum(count)])
    starts = _starts(modes)
    if len(starts) > MOST_DRAWS:
        modes = _merged(modes, starts, first)
        starts = _starts(modes)
    ends = [*starts[1:].tolist(), len(modes)]
    return [
        Batch(int(first[start]), int(first[end] - first[start]), int(modes[start]))
        for start, end in zip(starts.tolist(), ends, strict=True)
    ]


def _starts(modes: NDArray[np.int8]) -> NDArray[np.intp]:
    """Return the indices of the patches (m,) whose mode differs from the one before, shape (n,)."""
    return np.flatnonzero(np.diff(modes, prepend=np.int8(-1)))


def _merged(modes: NDArray[np.int8], starts: NDArray[np.intp], first: NDArray[np.int64]) -> NDArray[np.int8]:
    """Return modes (m,) that make at most `MOST_DRAWS` batches: the dearest, except on the longest cheaper stretches.

    `starts` are the patches where the mode changes; `first` (m + 1,) is the first polygon strip of each patch, and the
    number of all.
    """
    dearest = modes.max()
    is_cheaper = np.maximum.reduceat(modes, starts) < dearest
    stretch = np.cumsum(np.diff(is_cheaper, prepend=~is_cheaper[:1]))
    index = np.repeat(stretch - 1, np.diff(starts, append=len(modes)))
    length = np.bincount(index, np.diff(first)) * (np.bincount(index, modes == dearest) == 0.0)
    kept = np.argsort(length)[-(MOST_DRAWS // 2 - 1) :]
    merged = np.where(np.isin(index, kept) & (modes < dearest), modes, dearest)
    if len(_starts(merged)) > MOST_DRAWS:
        merged[merged < dearest] = merged[merged < dearest].max()
    return merged
