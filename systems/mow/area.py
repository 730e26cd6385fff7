"""Areas of the ground: how far places are from a footprint or a road, and how much of a cell lies under it."""

from collections.abc import Callable, Sequence
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np

from ...components.arrays import Floats
from ...components.footprint import Footprint, Road
from ...components.pose import Pose
from ...engine.handed import SOMEWHERE, is_somewhere
from ...engine.terrain.part import Part
from ...engine.terrain.plots import CELL, CELLS, SIDE, Plots, Untouched, Values, ends_of, middles
from ..space.polygon import in_polygon

Area = Footprint | Road
"""What a stroke goes over."""

LEAST = 0.75
"""A footprint counts as at least so wide, in cells: half the diagonal of one, and a little."""

ROUNDED = 1e-6
"""What float32 rounds corners by, of the polygon's extent."""

Change = Callable[[Values, Floats], Values]
"""Gives what some cells have, (rows, columns, ...), that lie so far outside of an area [m], (rows, columns)."""

Stretches = Sequence[int] | None
"""The numbers of some stretches of a road, from one place of its line to the next; None are all."""

_FEW = 12
"""Plots whose cells are asked for at once."""

_WITHIN = -1e9
"""How far outside cells count that lie well within an area [m]."""


def must_be_area(area: object, pose: object, done: str, /) -> None:
    """Raise TypeError for what is no area or no pose, ValueError for a pose that is nowhere; `done` is what is."""
    if not isinstance(area, Footprint | Road):
        raise TypeError(f"grass is {done} under a Footprint or a Road, not under {area!r}")
    if not isinstance(pose, Pose):
        raise TypeError(f"a footprint lies at a Pose, not at {pose!r}")
    if not is_somewhere(pose):
        raise ValueError(f"a footprint lies where {SOMEWHERE}, not at {pose!r}")


def beside(area: Area, pose: Pose, place: Floats, /, *, least: float = 0.0, near: Stretches = None) -> Floats:
    """Return how far ground positions (n, 2) lie outside of an area [m], below 0 within it, shape (n,).

    A round one, and a road, count as at least `least` [m] to either side of their middle. Of a road, only some
    stretches may be `near`.
    """
    own = pose.inside(place)
    if isinstance(area, Road):
        return _from_line(np.array(area.line, np.float32), own, near) - np.float32(max(area.width / 2.0, least))
    if area.corners:
        corners = np.array(area.corners, np.float32)
        edge = _from_line(np.concatenate([corners, corners[:1]]), own)
        return np.asarray(np.where(in_polygon(own, corners), -edge, edge), np.float32)
    half = np.float32(area.length / 2)
    off = np.hypot(own[:, 0], own[:, 1] - np.clip(own[:, 1], -half, half))
    return np.asarray(off - np.float32(max(area.radius, least)), np.float32)


def stroke(
    plots: Plots, area: Area, pose: Pose, change: Change, untouched: Untouched, /, *, beyond: float,
    least: float = 0.0, alike: Values | None = None,
) -> None:  # fmt: skip
    """Change what a map has in cells whose middles are no farther than `beyond` [m] outside of an area.

    Where all well within it become `alike` whatever they were, (1, 1, ...), it is faster to be told.
    """
    reached = _reached(plots, area, pose, max(beyond, least))
    if isinstance(area, Footprint) and 1 < len(reached) <= _FEW:
        _few(plots, area, pose, change, untouched, [part for part, _ in reached], beyond, least)
        return
    for (part, near), off in zip(reached, _off(area, pose, reached, least), strict=True):
        half = np.hypot(part.rows, part.columns) * (CELL / 2.0)
        if off - half > beyond:
            continue
        if off + half < -CELL:
            if alike is not None and part.rows == part.columns == CELLS:
                plots.put_alike(part, alike)
                continue
            away = np.full((part.rows, part.columns), _WITHIN, np.float32)
        else:
            place = middles(part).reshape(-1, 2)
            away = beside(area, pose, place, least=least, near=near).reshape(part.rows, part.columns)
        plots.put(part, partial(_changed, change, away), untouched)


def _few(
    plots: Plots, area: Footprint, pose: Pose, change: Change, untouched: Untouched, parts: list[Part],
    beyond: float, least: float,
) -> None:  # fmt: skip
    """Do what `stroke` does on parts of few plots: to change all of their cells at once is faster."""
    first, last = parts[0], parts[-1]
    whole = Part(first.row, first.column, last.row + last.rows - first.row, last.column + last.columns - first.column)
    away = _beside_cells(area, pose, whole, beyond=beyond, least=least)
    inner = [Part(part.row - first.row, part.column - first.column, part.rows, part.columns).slices for part in parts]
    reached = [(part, own) for part, own in zip(parts, inner, strict=True) if away[own].min() <= beyond]
    before = np.zeros((whole.rows, whole.columns, *plots.pages.shape[3:]), plots.pages.dtype)
    for part, own in reached:
        held = plots.held(part)
        before[own] = untouched(part) if held is None else held
    after = change(before, away)
    for part, own in reached:
        plots.put(part, partial(_given, after[own]), untouched)


def _given(values: Values, before: Values) -> Values:
    del before
    return values


