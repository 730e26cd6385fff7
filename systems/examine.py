"""The arrays of a saved state, checked: what is trodden, cut, sown and dug."""

from typing import cast

import numpy as np

from ..components.arrays import Bytes, Floats, Ints
from ..engine.scene import LoadedScene
from ..engine.stored import refuse
from ..engine.terrain.change import Squares, must_be_squares
from ..engine.terrain.density import load_density
from ..engine.terrain.plots import Plots
from ..engine.terrain.record import Density, Terrain
from .mow.sown import carried
from .press.footprint import discs_of
from .press.trail import BEGUN, FIRST, LAST, LEFT, REACH, Stretches
from .pressers import Treading
from .saved import State

FARTHEST, WIDEST, LONGEST = 2e6, 31.0, 40.0
"""Largest coordinates, reaches and lengths of stretches [m]."""

LATEST = 1e9
"""Largest absolute times of stretches [s]."""


def must_be_trodden(treading: Treading, /) -> None:
    """Raise ValueError for a state of pressers that cannot be."""
    for walk in treading.walks:
        discs = sum(len(discs_of(presser)) for _, presser in walk.pressers)
        if not discs == len(walk.open) == len(walk.way) or len(walk.pose) != len(walk.pressers):
            refuse("a walk has too few discs or poses, or too many")
        _must_be_stretches(np.concatenate([walk.open, walk.closed]))
    _must_be_stretches(treading.kept)
    if not all(-len(treading.declared) <= number < 0 for number, _ in treading.walks[0].pressers):
        refuse("it has pressers that its scene does not declare")


def _must_be_stretches(found: Stretches) -> None:
    length = np.hypot(*(found[:, LAST] - found[:, FIRST]).T)
    in_range = (np.abs(found[:, : LAST.stop]) <= FARTHEST).all() and (length <= LONGEST).all()
    in_range = in_range and ((found[:, REACH] > 0.0) & (found[:, REACH] <= WIDEST)).all()
    if not in_range or (np.abs(found[:, BEGUN : LEFT + 1]) > LATEST).any():
        refuse("a stretch of a way is too long or too far off")


def mown_of(state: State, plots: Plots, /) -> tuple[Ints, Floats]:
    """Return the cut plots, (n, 3), and the heights on their pages [m]; raises ValueError for what cannot be."""
    if not (state.mown_heights >= 0.0).all():
        refuse("a cut height is negative or not a number")
    return _plots(state.mown, plots, len(state.mown_heights)), state.mown_heights


def sown_of(state: State, density: Density, loaded: LoadedScene, /) -> tuple[Ints, Bytes]:
    """Return the plots that are sown, (n, 3), and the densities on their pages of the scene's kinds.

    Kinds that the state does not have keep the densities of their maps, and so does ground where a kind grew that the
    scene does not have. Raises ValueError for what cannot be.
    """
    found, plots, kinds = state.sown_densities, density.sown, loaded.scene.grass
    where = _plots(state.sown, plots, len(found))
    if not len(found):
        return where, plots.pages[:0]
    then = state.scene.grass
    if found.shape[-1] != len(then):
        refuse("its sown densities are not those of its scene's kinds")
    if then == list(kinds):
        return where, found
    known = [name for name in then if name in kinds]
    order = [then.index(name) for name in [*known, *(name for name in then if name not in kinds)]]
    land = cast(Terrain, density.land)
    painted = load_density({name: kinds[name] for name in known}, land, loaded.folder, loaded.pictures)
    old_kinds = [known.index(name) if name in known else None for name in kinds]
    return carried(where, found[..., order], painted, density, old_kinds)


def _plots(where: Ints, plots: Plots, pages: int) -> Ints:
    """Return plots and the page of each, (n, 3), of `pages` pages; raises ValueError for plots that are not there."""
    across, along = plots.half
    within = (where >= (-along, -across, 0)) & (where < (along, across, pages))
    if not within.all() or len({*map(tuple, where[:, :2].tolist())}) != len(where):
        refuse("one of its plots is off the terrain, on no page, or comes twice")
    return where


def ground_of(state: State, terrain: Terrain, /) -> Squares:
    """Return the changed squares of the ground; raises ValueError for what cannot be."""
    squares = state.ground, state.ground_heights, state.ground_holes
    try:
        must_be_squares(terrain, squares)
    except ValueError as error:
        refuse(str(error))
    return squares
