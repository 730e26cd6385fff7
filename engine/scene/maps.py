"""Loading the maps that a scene names; problems are reported at the keys that name them."""

from collections.abc import Sequence

from ..declared.array import HeightFunction, MapArray
from ..terrain.density import load_density
from ..terrain.errors import MapError
from ..terrain.load import load_terrain
from ..terrain.record import Density, Terrain
from .problem import SceneError
from .read import LoadedScene
from .unusable import NOWHERE, bad_densities, bad_terrain, off_terrain

Maps = tuple[Terrain, Density]
"""A scene's elevation and density maps."""


def load_maps(loaded: LoadedScene, /, *, before: tuple[LoadedScene, Maps] | None = None) -> Maps:
    """Return a scene's elevation and density maps; unchanged ones are taken over from the scene `before`.

    Raises SceneError with every unusable map and every place of camera and trees off the terrain.
    """
    scene, folder, document, pictures = loaded.scene, loaded.folder, loaded.document, loaded.pictures
    try:
        terrain = _kept_terrain(loaded, before) or load_terrain(scene.terrain, folder, about=scene.camera.position)
    except MapError as error:
        problem = bad_terrain(document, scene.terrain, error)
        raise SceneError([problem, *bad_densities(document, scene.grass, NOWHERE, folder, pictures)]) from error
    outside = list(off_terrain(document, scene.camera, scene.trees, terrain))
    try:
        density = _kept_density(loaded, terrain, before) or load_density(scene.grass, terrain, folder, pictures)
    except MapError as error:
        problems = bad_densities(document, scene.grass, terrain, folder, pictures)
        raise SceneError([*outside, *problems]) from error
    if outside:
        raise SceneError(outside)
    return terrain, density


def _kept_terrain(loaded: LoadedScene, before: tuple[LoadedScene, Maps] | None) -> Terrain | None:
    if before is None:
        return None
    old, (terrain, _) = before
    source = loaded.scene.terrain
    same = source == old.scene.terrain and _same_files(loaded, old, [source.heights, source.holes])
    return terrain if same else None


def _kept_density(loaded: LoadedScene, terrain: Terrain, before: tuple[LoadedScene, Maps] | None) -> Density | None:
    if before is None:
        return None
    old, (_, density) = before
    places = [kind.place for kind in loaded.scene.grass.values()]
    same = terrain.whole == density.size and places == [kind.place for kind in old.scene.grass.values()]
    steep = [kind.slope for kind in loaded.scene.grass.values()]
    same = same and steep == [kind.slope for kind in old.scene.grass.values()]
    maps = [None if place is None else place.map for place in places]
    if not same or not _same_files(loaded, old, maps):
        return None
    return density if density.land is terrain else Density(density.maps, density.size, terrain, density.slopes)


def _same_files(loaded: LoadedScene, old: LoadedScene, maps: Sequence[str | MapArray | HeightFunction | None]) -> bool:
    same_folder = loaded.folder == old.folder
    return all(not isinstance(name, str) or (same_folder and _same_file(loaded, old, name)) for name in maps)


def _same_file(loaded: LoadedScene, old: LoadedScene, name: str) -> bool:
    same_picture = loaded.pictures.get(name) is old.pictures.get(name)
    return same_picture and (name in loaded.pictures or loaded.files.get(name) == old.files.get(name))
