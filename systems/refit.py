"""States of earlier versions of a scene: fitted to the present one, and what of them has no place in it."""

from collections import Counter
from collections.abc import Collection, Sequence
from typing import Any

import numpy as np

from ..components.arrays import Floats, Indices, Ints, Mask, Place
from ..components.wind import WindPrimitive, WindSource
from ..engine.declared.scene import Reading
from ..engine.terrain.blocks import SQUARE
from ..engine.terrain.change import lies_at, loaded_heights, parts_of
from ..engine.terrain.plots import Plots
from ..engine.terrain.record import Terrain
from ..engine.terrain.rectangle import Rectangle
from .examine import ground_of
from .fitting import SAME, alike_at, lies_alike, scene_of
from .pressers import Pressers
from .saved import SavedWind, State
from .site import Site
from .stowed import saved_wind, wind_of, wind_on_course
from .winds import matched

Refitted = tuple[State, list[str]]
"""A state without what has no place in a scene, and what that is, in words."""

_DUG = "the ground that was dug"

NAMED = 3
"""Most things of a sort that a sentence names; of more it tells their number."""


def refit(state: State, site: Site, lie: Floats, reading: Reading, pressers: Pressers, /) -> Refitted:
    """Return a state fitted to a site, of which `lie` are samples, and what of the state has no place there.

    Raises ValueError for a state that contradicts itself, and for a wind that cannot be made.
    """
    state, dug = _onto_ground(state, site, lie)
    state, grown = _with_kinds(state, [*site.scene.grass])
    state, blown = _with_winds(state, site.scene.wind, reading)
    then, now, trodden = state.treading.declared, site.scene.pressers, list[str]()
    if len(then) != len(now):
        footprints = [presser.footprint() for presser in now]
        trodden += ["what was done to its pressers"] * any(presser not in footprints for presser in then)
        state = _changed(state, treading=pressers.begun_anew(state.treading))
    return state, [*dug, *grown, *blown, *trodden]


def without_unknown_winds(state: State, reading: Reading, /) -> Refitted:
    """Return a state without the winds that cannot be made, such as those of a package that is not installed."""
    every = [*filter(None, state.declared), *state.added, *state.winds]
    unknown = [wind for wind in every if not _can_be_made(wind, reading)]
    pairs = zip(state.scene.wind, state.declared, strict=True)
    kept = [(kind, wind) for kind, wind in pairs if wind not in unknown]
    state = _changed(
        state,
        scene=state.scene.model_copy(update={"wind": [kind for kind, _ in kept]}),
        declared=[wind for _, wind in kept],
        added=[wind for wind in state.added if wind not in unknown],
        winds=[wind for wind in state.winds if wind not in unknown],
    )
    return state, _named("the wind", [wind.name for wind in unknown])


def felled_in_words(places: Sequence[Place], /) -> list[str]:
    """Return what a sentence says of felled trees that stand nowhere in a scene."""
    return _named("the tree felled at", [f"({x:.6g}, {z:.6g})" for x, z in places], quote="")


def _onto_ground(state: State, site: Site, lie: Floats) -> Refitted:
    """Leave out what is dug into another ground, what lies beyond its edge, and cleared patches of another side."""
    then, now, lost = state.scene, scene_of(site), list[str]()
    if not lies_alike(state, site, lie):
        state, lost = _dug_onto(state, site, lie)
        mown, sown = (_within(where, site.ground.density.sown) for where in (state.mown, state.sown))
        if len(mown) + len(sown) < len(state.mown) + len(state.sown):
            lost.append("what was cut or sown beyond its edge")
        state = _changed(state, lie=lie, mown=mown, sown=sown)
    if len(state.cleared) and then.patch != now.patch:
        lost.append(f"cleared patches of {then.patch:g} m")
        state = _changed(state, cleared=state.cleared[:0])
    return state, lost


def _dug_onto(state: State, site: Site, lie: Floats) -> Refitted:
    """Leave out what is dug where the ground lies otherwise now; there it is as the scene has it."""
    if not len(state.ground):
        return state, []
    if site.ground.terrain.blocks is not None:
        return _dug_onto_stream(state, site)
    terrain, alike, kept = site.ground.terrain, alike_at(state, site, lie), list[Mask]()
    if alike is not None:
        ground_of(state, terrain)  # raises where its squares are none of the terrain
        parts = parts_of(terrain, state.ground)
        kept = [alike[part.slices] for part in parts]
    if not any(each.any() for each in kept):
        return _dug_at(state, np.zeros(0, np.intp)), [_DUG]
    stays, loaded = np.concatenate([each.ravel() for each in kept]), loaded_heights(terrain, state.ground)
    heights, holes = (
        np.where(stays, then, now) for then, now in zip((state.ground_heights, state.ground_holes), loaded, strict=True)
    )
    state = _changed(state, ground_heights=heights, ground_holes=holes)
    return state, [] if stays.all() else [f"{_DUG} {_elsewhere(terrain, parts, kept)}"]


