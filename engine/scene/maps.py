"""Loading the maps that a scene names, with problems at the keys that name them."""

from collections.abc import Iterator

import numpy as np

from ..terrain.density import load_density
from ..terrain.errors import MapError
from ..terrain.load import load_terrain
from ..terrain.record import Density, Terrain
from .document import Where
from .problem import Problem, SceneError
from .read import LoadedScene

_NOWHERE = Terrain(np.zeros((2, 2), np.float32), 100.0)


Maps = tuple[Terrain, Density]
"""A scene's elevation and density maps."""


def load_maps(loaded: LoadedScene, /, *, before: tuple[LoadedScene, Maps] | None = None) -> Maps:
    """Return a scene's elevation and density maps; of those of a scene `before`, what has not changed since.

    Raises SceneError with every map that cannot be used and every place of the camera that is off the terrain.
    """
    scene, folder = loaded.scene, loaded.folder
    try:
        terrain = _kept_terrain(loaded, before) or load_terrain(scene.terrain, folder)
    except MapError as error:
        where = ("terrain", "noise" if scene.terrain.heights is None else "heights")
        problem = loaded.document.problem(where, str(error))
        raise SceneError([problem, *_bad_densities(loaded, _NOWHERE)]) from error
    outside = list(_outside(loaded, terrain))
    try:
        density = _kept_density(loaded, terrain, before) or load_density(scene.grass, terrain, folder, loaded.pictures)
    except MapError as error:
        raise SceneError([*outside, *_bad_densities(loaded, terrain)]) from error
    if outside:
        raise SceneError(outside)
    return terrain, density


def _kept_terrain(loaded: LoadedScene, before: tuple[LoadedScene, Maps] | None) -> Terrain | None:
    if before is None:
        return None
    old, (terrain, _) = before
    source = loaded.scene.terrain
    same = source == old.scene.terrain and _same_files(loaded, old, [source.heights])
    return terrain if same else None


def _kept_density(loaded: LoadedScene, terrain: Terrain, before: tuple[LoadedScene, Maps] | None) -> Density | None:
    if before is None:
        return None
    old, (_, density) = before
    places = [kind.place for kind in loaded.scene.grass.values()]
    same = terrain.size == density.size and places == [kind.place for kind in old.scene.grass.values()]
    names = [None if place is None else place.map for place in places]
    return density if same and _same_files(loaded, old, names) else None


def _same_files(loaded: LoadedScene, old: LoadedScene, names: list[str | None]) -> bool:
    same_folder = loaded.folder == old.folder
    return all(name is None or (same_folder and _same_file(loaded, old, name)) for name in names)


def _same_file(loaded: LoadedScene, old: LoadedScene, name: str) -> bool:
    same_picture = loaded.pictures.get(name) is old.pictures.get(name)
    return same_picture and (name in loaded.pictures or loaded.files.get(name) == old.files.get(name))


def _bad_densities(loaded: LoadedScene, terrain: Terrain) -> Iterator[Problem]:
    for name, kind in loaded.scene.grass.items():
        try:
            load_density({name: kind}, terrain, loaded.folder, loaded.pictures)
        except MapError as error:
            yield loaded.document.problem(("grass", name, "place", "map"), str(error))


def _outside(loaded: LoadedScene, terrain: Terrain) -> Iterator[Problem]:
    camera = loaded.scene.camera
    places: list[tuple[Where, list[float]]] = [(("camera", "position"), camera.position)]
    places += [(("camera", "path", i, "position"), stop.position) for i, stop in enumerate(camera.path)]
    width, depth = terrain.size
    for where, (x, z) in places:
        if abs(x) > width / 2 or abs(z) > depth / 2:
            extent = f"x from {-width / 2:g} to {width / 2:g} and z from {-depth / 2:g} to {depth / 2:g} m"
            yield loaded.document.problem(where, f"position is off the terrain, which spans {extent}")
