"""Drift and ghosting: what a patch's slow change of representation does that no two frames in succession show.

Some instants of each leg are held against the reference, from before its patches change until they have changed. At
each, a tile around the middle of every patch that changes tells how bright it is and how much contrast it has, both
relative to the reference's own.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...engine.camera import projection_matrix, view_matrix
from ...systems.prairie import Prairie
from ..studio.encode import Picture
from . import stroll
from .contrast import LEAST, luma, tile_side
from .stroll import Moment
from .verdict import Step

Doubles = NDArray[np.float64]
Levels = NDArray[np.int8]
Mask = NDArray[np.bool_]

INSTANTS = 5
"""Instants of a leg that are held against the reference."""

ASIDE = 0.05
"""How long before the leg's border the first of them is, and how long before its end the last [s]."""

WINDOW = 1.5
"""Time in which a change of brightness counts as drift [s]."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """One instant of a leg: its picture, the reference's, and the patches."""

    moment: Moment
    seen: Doubles
    """Luma of the picture, shape (height, width)."""

    true: Doubles
    """Luma of the reference, shape (height, width)."""

    cell: NDArray[np.int32]
    """Cells of the patches, shape (rows, 2)."""

    level: Levels
    """The representation of each that is in view, or that it comes to, by number; of others -1, shape (rows,)."""

    sublevel: Levels
    """How fine that is, or comes to be, shape (rows,)."""

    distance: NDArray[np.int32]
    """Discrete distance, shape (rows,)."""

    corner: NDArray[np.int64]
    """Column and row of the first pixel of each patch's tile, shape (rows, 2)."""

    inside: Mask
    """Whether the whole tile is in the picture, shape (rows,)."""

    names: tuple[str, ...]
    """The names of the representations."""


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """The patches that made one and the same change on a leg, as tiles of the picture."""

    leg: str
    name: str
    """What changed, as in `carpet to strips`."""

    time: Doubles
    """The instants [s from the leg's beginning], shape (instants,)."""

    bright: Doubles
    """Mean luma over the reference's, shape (instants, patches)."""

    crisp: Doubles
    """Standard deviation of luma over the reference's, NaN where that is flat, shape (instants, patches)."""

    distance: NDArray[np.int32]
    """Discrete distance at first, shape (patches,)."""

    corner: NDArray[np.int64]
    """Column and row of the tile's first pixel at last, shape (patches, 2)."""

    @property
    def drift(self) -> Doubles:
        """The largest change of brightness within `WINDOW` of each patch, relative to the reference's, (patches,)."""
        pairs = combinations(range(len(self.time)), 2)
        near = [(a, b) for a, b in pairs if self.time[b] - self.time[a] <= WINDOW + 1e-6]
        return np.asarray(np.max([np.abs(self.bright[b] / self.bright[a] - 1.0) for a, b in near], axis=0))

    @property
    def ghosting(self) -> float:
        """The part of their contrast that the patches lose on their way, of what they have before or after, or 0.

        It is the mean over them: grain differs from tile to tile.
        """
        told = self.crisp[:, ~np.isnan(self.crisp).any(axis=0)]
        if not told.size:
            return 0.0
        mean = told.mean(axis=1)
        return max(0.0, 1.0 - float(mean[1:-1].min() / min(mean[0], mean[-1])))


def sampled_frames() -> list[int]:
    """Return the numbers of a leg's frames that are held against the reference, from before its border to its end."""
    times = np.linspace(stroll.LEAD - ASIDE, stroll.SECONDS - ASIDE, INSTANTS)
    return [max(1, round(float(time) * stroll.RATE)) for time in times]


def sample(prairie: Prairie, step: Step, reference: Picture, /) -> Sample:
    """Return the sample of a frame that has just been drawn."""
    patches = prairie.viewers["main"].patches
    tallest = max(kind.height[1] for kind in prairie.scene.grass.values())
    corner, inside = _tiles(patches.middle, patches.height + tallest / 2.0, step.moment, step.now.shape[:2])
    level = np.where(patches.shown, patches.representation, np.int8(-1))
    return Sample(
        step.moment, luma(step.now), luma(reference), patches.cell.copy(), level,
        patches.sublevel[np.maximum(level, 0), np.arange(len(level))], patches.distance.copy(), corner, inside,
        patches.names,
    )  # fmt: skip


def _tiles(middle: Doubles, level: Doubles, moment: Moment, size: tuple[int, ...]) -> tuple[NDArray[np.int64], Mask]:
    """Return the corners (rows, 2) of tiles around places (rows, 2) at these levels (rows,), and which are inside."""
    (height, width), side = size, tile_side(size[0])
    clip = projection_matrix(moment.camera.view, width / height).astype(np.float64) @ view_matrix(moment.camera)
    x, y, _, ahead = clip @ np.stack([middle[:, 0], level, middle[:, 1], np.ones_like(level)])
    before = ahead > 0.1
    across, down = (np.where(before, each / np.where(before, ahead, 1.0), 9.0) for each in (x, -y))
    at = np.stack([(across + 1.0) / 2.0 * width, (down + 1.0) / 2.0 * height], axis=1)
    corner = np.round(np.clip(at, -1e6, 1e6) - side / 2.0).astype(np.int64)
    return corner, ((corner >= 0) & (corner + side <= [width, height])).all(axis=1)


def changes(samples: Sequence[Sample], /) -> Iterator[Change]:
    """Yield each change that patches made between the first and the last of a leg's samples.

    Patches count that were in view, and their tiles inside the picture, at all of them.
    """
    first, last = samples[0], samples[-1]
    there = np.logical_and.reduce([
        (each.cell == first.cell).all(axis=1) & each.inside & (each.level >= 0) for each in samples
    ])  # fmt: skip
    crossed = first.level != last.level
    refined = ~crossed & (first.sublevel != last.sublevel) & (first.sublevel >= 0)
    kinds: dict[str, list[int]] = {}
    for row in (there & (crossed | refined)).nonzero()[0].tolist():
        before, after = (each.names[each.level[row]] for each in (first, last))
        kinds.setdefault(f"{before} to {after}" if crossed[row] else f"{after} in another sub-level", []).append(row)
    for name, rows in sorted(kinds.items()):
        yield _change(samples, name, np.array(rows))


def _change(samples: Sequence[Sample], name: str, rows: NDArray[np.int64]) -> Change:
    bright, crisp = np.empty((2, len(samples), len(rows)))
    for number, each in enumerate(samples):
        seen, true = (_cut(picture, each.corner[rows]) for picture in (each.seen, each.true))
        bright[number] = seen.mean(axis=1) / np.maximum(true.mean(axis=1), 1.0)
        spread = true.std(axis=1)
        crisp[number] = np.where(spread >= LEAST, seen.std(axis=1) / np.maximum(spread, LEAST), np.nan)
    time = np.array([each.moment.time - each.moment.leg.start for each in samples])
    first, last = samples[0], samples[-1]
    return Change(first.moment.leg.name, name, time, bright, crisp, first.distance[rows], last.corner[rows])


def _cut(picture: Doubles, corner: NDArray[np.int64]) -> Doubles:
    """Return the pixels of tiles, shape (tiles, pixels)."""
    side = tile_side(len(picture))
    return np.stack([picture[top : top + side, left : left + side].reshape(-1) for left, top in corner.tolist()])
