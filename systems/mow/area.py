"""Areas of the ground: distances of places from a footprint or a road, and strokes that change cells within it."""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from itertools import pairwise
from reprlib import repr as shortened

import numpy as np

from ...components.arrays import Floats
from ...components.footprint import Footprint, Road
from ...components.pose import Pose
from ...engine.handed import SOMEWHERE, is_somewhere
from ...engine.terrain.plots import CELL, CELLS, SIDE, Plots, Untouched, Values, ends_of, middles
from ...engine.terrain.rectangle import Rectangle
from ..space import polygon
from ..space.polygon import line_distances

Area = Footprint | Road
"""The area of a stroke."""

LEAST_RADIUS = 0.75
"""Smallest radius of a footprint [cells]: a little more than half the diagonal of a cell."""

ROUNDING = 1e-6
"""Rounding error of corners in float32, relative to the polygon's extent."""

Change = Callable[[Values, Floats], Values]
"""Function from values of cells, (rows, columns, ...), and their signed distances from an area [m], (rows, columns), to
new values."""

Segments = Sequence[int] | None
"""Indices of some segments of a road's line; None for all."""

_FEW_PLOTS = 12
"""Largest number of plots whose cells are changed together."""

_DEEP_WITHIN = -1e9
"""Signed distance for all cells of a plot well within an area [m]."""


def must_be_area(area: object, pose: object, done: str, /) -> None:
    """Raise TypeError for no area or no pose, ValueError for a pose that is not finite; `done` is a participle."""
    if not isinstance(area, Footprint | Road):
        raise TypeError(f"grass is {done} under a Footprint or a Road, not under {shortened(area)}")
    if not isinstance(pose, Pose):
        raise TypeError(f"a footprint lies at a Pose, not at {shortened(pose)}")
    if not is_somewhere(pose):
        raise ValueError(f"a footprint lies where {SOMEWHERE}, not at {shortened(pose)}")


def signed_distances(area: Area, pose: Pose, place: Floats, /, *, least: float = 0.0, near: Segments = None) -> Floats:
    """Return signed distances of ground positions (n, 2) from an area [m], negative within it, shape (n,).

    The radius of a round area and half the width of a road are taken as at least `least` [m]. Only the segments `near`
    of a road are looked at.
    """
    local = pose.inside(place)
    if isinstance(area, Road):
        line = np.array(area.line, np.float32)
        return line_distances(local, line, near=near) - np.float32(max(area.width / 2.0, least))
    if area.corners:
        return polygon.signed_distances(local, np.array(area.corners, np.float32))
    half = np.float32(area.length / 2)
    distance = np.hypot(local[:, 0], local[:, 1] - np.clip(local[:, 1], -half, half))
    return np.asarray(distance - np.float32(max(area.radius, least)), np.float32)


def stroke(
    plots: Plots, area: Area, pose: Pose, change: Change, untouched: Untouched, /, *, beyond: float,
    least: float = 0.0, alike: Values | None = None,
) -> None:  # fmt: skip
    """Change the cells of a map whose middles are within `beyond` [m] of an area.

    `alike` (1, 1, ...) is the value of all cells well within the area, if they get the same one: plots then share a
    page, which is faster.
    """
    parts = _reached_parts(plots, area, pose, max(beyond, least))
    if isinstance(area, Footprint) and 0 < len(parts) <= _FEW_PLOTS:
        _stroke_few_plots(plots, area, pose, change, untouched, [part for part, _ in parts], beyond, least)
        return
    for (part, near), distance in zip(parts, _middle_distances(area, pose, parts, least), strict=True):
        half = np.hypot(part.rows, part.columns) * (CELL / 2.0)
        if distance - half > beyond:
            continue
        if distance + half < -CELL:
            if alike is not None and part.rows == part.columns == CELLS:
                plots.put_alike(part, alike)
                continue
            distances = np.full((part.rows, part.columns), _DEEP_WITHIN, np.float32)
        else:
            place = middles(part).reshape(-1, 2)
            distances = signed_distances(area, pose, place, least=least, near=near).reshape(part.rows, part.columns)
        plots.put(part, partial(_changed, change, distances), untouched)


def _stroke_few_plots(
    plots: Plots, area: Footprint, pose: Pose, change: Change, untouched: Untouched, parts: list[Rectangle],
    beyond: float, least: float,
) -> None:  # fmt: skip
    """Do what `stroke` does on parts of few plots: changing all their cells together is faster."""
    first, last = parts[0], parts[-1]
    rows, columns = last.row + last.rows - first.row, last.column + last.columns - first.column
    whole = Rectangle(first.row, first.column, rows, columns)
    distances = _cell_distances(area, pose, whole, beyond=beyond, least=least)
    inner = [part.moved(-first.row, -first.column).slices for part in parts]
    pairs = zip(parts, inner, strict=True)
    reached = [(part, slices) for part, slices in pairs if distances[slices].min() <= beyond]
    before = np.zeros((whole.rows, whole.columns, *plots.pages.shape[3:]), plots.pages.dtype)
    for part, slices in reached:
        held = plots.held(part)
        before[slices] = untouched(part) if held is None else held
    after = change(before, distances)
    for part, slices in reached:
        plots.put(part, partial(_replaced, after[slices]), untouched)


