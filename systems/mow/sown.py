"""Sowing and clearing: how densely kinds grow where a game says so."""

from collections.abc import Callable, Sequence
from functools import partial
from math import isfinite

import numpy as np

from ...components.arrays import Bytes, Floats, Ints, Mask
from ...components.pose import Pose
from ...engine.handed import NUMBERS
from ...engine.terrain.part import Part
from ...engine.terrain.plots import CELL, CELLS, Values, middles
from ...engine.terrain.record import Density
from ...engine.terrain.sample import painted_at
from .area import Area, must_be_area, stroke

SOFTEST = 1000.0
"""Widest verge over which a stroke may end [m]."""


def sow(
    density: Density, kind: int, among: Sequence[bool], area: Area, dense: float, pose: Pose, /, *, soft: float
) -> None:
    """Let a kind, by its number, grow under an area with a density of `dense`, and over `soft` [m] beside it ever less.

    Other kinds give way as far as all would come to more than 1 together, but those that stand `among` others. Raises
    TypeError and ValueError for what is no area, density, pose or verge.
    """
    must_be_area(area, pose, "sown")
    _must_be_number(dense, "grass is sown with a density", 1.0)
    _must_be_number(soft, "a verge is", SOFTEST, " m wide")
    apart = ~np.array(among, np.bool_)
    alike = np.where(np.arange(len(apart)) == kind, 255, 0).astype(np.uint8)[None, None]
    only = dense == 1.0 and bool(apart.all())
    change = partial(_sown, kind=kind, dense=float(dense), apart=apart)
    _stroke(density, area, pose, change, soft, alike if only else None)


def clear(density: Density, area: Area, pose: Pose, /, *, soft: float) -> None:
    """Let nothing grow under an area, and over `soft` [m] beside it ever more of what does; raises what `sow` does."""
    must_be_area(area, pose, "cleared")
    _must_be_number(soft, "a verge is", SOFTEST, " m wide")
    _stroke(density, area, pose, np.zeros_like, soft, np.zeros((1, 1, len(density.maps)), np.uint8))


def wear(density: Density, area: Area, pose: Pose, part: float, /) -> None:
    """Let a part of what grows under an area be gone, of each kind at least a 255th."""
    _stroke(density, area, pose, partial(_worn, part=np.float32(part)), 0.0, None)


def carry_over(before: Density, after: Density, was: Sequence[int | None], /) -> None:
    """Let what was sown and cleared be so where kinds are painted in another way, or on another terrain.

    `was` says which of the kinds of before each one is; None of one that is new.
    """
    where, pages = before.sown.saved()
    if len(where):
        after.sown.resume(*carried(where, pages, before, after, was))


def carried(
    where: Ints, pages: Bytes, before: Density, after: Density, was: Sequence[int | None], /
) -> tuple[Ints, Bytes]:
    """Return plots (n, 3) and pages, as `Plots.saved` does, that say of `after` what these say of `before`.

    Cells that are as they were painted come to be painted as now. In all others what grows stays, and none of the kinds
    that are new, of which `was` is None.
    """
    where, made, numbers = where.copy(), list[Bytes](), dict[bytes, int]()
    known = [number for number, old in enumerate(was) if old is not None]
    olds = [old for old in was if old is not None]
    for number, (row, column, page) in enumerate(where.tolist()):
        plot = Part(row * CELLS, column * CELLS, CELLS, CELLS)
        as_painted = (pages[page] == _painted(before, plot)).all(axis=2, keepdims=True)
        values = np.where(as_painted, _painted(after, plot), np.uint8(0))
        values[..., known] = np.where(as_painted, values[..., known], pages[page][..., olds])
        where[number, 2] = numbers.setdefault(values.tobytes(), len(made))
        if where[number, 2] == len(made):
            made.append(values)
    return where, np.stack(made)


def _stroke(
    density: Density, area: Area, pose: Pose, change: Callable[[Floats], Floats], soft: float, alike: Values | None
) -> None:
    verge = max(soft, CELL)

    def covered(before: Values, away: Floats) -> Values:
        part = np.float32(0.5 + 0.5 * soft / verge) - away * np.float32(1.0 / verge)
        np.clip(part, np.float32(0.0), np.float32(1.0), out=part)
        now = np.moveaxis(before, -1, 0).astype(np.float32, order="C")
        due = change(now)
        due -= now
        due *= part
        due += now
        return np.moveaxis(np.rint(due, out=due).astype(np.uint8), 0, -1)

    untouched = partial(_painted, density)
    stroke(density.sown, area, pose, covered, untouched, beyond=0.5 * (soft + verge), alike=alike)


def _sown(before: Floats, *, kind: int, dense: float, apart: Mask) -> Floats:
    due = before.copy()
    others = [number for number in np.flatnonzero(apart).tolist() if number != kind] if apart[kind] else []
    if others:
        left = np.float32(255.0 * (1.0 - dense))
        due[others] *= np.minimum(left / np.maximum(before[others].sum(axis=0), np.float32(1e-6)), 1.0)
    due[kind] = 255.0 * dense
    return due


def _worn(before: Floats, *, part: np.float32) -> Floats:
    return np.asarray(np.maximum(np.minimum(before - before * part, before - 1.0), 0.0), np.float32)


def _painted(density: Density, part: Part) -> Values:
    """Return what is painted in some cells, as bytes, shape (rows, columns, kinds)."""
    painted = painted_at(density, middles(part).reshape(-1, 2)).T
    return np.asarray(np.rint(painted * 255.0), np.uint8).reshape(part.rows, part.columns, -1)


def _must_be_number(thing: object, due: str, most: float, unit: str = "") -> None:
    if isinstance(thing, bool) or not isinstance(thing, NUMBERS):
        raise TypeError(f"{due} from 0 to {most:g}{unit}, not {thing!r}")
    if not isfinite(thing) or not 0.0 <= thing <= most:
        raise ValueError(f"{due} from 0 to {most:g}{unit}, not {thing}")
