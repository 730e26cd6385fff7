"""Drift and ghosting: what a patch's slow change of representation does that no two frames in succession show.

Some instants of each leg are held against the reference, from before its patches change until they have changed. At
each, a tile around the middle of every patch that changes tells how bright it is, relative to the reference's own, and
whether it shows two representations laid over one another.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Levels, Mask
from ...engine.camera import Camera, projection_matrix, view_matrix
from ...systems.prairie import Prairie
from ..studio.encode import Picture
from ..studio.studio import Studio
from . import stroll
from .contrast import luma, tile_side
from .stroll import Moment
from .verdict import Step

INSTANTS = 5
"""Instants of a leg that are held against the reference."""

ASIDE = 0.05
"""How long before the leg's border the first of them is, and how long before its end the last [s]."""

TOP = 0.75
"""Height over a patch's middle that the middle of its tile shows, as a part of its tallest grass's."""

WINDOW = 1.5
"""Time in which a change of brightness counts as drift [s]."""


ENOUGH = 8
"""Patches whose mean tells of a change: of one or two, the few blades in their tiles tell more."""

FAINT = 1.0
"""Difference between the two pictures that nobody sees, as a root of the mean square [steps of 255]."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """One instant of a leg: its picture, the reference's, and the patches."""

    moment: Moment
    seen: Doubles
    """Luma of the picture, shape (height, width)."""

    true: Doubles
    """Luma of the reference, shape (height, width)."""

    before: Doubles
    """Luma of the picture as if no change had begun yet, shape (height, width)."""

    after: Doubles
    """Luma of the picture as if all changes were over, shape (height, width)."""

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

    ghosted: Doubles
    """How much all of them together are two pictures laid over one another, 0 to 1, shape (instants,)."""

    distance: NDArray[np.int32]
    """Discrete distance at first, shape (patches,)."""

    corner: NDArray[np.int64]
    """Column and row of the tile's first pixel at last, shape (patches, 2)."""

    @property
    def drift(self) -> Doubles:
        """The largest change of brightness of each patch, relative to the reference's, shape (patches,)."""
        return _largest_change(self.bright, self.time)

    @property
    def ghosting(self) -> float:
        """How much the patches are two pictures laid over one another, 0 to 1, in the mean over their way."""
        return float(self.ghosted[1:-1].mean())


def taken_together(changes: Sequence[Change], /) -> list[list[Change]]:
    """Return changes that are one and the same, each on another leg, in groups of at least `ENOUGH` patches.

    Legs on which fewer make it are one group, however many those are.
    """
    few = [each for each in changes if len(each.distance) < ENOUGH]
    groups = [[each] for each in changes if len(each.distance) >= ENOUGH]
    return groups + ([few] if few else [])


def mean_drift(group: Sequence[Change], /) -> float:
    """Return the drift of the mean over all patches of changes, where the grain of single tiles cancels out."""
    bright = np.concatenate([each.bright for each in group], axis=1)
    return float(_largest_change(bright.mean(axis=1), group[0].time))


def mean_ghosting(group: Sequence[Change], /) -> float:
    """Return the ghosting of changes, 0 to 1, in the mean over their patches."""
    return float(np.average([each.ghosting for each in group], weights=[len(each.distance) for each in group]))


def _largest_change(values: Doubles, time: Doubles) -> Doubles:
    """Return the largest relative change within `WINDOW` of values (instants, ...) at times (instants,), (...)."""
    pairs = [(a, b) for a, b in combinations(range(len(time)), 2) if time[b] - time[a] <= WINDOW + 1e-6]
    return np.asarray(np.max([np.abs(values[b] / values[a] - 1.0) for a, b in pairs], axis=0))


def sampled_frames() -> list[int]:
    """Return the numbers of a leg's frames that are held against the reference, from before its border to its end."""
    times = np.linspace(stroll.LEAD - ASIDE, stroll.SECONDS - ASIDE, INSTANTS)
    return [max(1, round(float(time) * stroll.RATE)) for time in times]


def sample(prairie: Prairie, step: Step, reference: Picture, ends: tuple[Doubles, Doubles], /) -> Sample:
    """Return the sample of a frame that has just been drawn; `ends` are those of its changes."""
    patches = prairie.viewers["main"].patches
    tallest = max(kind.height[1] for kind in prairie.scene.grass.values())
    shown_at = patches.height.astype(np.float64) + TOP * tallest
    corner, inside = _tiles(patches.middle, shown_at, step.moment, step.now.shape[:2])
    level = np.where(patches.shown, patches.representation, np.int8(-1))
    return Sample(
        step.moment, luma(step.now), luma(reference), *ends, patches.cell.copy(), level,
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
    inside = ((corner >= 0) & (corner + side <= [width, height])).all(axis=1)
    return corner, np.asarray(inside)


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
    bright, ghosts = np.empty((len(samples), len(rows))), np.empty(len(samples))
    for number, each in enumerate(samples):
        pictures = (each.seen, each.true, each.before, each.after)
        seen, true, before, after = (_cut(picture, each.corner[rows]) for picture in pictures)
        bright[number] = seen.mean(axis=1) / np.maximum(true.mean(axis=1), 1.0)
        ghosts[number] = ghosted(seen, before, after)
    time = np.array([each.moment.time - each.moment.leg.start for each in samples])
    first, last = samples[0], samples[-1]
    return Change(first.moment.leg.name, name, time, bright, ghosts, first.distance[rows], last.corner[rows])


def _cut(picture: Doubles, corner: NDArray[np.int64]) -> Doubles:
    """Return the pixels of tiles, shape (tiles, pixels)."""
    side = tile_side(len(picture))
    return np.stack([picture[top : top + side, left : left + side].reshape(-1) for left, top in corner.tolist()])


def ends_of_change(studio: Studio, prairie: Prairie, camera: Camera, /) -> tuple[Doubles, Doubles]:
    """Return the luma of this instant as if no change had begun yet, and as if all were over, both (height, width).

    The prairie must have been drawn at this instant from there, and be held as to how far its changes are. Nothing that
    it keeps is changed.
    """
    patches, matrices = prairie.viewers["main"].patches, studio.matrices(camera)
    columns = (patches.progress, patches.sublevel_progress)
    kept, pictures = [column.copy() for column in columns], []
    for end in (0.0, 1.0):
        for column, before in zip(columns, kept, strict=True):
            column[:] = np.where(before < 1.0, np.float32(end), before)
        studio.begin()
        prairie.draw(*matrices)
        pictures.append(luma(studio.read()))
    for column, before in zip(columns, kept, strict=True):
        column[:] = before
    prairie.follow(*matrices)  # what the next frame goes on from is this one as it was
    return pictures[0], pictures[1]


def ghosted(seen: Doubles, before: Doubles, after: Doubles, /) -> float:
    """Return how much a picture is two others laid over one another, 0 to 1, all of one shape.

    It is 1 where it is the mean of both in every pixel, and 0 where it is one of them, or neither: where what it shows
    is in between, as blades are that move from one place to another.
    """
    apart, way = before - after, seen - after
    whole = float((apart * apart).sum())
    if whole <= FAINT * FAINT * apart.size:
        return 0.0
    share = min(max(float((way * apart).sum()) / whole, 0.0), 1.0)
    rest = float(((way - share * apart) ** 2).sum())
    return max(0.0, 4.0 * (share * (1.0 - share) - rest / whole))