def _replaced(values: Values, _before: Values) -> Values:
    """Return new values whatever there was before."""
    return values


def _cell_distances(area: Footprint, pose: Pose, part: Rectangle, *, beyond: float, least: float) -> Floats:
    """Return signed distances of a part's cells from a footprint, (rows, columns); lower bounds above `beyond`.

    Inside a convex polygon, the nearest edge is the one with the nearest line.
    """
    convex = _convex_edges(area)
    if convex is None:
        return signed_distances(area, pose, middles(part).reshape(-1, 2), least=least).reshape(part.rows, part.columns)
    corner, outwards = (pose.outside(each) for each in convex)
    x = ((part.column + 0.5 + np.arange(part.columns)) * CELL - pose.x).astype(np.float32)
    z = ((part.row + 0.5 + np.arange(part.rows)) * CELL - pose.z).astype(np.float32)
    across, along = outwards[:, :1] * (x - corner[:, :1]), outwards[:, 1:] * (z - corner[:, 1:])
    distances: Floats = along[0, :, None] + across[0]
    for right, down in zip(across[1:], along[1:], strict=True):
        np.maximum(distances, down[:, None] + right, out=distances)
    # Outside a corner, the lines are nearer than the polygon.
    row, column = np.nonzero((distances > 0.0) & (distances <= beyond))
    outline, outside = np.concatenate([corner, corner[:1]]), np.stack([x[column], z[row]], axis=1)
    distances[row, column] = line_distances(outside, outline)
    return distances


@lru_cache(maxsize=64)
def _convex_edges(area: Footprint) -> tuple[Floats, Floats] | None:
    """Return start and outward normal of each edge of a convex polygon, (n, 2) each; None for any other footprint."""
    if not area.corners:
        return None
    corner = np.array(area.corners, np.float32)
    edge = np.roll(corner, -1, axis=0) - corner
    length = np.hypot(edge[:, 0], edge[:, 1])
    corner, edge = corner[length > 0.0], edge[length > 0.0] / length[length > 0.0, None]
    normal = np.stack([edge[:, 1], -edge[:, 0]], axis=1)
    distance = normal @ corner.T - (normal * corner).sum(axis=1)[:, None]  # of each corner from each edge's line
    sign = np.float32(1.0 if distance.sum() < 0.0 else -1.0)
    if (sign * distance).max() > ROUNDING * np.ptp(corner):
        return None
    return corner, sign * normal


def _middle_distances(area: Area, pose: Pose, reached: list[tuple[Rectangle, Segments]], least: float) -> list[float]:
    """Return signed distances of the middles of parts from an area [m]."""
    middle = np.array([np.add(*ends_of(part)) / 2.0 for part, _ in reached], np.float32).reshape(-1, 2)
    if isinstance(area, Footprint):
        return [float(off) for off in signed_distances(area, pose, middle, least=least)]
    return [
        float(signed_distances(area, pose, here[None], least=least, near=near)[0])
        for here, (_, near) in zip(middle, reached, strict=True)
    ]


def _changed(change: Change, distances: Floats, before: Values) -> Values:
    """Return changed values, with the argument that `Plots.put` supplies last."""
    return change(before, distances)


def _reached_parts(plots: Plots, area: Area, pose: Pose, beyond: float) -> list[tuple[Rectangle, Segments]]:
    """Return the parts of plots that an area may reach, each with the segments of a road that reach it."""
    position = np.array([pose.x, pose.z], np.float32)
    if isinstance(area, Footprint):
        round_one = ((-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0))
        reach = area.radius + area.length / 2.0
        corners = area.corners or tuple((reach * x, reach * z) for x, z in round_one)
        places = pose.outside(np.array(corners, np.float32)) + position
        return [(part, None) for part in plots.parts(places.min(axis=0) - beyond, places.max(axis=0) + beyond)]
    numbers_by_part, reach = dict[Rectangle, set[int]](), area.width / 2.0 + beyond
    places = pose.outside(np.array(area.line, np.float32)) + position
    for number, (first, last) in enumerate(pairwise(places)):
        for part in plots.parts(np.minimum(first, last) - reach, np.maximum(first, last) + reach):
            row, column = part.row // CELLS * CELLS, part.column // CELLS * CELLS
            numbers_by_part.setdefault(Rectangle(row, column, CELLS, CELLS), set()).add(number)
    kept = list[tuple[Rectangle, Segments]]()
    for part, numbers in numbers_by_part.items():
        middle, half = np.add(ends_of(part)[0], SIDE / 2.0)[None], SIDE / np.sqrt(2.0)
        near = [n for n in sorted(numbers) if line_distances(middle, places[n : n + 2])[0] <= reach + half]
        if near:
            kept.append((part, near))
    return kept
