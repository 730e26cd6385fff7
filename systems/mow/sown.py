"""Sowing and clearing: densities of kinds that a game changes."""

from collections.abc import Callable, Sequence
from functools import partial
from reprlib import repr as shortened

import numpy as np

from ...components.arrays import Bytes, Floats, Ints, Mask
from ...components.pose import Pose
from ...engine.handed import NUMBER_TYPES
from ...engine.terrain.plots import CELL, CELLS, Values, middles
from ...engine.terrain.record import Density
from ...engine.terrain.rectangle import Rectangle
from ...engine.terrain.sample import painted_at
from .area import Area, must_be_area, stroke

SOFTEST = 1000.0
"""Largest width of the verge over which a stroke fades out [m]."""


def sow(
    density: Density, kind: int, among: Sequence[bool], area: Area, dense: float, pose: Pose, /, *, soft: float
) -> None:
    """Set a kind's density to `dense` in an area, fading out over a verge of `soft` [m]; `kind` is its number.

    Other kinds shrink where the sum would exceed 1. Kinds that stand `among` others neither shrink nor displace others.
    Raise TypeError or ValueError for an invalid area, density, pose or verge.
    """
    must_be_area(area, pose, "sown")
    _must_be_number(dense, "grass is sown with a density", 1.0)
    _must_be_number(soft, "a verge is", SOFTEST, " m wide")
    displaced = ~np.array(among, np.bool_)
    alike = np.where(np.arange(len(displaced)) == kind, 255, 0).astype(np.uint8)[None, None]
    is_alone = dense == 1.0 and bool(displaced.all())
    change = partial(_with_sown, kind=kind, dense=float(dense), displaced=displaced)
    _stroke(density, area, pose, change, soft, alike if is_alone else None)


def clear(density: Density, area: Area, pose: Pose, /, *, soft: float) -> None:
    """Set all densities to 0 in an area, fading out over a verge of `soft` [m]; raise the errors of `sow`."""
    must_be_area(area, pose, "cleared")
    _must_be_number(soft, "a verge is", SOFTEST, " m wide")
    _stroke(density, area, pose, np.zeros_like, soft, np.zeros((1, 1, len(density.maps)), np.uint8))


def carry_over(before: Density, after: Density, old_kinds: Sequence[int | None], /) -> None:
    """Carry over what was sown and cleared to other painted densities, kinds or terrain.

    `old_kinds` has each kind's number before, None for a new kind.
    """
    where, pages = before.sown.saved()
    if len(where):
        after.sown.resume(*carried(where, pages, before, after, old_kinds))


def carried(
    where: Ints, pages: Bytes, before: Density, after: Density, old_kinds: Sequence[int | None], /
) -> tuple[Ints, Bytes]:
    """Convert plots (n, 3) and pages, as `Plots.saved` returns them, from the kinds of `before` to those of `after`.

    Cells that equal their painted densities get the new painted ones. All others keep their densities, without new
    kinds, whose entry in `old_kinds` is None. Pages may have more kinds than `before`, after its own, whose painted
    densities nobody knows: then cells where one of these grows get the new painted densities, and bare ones stay bare.
    """
    where, new_pages, page_numbers = where.copy(), list[Bytes](), dict[bytes, int]()
    known = [number for number, old in enumerate(old_kinds) if old is not None]
    olds = [old for old in old_kinds if old is not None]
    count = len(before.maps)
    for number, (row, column, page) in enumerate(where.tolist()):
        plot, cells = Rectangle(row * CELLS, column * CELLS, CELLS, CELLS), pages[page]
        as_painted = (cells[..., :count] == painted_densities(before, plot)).all(axis=2, keepdims=True)
        if count < cells.shape[2]:
            as_painted |= cells[..., count:].any(axis=2, keepdims=True)
            as_painted &= cells.any(axis=2, keepdims=True)
        values = np.where(as_painted, painted_densities(after, plot), np.uint8(0))
        values[..., known] = np.where(as_painted, values[..., known], cells[..., olds])
        where[number, 2] = page_numbers.setdefault(values.tobytes(), len(new_pages))
        if where[number, 2] == len(new_pages):
            new_pages.append(values)
    return where, np.stack(new_pages)


def painted_densities(density: Density, part: Rectangle, /) -> Values:
    """Return the painted densities of some cells as bytes, shape (rows, columns, kinds)."""
    painted = painted_at(density, middles(part).reshape(-1, 2)).T
    return np.asarray(np.rint(painted * 255.0), np.uint8).reshape(part.rows, part.columns, -1)


def _stroke(
    density: Density, area: Area, pose: Pose, change: Callable[[Floats], Floats], soft: float, alike: Values | None
) -> None:
    """Blend changed densities into the map of a stroke, across a verge of `soft` [m], at least a cell wide."""
    verge = max(soft, CELL)

    def blended(before: Values, distances: Floats) -> Values:
        weight = np.float32(0.5 + 0.5 * soft / verge) - distances * np.float32(1.0 / verge)
        np.clip(weight, np.float32(0.0), np.float32(1.0), out=weight)
        densities = np.moveaxis(before, -1, 0).astype(np.float32, order="C")
        target = change(densities)
        target -= densities
        target *= weight
        target += densities
        return np.moveaxis(np.rint(target, out=target).astype(np.uint8), 0, -1)

    untouched = partial(painted_densities, density)
    stroke(density.sown, area, pose, blended, untouched, beyond=0.5 * (soft + verge), alike=alike)


def _with_sown(before: Floats, *, kind: int, dense: float, displaced: Mask) -> Floats:
    """Return densities (kinds, ...) [1/255] with one kind sown."""
    densities = before.copy()
    others = [number for number in np.flatnonzero(displaced).tolist() if number != kind] if displaced[kind] else []
    if others:
        room = np.float32(255.0 * (1.0 - dense))
        densities[others] *= np.minimum(room / np.maximum(before[others].sum(axis=0), np.float32(1e-6)), 1.0)
    densities[kind] = 255.0 * dense
    return densities


def _must_be_number(thing: object, rule: str, highest: float, unit: str = "") -> None:
    """Raise TypeError or ValueError unless a value is a number from 0 to `highest`; `rule` begins the message."""
    if isinstance(thing, bool) or not isinstance(thing, NUMBER_TYPES):
        raise TypeError(f"{rule} from 0 to {highest:g}{unit}, not {shortened(thing)}")
    if not 0.0 <= thing <= highest:
        raise ValueError(f"{rule} from 0 to {highest:g}{unit}, not {thing}")