def _beside_cells(area: Footprint, pose: Pose, part: Part, *, beyond: float, least: float) -> Floats:
    """Return what `beside` says of the middles of a part's cells, (rows, columns); of those `beyond` it, that they are.

    Within a polygon without hollows, the nearest edge is that whose line is nearest.
    """
    edges = _around(area)
    if edges is None:
        return beside(area, pose, middles(part).reshape(-1, 2), least=least).reshape(part.rows, part.columns)
    corner, outwards = (pose.outside(each) for each in edges)
    x = ((part.column + 0.5 + np.arange(part.columns)) * CELL - pose.x).astype(np.float32)
    z = ((part.row + 0.5 + np.arange(part.rows)) * CELL - pose.z).astype(np.float32)
    across, along = outwards[:, :1] * (x - corner[:, :1]), outwards[:, 1:] * (z - corner[:, 1:])
    away: Floats = along[0, :, None] + across[0]
    for right, down in zip(across[1:], along[1:], strict=True):
        np.maximum(away, down[:, None] + right, out=away)
    row, column = np.nonzero((away > 0.0) & (away <= beyond))  # at a corner it is farther than its lines
    away[row, column] = _from_line(np.concatenate([corner, corner[:1]]), np.stack([x[column], z[row]], axis=1))
    return away


@lru_cache(maxsize=64)
def _around(area: Footprint) -> tuple[Floats, Floats] | None:
    """Return where each edge of a convex polygon begins, and which way is out of it, (n, 2) each; None of any other."""
    if not area.corners:
        return None
    corner = np.array(area.corners, np.float32)
    edge = np.roll(corner, -1, axis=0) - corner
    length = np.hypot(edge[:, 0], edge[:, 1])
    corner, edge = corner[length > 0.0], edge[length > 0.0] / length[length > 0.0, None]
    left = np.stack([edge[:, 1], -edge[:, 0]], axis=1)
    beyond = left @ corner.T - (left * corner).sum(axis=1)[:, None]  # each edge's line, of each corner
    side = np.float32(1.0 if beyond.sum() < 0.0 else -1.0)
    if (side * beyond).max() > ROUNDED * np.ptp(corner):
        return None
    return corner, side * left


def _off(area: Area, pose: Pose, reached: list[tuple[Part, Stretches]], least: float) -> list[float]:
    """Return how far the middles of parts lie outside of an area [m]."""
    middle = np.array([np.add(*ends_of(part)) / 2.0 for part, _ in reached], np.float32).reshape(-1, 2)
    if isinstance(area, Footprint):
        return [float(off) for off in beside(area, pose, middle, least=least)]
    return [
        float(beside(area, pose, here[None], least=least, near=near)[0])
        for here, (_, near) in zip(middle, reached, strict=True)
    ]


def _changed(change: Change, away: Floats, before: Values) -> Values:
    return change(before, away)


def _reached(plots: Plots, area: Area, pose: Pose, beyond: float) -> list[tuple[Part, Stretches]]:
    """Return the cells that an area may reach, plot by plot, and which stretches of a road reach them."""
    here = np.array([pose.x, pose.z], np.float32)
    if isinstance(area, Footprint):
        round_one = ((-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0))
        reach = area.radius + area.length / 2.0
        corners = area.corners or tuple((reach * x, reach * z) for x, z in round_one)
        places = pose.outside(np.array(corners, np.float32)) + here
        return [(part, None) for part in plots.parts(places.min(axis=0) - beyond, places.max(axis=0) + beyond)]
    found, reach = dict[Part, set[int]](), area.width / 2.0 + beyond
    places = pose.outside(np.array(area.line, np.float32)) + here
    for number, (first, last) in enumerate(pairwise(places)):
        for part in plots.parts(np.minimum(first, last) - reach, np.maximum(first, last) + reach):
            row, column = part.row // CELLS * CELLS, part.column // CELLS * CELLS
            found.setdefault(Part(row, column, CELLS, CELLS), set()).add(number)
    kept = list[tuple[Part, Stretches]]()
    for part, numbers in found.items():
        middle, half = np.add(ends_of(part)[0], SIDE / 2.0)[None], SIDE / np.sqrt(2.0)
        near = [n for n in sorted(numbers) if _from_line(places[n : n + 2], middle)[0] <= reach + half]
        if near:
            kept.append((part, near))
    return kept


def _from_line(line: Floats, place: Floats, near: Stretches = None) -> Floats:
    """Return how far places (n, 2) are from the nearest of some stretches between places (m, 2) of a line, (n,)."""
    least = np.full(len(place), np.inf, np.float32)
    right, ahead = np.ascontiguousarray(place.T)
    for number in range(len(line) - 1) if near is None else near:
        x, z, (dx, dz) = right - line[number, 0], ahead - line[number, 1], line[number + 1] - line[number]
        along = (x * dx + z * dz) / np.float32(max(float(dx * dx + dz * dz), 1e-12))
        np.clip(along, 0.0, 1.0, out=along)
        x -= along * dx
        z -= along * dz
        np.minimum(least, x * x + z * z, out=least)
    return np.asarray(np.sqrt(least), np.float32)
