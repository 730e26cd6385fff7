"""The arrays of a saved state, checked: what is trodden, cut, sown, cleared and dug."""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from ..components.arrays import Bytes, Doubles, Floats, Ints
from ..components.patch import Cell
from ..components.presser import Presser
from ..engine.scene import LoadedScene
from ..engine.terrain.change import Squares, must_be_squares
from ..engine.terrain.density import load_density
from ..engine.terrain.plots import CELLS, Plots
from ..engine.terrain.record import Density, Terrain
from .fitting import kinds_of
from .mow.sown import carried
from .press.footprint import discs_of
from .press.trail import BEGUN, COLUMNS, FIRST, LAST, LEFT, REACH, Stretches
from .press.walk import WalkState
from .pressers import Treading
from .saved import Arrays, Saved, SavedTreading, SavedWalk, component_of, fields_of, from_planes, refuse

WALKS = ("scenes", "games")
"""Prefixes of the arrays of two walks: of the scene's pressers, and of a game's own."""

FARTHEST, WIDEST, LONGEST = 2e6, 31.0, 40.0
"""Largest coordinates, reaches and lengths of stretches [m]."""

LATEST = 1e9
"""Largest absolute times of stretches [s]."""


def _presser(fields: Mapping[str, Any]) -> Presser:
    return cast(Presser, component_of("presser", fields))


def treading_saved(treading: Treading, /) -> tuple[SavedTreading, Arrays]:
    """Return the state of pressers as it is saved: records and arrays."""
    walks, arrays = list[SavedWalk](), {"kept": treading.kept}
    for name, walk in zip(WALKS, treading.walks, strict=True):
        pressers = [(entity, fields_of(presser)) for entity, presser in walk.pressers]
        walks.append(SavedWalk(time=walk.time, begun=walk.begun, who=pressers))
        parts = {"pose": walk.pose, "open": walk.open, "way": walk.way, "closed": walk.closed}
        arrays |= {f"{name}_{part}": array for part, array in parts.items()}
    declared = [None if presser is None else fields_of(presser) for presser in treading.declared]
    worn = [(entity, x, z) for entity, (x, z) in treading.worn.items()]
    saved = SavedTreading(
        walks=walks, since=treading.since, trodden=treading.trodden, anew=treading.anew, declared=declared, worn=worn
    )
    return saved, arrays


def treading_of(saved: SavedTreading, arrays: Arrays, /) -> Treading:
    """Return the state of pressers from what was saved; raises ValueError for what cannot be."""
    walks = []
    for name, walk in zip(WALKS, saved.walks, strict=True):
        pressers = [(entity, _presser(fields)) for entity, fields in walk.who]
        discs = sum(len(discs_of(presser)) for _, presser in pressers)
        opened, way = _stretches(arrays, f"{name}_open", discs), _doubles(arrays, f"{name}_way", (discs,))
        pose, closed = _doubles(arrays, f"{name}_pose", (len(pressers), 3)), _stretches(arrays, f"{name}_closed")
        walks.append(WalkState(pressers, pose, walk.time, opened, way, closed, walk.begun))
    declared = [None if fields is None else _presser(fields) for fields in saved.declared]
    if not all(-len(declared) <= number < 0 for number, _ in walks[0].pressers):
        refuse("it has pressers that its scene does not declare")
    kept = _stretches(arrays, "kept")
    worn = {entity: (x, z) for entity, x, z in saved.worn}
    return Treading((walks[0], walks[1]), kept, saved.since, saved.trodden, saved.anew, declared, worn)


def _doubles(arrays: Arrays, name: str, shape: tuple[int, ...]) -> Doubles:
    """Return the array of a name, if it has this shape, where -1 is any number; raises ValueError otherwise."""
    array = arrays.get(name, np.zeros(()))
    fits = array.ndim == len(shape) and all(due in (-1, n) for due, n in zip(shape, array.shape, strict=True))
    if array.dtype != np.float64 or not fits or not np.isfinite(array).all():
        refuse(f"its array {name} is invalid")
    return array


