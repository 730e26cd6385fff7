"""The check that a saved state is one of a scene: that it has this seed and this ground."""

import numpy as np

from ..components.arrays import Floats, Ints, Mask
from ..engine.stored import refuse, unfit
from ..engine.terrain.change import as_loaded
from ..engine.terrain.record import Terrain
from .saved import SavedScene, State
from .site import Site
from .space.ground import Ground

LINES = 16
"""Number of rows and of columns of samples by which two grounds are compared."""

SAME = 0.01
"""Tolerance of heights [m]: another processor or release may compute the same ground a little differently."""


def scene_of(site: Site, /) -> SavedScene:
    """Return what a scene must have in common with the site for a state made here to fit."""
    scene, terrain = site.scene, site.ground.terrain
    return SavedScene(
        seed=scene.seed, size=terrain.whole, cell=terrain.cell, patch=site.ground.patch, grass=list(scene.grass),
        wind=[wind.kind for wind in scene.wind],
    )  # fmt: skip


def lie_of(ground: Ground, /) -> Floats:
    """Return samples of a ground's heights as it was loaded, from all over it [m]; NaN in holes."""
    parts = list(as_loaded(ground.terrain))
    if ground.terrain.blocks is not None:
        return np.concatenate([_open(heights, holes)[::LINES, ::LINES].ravel() for heights, holes in parts])
    along, across = _lines(ground.terrain)
    first, found = 0, list[Floats]()
    for heights, holes in parts:
        own = along[(along >= first) & (along < first + len(heights))] - first
        found.append(_open(heights, holes)[np.ix_(own, across)].ravel())
        first += len(heights)
    return np.concatenate(found)


def must_be_of(state: State, site: Site, lie: Floats, /) -> None:
    """Raise ValueError for a state of another scene: another seed or ground; `lie` are samples of the site's ground."""
    then, now = state.scene, scene_of(site)
    if then.seed != now.seed:
        unfit(f"its seed is {then.seed}, and this one's {now.seed}")
    if (then.size, then.cell) != (now.size, now.cell):
        unfit(f"its ground is {_ground_text(then)}, and this one's {_ground_text(now)}")
    if state.lie.shape != lie.shape:
        refuse("it has too few samples of its ground, or too many")
    if not lies_alike(state, site, lie):
        unfit("its ground has other heights or holes")


def lies_alike(state: State, site: Site, lie: Floats, /) -> bool:
    """Return whether a state's ground is that of a site, of which `lie` are samples."""
    then, now = state.scene, scene_of(site)
    same = (then.size, then.cell) == (now.size, now.cell) and state.lie.shape == lie.shape
    return same and np.allclose(state.lie, lie, rtol=0.0, atol=SAME, equal_nan=True)


def alike_at(state: State, site: Site, lie: Floats, /) -> Mask | None:
    """Return where a site's ground is still that of a state, for each sample, shape (rows, columns).

    That is between four samples of `lie` that agree. None for a ground of other samples, and for one that streams.
    """
    then, now, terrain = state.scene, scene_of(site), site.ground.terrain
    if terrain.blocks is not None or (then.size, then.cell) != (now.size, now.cell) or state.lie.shape != lie.shape:
        return None
    lines, shape = _lines(terrain), terrain.heights.shape
    same = np.isclose(state.lie, lie, rtol=0.0, atol=SAME, equal_nan=True).reshape([len(each) for each in lines])
    between = same[:-1, :-1] & same[:-1, 1:] & same[1:, :-1] & same[1:, 1:]
    at = [
        np.clip(np.searchsorted(each, np.arange(count), side="right") - 1, 0, len(each) - 2)
        for each, count in zip(lines, shape, strict=True)
    ]
    return np.asarray(between[np.ix_(*at)])


def _lines(terrain: Terrain) -> tuple[Ints, Ints]:
    """Return the rows and the columns of a terrain's samples that `lie_of` takes."""
    along, across = (np.unique(np.linspace(0, count - 1, LINES).astype(np.int32)) for count in terrain.heights.shape)
    return along, across


def _open(heights: Floats, holes: Mask) -> Floats:
    return np.where(holes, np.float32(np.nan), heights)


def _ground_text(scene: SavedScene) -> str:
    return f"{scene.size[0]:g} by {scene.size[1]:g} m with a sample every {scene.cell:g} m"