def _dug_onto_stream(state: State, site: Site) -> Refitted:
    """Leave out the squares that are dug into a ground that streams where that lies otherwise now."""
    terrain, where, then = site.ground.terrain, state.ground, state.ground_lies
    streamed = state.scene.size == scene_of(site).size and len(then) == len(where)
    if not streamed or state.scene.cell != terrain.cell:
        return _dug_at(state, np.zeros(0, np.intp)), [_DUG]
    ground_of(state, terrain)  # raises where its squares are none of the terrain
    alike = np.isclose(then, lies_at(terrain, where.tolist()), rtol=0.0, atol=SAME, equal_nan=True).all(axis=1)
    if alike.all():
        return state, []
    side, gone = SQUARE * terrain.cell, where[~alike, ::-1]
    box = _between(side * gone.min(axis=0), side * (gone.max(axis=0) + 1))
    return _dug_at(state, np.flatnonzero(alike)), [f"{_DUG} {box}"]


def _dug_at(state: State, rows: Indices) -> State:
    """Return a state with these of its dug squares, in turn, of a ground that streams; of others with none."""
    heights, holes = (
        each.reshape(len(state.ground), -1)[rows].ravel() if len(rows) else each[:0]
        for each in (state.ground_heights, state.ground_holes)
    )
    lies = state.ground_lies[rows] if len(rows) else state.ground_lies[:0]
    return _changed(state, ground=state.ground[rows], ground_heights=heights, ground_holes=holes, ground_lies=lies)


def _elsewhere(terrain: Terrain, parts: Sequence[Rectangle], kept: Sequence[Mask]) -> str:
    """Return in words the least box about all samples of some parts that are not kept."""
    gone = [np.add(np.argwhere(~each), (part.row, part.column)) for part, each in zip(parts, kept, strict=True)]
    every = np.concatenate(gone)[:, ::-1]
    (x0, z0), (x1, z1) = (terrain.origin + terrain.cell * each for each in (every.min(axis=0), every.max(axis=0)))
    return _between((x0, z0), (x1, z1))


def _between(low: Sequence[float] | Floats, high: Sequence[float] | Floats) -> str:
    """Return in words where a ground lies otherwise: within a box from one place (x, z) to another."""
    return f"between ({low[0]:.6g}, {low[1]:.6g}) and ({high[0]:.6g}, {high[1]:.6g}), where it lies otherwise now"


def _within(where: Ints, plots: Plots) -> Ints:
    """Return those of some stored plots (n, 3) that lie on a map."""
    across, along = plots.half
    within: Ints = where[((where[:, :2] >= (-along, -across)) & (where[:, :2] < (along, across))).all(axis=1)]
    return within


def _with_kinds(state: State, names: Collection[str]) -> Refitted:
    """Leave out changes of kinds of grass that a scene does not have; name those on plots that are sown or cleared."""
    densities = state.sown_densities
    lost = [f"the change of the grass '{each.name}'" for each in state.seasons if each.name not in names]
    pairs = zip(state.scene.grass, np.moveaxis(densities, -1, 0), strict=False)
    gone = [name for name, pages in pairs if name not in names and pages.any()]
    lost += _named("what is sown where there was the grass", gone)
    return _changed(state, seasons=[each for each in state.seasons if each.name in names]), lost


def _with_winds(state: State, winds: Sequence[WindPrimitive], reading: Reading) -> Refitted:
    """Give each of a scene's winds the saved wind that it continues; leave out those that none continues.

    A wind that the game had deleted deletes one of its kind. Whatever is left of the scene's winds is new, and begins
    as the scene has it.
    """
    kinds = state.scene.wind
    if kinds == [wind.kind for wind in winds]:
        return state, []
    saved = [*filter(None, state.declared)]
    there = {WindSource(wind_of(wind.kind, wind.values, reading), wind.name): wind for wind in saved}
    deleted = Counter(kind for kind, wind in zip(kinds, state.declared, strict=True) if wind is None)
    declared, left = list[SavedWind | None](), dict(there)
    for number, (source, old) in enumerate(matched([*there], winds)):
        if old is not None:
            declared.append(left.pop(old))
        elif deleted[source.primitive.kind]:
            deleted[source.primitive.kind] -= 1
            declared.append(None)
        else:
            declared.append(saved_wind(-1 - number, source))
    return _changed(state, declared=declared), _named("the wind", [wind.name for wind in left.values()])


def _can_be_made(wind: SavedWind, reading: Reading) -> bool:
    try:
        wind_of(wind.kind, wind.values, reading) if wind.course is None else wind_on_course(wind, reading)
    except ValueError:
        return False
    return True


def _named(what: str, names: Sequence[str], quote: str = "'") -> list[str]:
    """Return a phrase for each of some things of a sort, or one for all if they are many."""
    if len(names) > NAMED:
        return [f"{what} {quote}{names[0]}{quote} and {len(names) - 1} others"]
    return [f"{what} {quote}{name}{quote}" for name in names]


def _changed(state: State, **fields: Any) -> State:
    return state.model_copy(update=fields)
