"""The check that a saved state fits a scene: only what the state depends on has to be the same."""

from collections.abc import Sequence

import numpy as np

from ..components.arrays import Floats, Mask
from ..engine.stored import refuse, unfit
from ..engine.terrain.change import as_loaded
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
    rows, columns = ground.terrain.heights.shape
    along, across = (np.unique(np.linspace(0, count - 1, LINES).astype(int)) for count in (rows, columns))
    first, found = 0, list[Floats]()
    for heights, holes in parts:
        own = along[(along >= first) & (along < first + len(heights))] - first
        found.append(_open(heights, holes)[np.ix_(own, across)].ravel())
        first += len(heights)
    return np.concatenate(found)


def must_fit(state: State, site: Site, lie: Floats, /) -> None:
    """Raise ValueError if a state does not fit a site; `lie` are the samples of the site's ground."""
    scene = site.scene
    _must_be_alike(state.scene, scene_of(site), cleared=len(state.cleared))
    if state.lie.shape != lie.shape:
        refuse("it has too few samples of its ground, or too many")
    if not np.allclose(state.lie, lie, rtol=0.0, atol=SAME, equal_nan=True):
        unfit("its ground has other heights or holes")
    if len(state.declared) != len(scene.wind):
        unfit(f"its scene declares {len(state.declared)} winds, and this one {len(scene.wind)}")
    if len(state.treading.declared) != len(scene.pressers):
        unfit(f"its scene declares {len(state.treading.declared)} pressers, and this one {len(scene.pressers)}")
    for season in state.seasons:
        if season.name not in scene.grass:
            unfit(f"the grass '{season.name}' is changed in it, which this scene does not have")


def _must_be_alike(then: SavedScene, now: SavedScene, /, *, cleared: int) -> None:
    if then.seed != now.seed:
        unfit(f"its seed is {then.seed}, and this one's {now.seed}")
    if (then.size, then.cell) != (now.size, now.cell):
        unfit(f"its ground is {_ground_text(then)}, and this one's {_ground_text(now)}")
    if then.wind != now.wind:
        unfit(f"its scene declares {_listed(then.wind, 'wind')}, and this one {_listed(now.wind, 'wind')}")
    if cleared and then.patch != now.patch:
        unfit(f"patches of {then.patch:g} m are cleared in it, and here they have {now.patch:g} m")


def kinds_of(state: State, names: Sequence[str], /) -> list[str]:
    """Return the names of the kinds with which a state's ground is sown, in its order.

    `names` are those of the scene; raises ValueError if any are missing there.
    """
    gone = [name for name in state.scene.grass if name not in names]
    if gone:
        unfit(f"ground is sown or cleared in it with {_listed(gone, 'grass')}, which this scene does not have")
    return state.scene.grass


def _open(heights: Floats, holes: Mask) -> Floats:
    return np.where(holes, np.float32(np.nan), heights)


def _ground_text(scene: SavedScene) -> str:
    return f"{scene.size[0]:g} by {scene.size[1]:g} m with a sample every {scene.cell:g} m"


def _listed(names: Sequence[str], what: str) -> str:
    return f"the {what} {', '.join(names)}" if names else f"no {what}"
