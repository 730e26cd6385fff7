"""Drift and ghosting: artefacts of a slow change of representation, which two successive frames do not show.

`INSTANTS` frames of each leg are compared with the reference, from before its patches change until they have changed.
In each, a tile around the middle of every changing patch is measured: its brightness relative to the reference, and
its ghosting, that is whether it shows two representations superimposed.
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
"""Number of frames of a leg that are compared with the reference."""

ASIDE = 0.05
"""Time from the first of these frames to the leg's border, and from the last to the leg's end [s]."""

TOP = 0.75
"""Height above a patch's middle at which its tile is centred, as a fraction of the tallest grass."""

WINDOW = 1.5
"""Longest time in which a change of brightness counts as drift [s]."""

ENOUGH = 8
"""Least number of patches to average: in one or two, single blades outweigh the change."""

FAINT = 1.0
"""Invisible difference between two pictures, as a root mean square [steps of 255]."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """One frame of a leg: its picture, its reference, and the state of the patches."""

    moment: Moment
    seen: Doubles
    """Luma of the picture, shape (height, width)."""

    true: Doubles
    """Luma of the reference, shape (height, width)."""

    before: Doubles
    """Luma of the picture with every running change at its beginning, shape (height, width)."""

    after: Doubles
    """Luma of the picture with every running change at its end, shape (height, width)."""

    cell: NDArray[np.int32]
    """Cells of the patches, shape (rows, 2)."""

    level: Levels
    """Index of each visible patch's representation, the new one during a change; else -1, shape (rows,)."""

    sublevel: Levels
    """Sub-level of that representation, the new one during a change, shape (rows,)."""

    distance: NDArray[np.int32]
    """Discrete distance of the patches, shape (rows,)."""

    corner: NDArray[np.int64]
    """Column and row of the first pixel of each patch's tile, shape (rows, 2)."""

    inside: Mask
    """Whether the whole tile is in the picture, shape (rows,)."""

    names: tuple[str, ...]
    """Names of the representations, by index."""


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """The patches that made the same change on one leg, as tiles of the picture."""

    leg: str
    name: str
    """Name of the change, such as `carpet to strips`."""

    time: Doubles
    """Times since the leg's beginning [s], shape (instants,)."""

    bright: Doubles
    """Mean luma relative to the reference, shape (instants, patches)."""

    ghosted: Doubles
    """Ghosting over all patches together (`ghosted`), 0 to 1, shape (instants,)."""

    distance: NDArray[np.int32]
    """Discrete distance in the first frame, shape (patches,)."""

    corner: NDArray[np.int64]
    """Column and row of the tile's first pixel in the last frame, shape (patches, 2)."""

    @property
    def drift(self) -> Doubles:
        """Largest change of each patch's relative brightness, shape (patches,)."""
        return _largest_change(self.bright, self.time)

    @property
    def ghosting(self) -> float:
        """Mean ghosting over the frames between the first and the last, 0 to 1."""
        return float(self.ghosted[1:-1].mean())


def grouped(changes: Sequence[Change], /) -> list[list[Change]]:
    """Group the same change on several legs: each leg with at least `ENOUGH` patches alone.

    All other legs form one group, however few their patches are.
    """
    few = [each for each in changes if len(each.distance) < ENOUGH]
    groups = [[each] for each in changes if len(each.distance) >= ENOUGH]
    return groups + ([few] if few else [])


def mean_drift(group: Sequence[Change], /) -> float:
    """Return the drift of the patches' mean brightness, in which the grain of single tiles cancels out."""
    bright = np.concatenate([each.bright for each in group], axis=1)
    return float(_largest_change(bright.mean(axis=1), group[0].time))


def mean_ghosting(group: Sequence[Change], /) -> float:
    """Return the mean ghosting of changes, weighted by their numbers of patches, 0 to 1."""
    return float(np.average([each.ghosting for each in group], weights=[len(each.distance) for each in group]))


def _largest_change(values: Doubles, time: Doubles) -> Doubles:
    """Return the largest relative change (...) within `WINDOW` of values (instants, ...) at times (instants,)."""
    pairs = [(a, b) for a, b in combinations(range(len(time)), 2) if time[b] - time[a] <= WINDOW + 1e-6]
    return np.asarray(np.max([np.abs(values[b] / values[a] - 1.0) for a, b in pairs], axis=0))


def sampled_frames() -> list[int]:
    """Return the indices of a leg's frames that are compared with the reference, from before its border to its end."""
    times = np.linspace(stroll.LEAD - ASIDE, stroll.SECONDS - ASIDE, INSTANTS)
    return [max(1, round(float(time) * stroll.RATE)) for time in times]


def sample(prairie: Prairie, step: Step, reference: Picture, ends: tuple[Doubles, Doubles], /) -> Sample:
    """Return the sample of the frame drawn last; `ends` are the pictures from `ends_of_change`."""
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


def _tiles(middle: Doubles, y: Doubles, moment: Moment, size: tuple[int, ...]) -> tuple[NDArray[np.int64], Mask]:
    """Return the corners (rows, 2) of tiles around points with x and z `middle` (rows, 2), and which fit inside."""
    (height, width), side = size, tile_side(size[0])
    clip = projection_matrix(moment.camera.view, width / height).astype(np.float64) @ view_matrix(moment.camera)
    right, up, _, w = clip @ np.stack([middle[:, 0], y, middle[:, 1], np.ones_like(y)])
    in_front = w > 0.1
    across, down = (np.where(in_front, each / np.where(in_front, w, 1.0), 9.0) for each in (right, -up))
    pixel = np.stack([(across + 1.0) / 2.0 * width, (down + 1.0) / 2.0 * height], axis=1)
    corner = np.round(np.clip(pixel, -1e6, 1e6) - side / 2.0).astype(np.int64)
    inside = ((corner >= 0) & (corner + side <= [width, height])).all(axis=1)
    return corner, np.asarray(inside)


def changes(samples: Sequence[Sample], /) -> Iterator[Change]:
    """Yield each change that patches made between the first and the last of a leg's samples.

    Only patches count that are visible, with their whole tiles, in all samples.
    """
    first, last = samples[0], samples[-1]
    in_view = np.logical_and.reduce([
        (each.cell == first.cell).all(axis=1) & each.inside & (each.level >= 0) for each in samples
    ])  # fmt: skip
    crossed = first.level != last.level
    refined = ~crossed & (first.sublevel != last.sublevel) & (first.sublevel >= 0)
    kinds: dict[str, list[int]] = {}
    for row in (in_view & (crossed | refined)).nonzero()[0].tolist():
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
    """Return the luma of this frame with its changes at their beginning, and at their end, both (height, width).

    The prairie must have drawn this instant from this camera, and its systems `DECIDING` must rest. Its state is the
    same afterwards.
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
    prairie.follow(*matrices)  # the next frame must follow this one in its true state
    return pictures[0], pictures[1]


def ghosted(seen: Doubles, before: Doubles, after: Doubles, /) -> float:
    """Return the ghosting of a picture: how far it is a blend of two others, 0 to 1, all of one shape.

    1 is the mean of both in every pixel. 0 is one of the two, or a picture of its own in between, such as of blades
    that move from one place to another.
    """
    difference, offset = before - after, seen - after
    whole = float((difference * difference).sum())
    if whole <= FAINT * FAINT * difference.size:
        return 0.0
    share = min(max(float((offset * difference).sum()) / whole, 0.0), 1.0)
    rest = float(((offset - share * difference) ** 2).sum())
    return max(0.0, 4.0 * (share * (1.0 - share) - rest / whole))