def _stretches(arrays: Arrays, name: str, count: int = -1) -> Stretches:
    found = _doubles(arrays, name, (count, COLUMNS))
    length = np.hypot(*(found[:, LAST] - found[:, FIRST]).T)
    in_range = (np.abs(found[:, : LAST.stop]) <= FARTHEST).all() and (length <= LONGEST).all()
    in_range = in_range and ((found[:, REACH] > 0.0) & (found[:, REACH] <= WIDEST)).all()
    if not in_range or (np.abs(found[:, BEGUN : LEFT + 1]) > LATEST).any():
        refuse(f"its array {name} is invalid")
    return found


def mown_of(arrays: Arrays, plots: Plots, /) -> tuple[Ints, Floats]:
    """Return the cut plots, (n, 3), and the heights on their pages [m]; raises ValueError for what cannot be."""
    found = arrays.get("mown_heights", np.zeros(0))
    if found.dtype != np.uint8 or found.shape[:-1] != (4,) or found.shape[-1] % CELLS**2:
        refuse("its cut heights have a wrong type or shape")
    heights = from_planes(found, (found.shape[-1] // CELLS**2, CELLS, CELLS))
    if not (heights >= 0.0).all():
        refuse("a cut height is negative or not a number")
    return _plots(arrays, "mown", plots, len(heights)), heights


def sown_of(saved: Saved, density: Density, loaded: LoadedScene, /) -> tuple[Ints, Bytes]:
    """Return the plots that are sown, (n, 3), and the densities on their pages of the scene's kinds.

    Kinds that the state does not have keep the densities of their maps. Raises ValueError for what cannot be, and for
    kinds that the scene does not have.
    """
    found, plots, kinds = saved.arrays.get("sown_densities", np.zeros(0)), density.sown, loaded.scene.grass
    if found.dtype != np.uint8 or found.ndim != plots.pages.ndim:
        refuse("its sown densities have a wrong type or shape")
    if not len(found):
        return _plots(saved.arrays, "sown", plots, 0), plots.pages[:0]
    then = kinds_of(saved.state, list(kinds))
    if found.shape[1:] != (CELLS, CELLS, len(then)):
        refuse("its sown densities are not those of its scene's kinds")
    where = _plots(saved.arrays, "sown", plots, len(found))
    if then == list(kinds):
        return where, found
    land = cast(Terrain, density.land)
    painted = load_density({name: kinds[name] for name in then}, land, loaded.folder, loaded.pictures)
    return carried(where, found, painted, density, [then.index(name) if name in then else None for name in kinds])


def _plots(arrays: Arrays, name: str, plots: Plots, pages: int) -> Ints:
    """Return plots and the page of each, (n, 3), of `pages` pages; raises ValueError for plots that are not there."""
    where = arrays.get(name, np.zeros(0))
    if (
        where.dtype != np.int32
        or where.shape != (len(where), 3)
        or len({*map(tuple, where[:, :2].tolist())}) != len(where)
    ):
        refuse(f"its {name} plots have a wrong type or shape, or one comes twice")
    across, along = plots.half
    if not ((where >= (-along, -across, 0)) & (where < (along, across, pages))).all():
        refuse(f"one of its {name} plots is off the terrain or on no page")
    return where


def ground_of(arrays: Arrays, terrain: Terrain, /) -> Squares:
    """Return the changed squares of the ground; raises ValueError for what cannot be."""
    where, found = (arrays.get(name, np.zeros(0)) for name in ("ground_squares", "ground_heights"))
    if where.dtype != np.int32 or where.shape != (len(where), 2) or found.dtype != np.uint8 or found.shape[:-1] != (4,):
        refuse("its changed ground has a wrong type or shape")
    holes = arrays.get("ground_holes", np.zeros(found.shape[-1], np.bool_))
    if holes.dtype != np.bool_ or holes.ndim != 1:
        refuse("its holes have a wrong type or shape")
    squares = where, from_planes(found, (found.shape[-1],)), holes
    try:
        must_be_squares(terrain, squares)
    except ValueError as error:
        refuse(str(error))
    return squares


def cells_of(arrays: Arrays, /) -> list[Cell]:
    """Return the cleared cells; raises ValueError for anything but cells."""
    found = arrays.get("cleared", np.zeros(0))
    if found.dtype != np.int32 or found.ndim != 2 or found.shape[1] != 2:
        refuse("its cleared cells have a wrong type or shape")
    return [(i, j) for i, j in found.tolist()]
