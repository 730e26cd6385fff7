"""Problems of a scene's maps, and of places of its camera and trees."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from ...components.declaration import Declaration
from ..declared.camera import CameraSource
from ..declared.grass import GrassKind
from ..declared.terrain import TerrainSource
from ..declared.tree import TreeKind
from ..terrain.density import load_density
from ..terrain.errors import MapError
from ..terrain.load import load_terrain
from ..terrain.record import Terrain
from .document import Document, Where
from .problem import Problem, SceneError
from .validate import upgraded

Pictures = Mapping[str, NDArray[np.uint8]]
Model = TypeVar("Model", bound=Declaration)

NOWHERE = Terrain(np.zeros((2, 2), np.float32), 100.0)
"""Terrain on which density maps are tried where the scene's terrain is unusable."""


def bad_terrain(document: Document, source: TerrainSource, error: MapError, /) -> Problem:
    """Return the problem of an unusable elevation map, or of a noise."""
    return document.problem(("terrain", "noise" if source.heights is None else "heights"), str(error))


def bad_densities(
    document: Document, kinds: Mapping[str, GrassKind], terrain: Terrain, folder: Path, pictures: Pictures, /
) -> Iterator[Problem]:
    """Yield the problem of every unusable density map."""
    for name, kind in kinds.items():
        try:
            load_density({name: kind}, terrain, folder, pictures)
        except MapError as error:
            yield document.problem(("grass", name, "place", "map"), str(error))


def off_terrain(
    document: Document, camera: CameraSource | None, trees: Mapping[str, TreeKind], terrain: Terrain, /
) -> Iterator[Problem]:
    """Yield a problem for each place of the camera off the terrain, and for the first one of each kind of tree."""
    places = list[tuple[Where, list[float]]]()
    if camera is not None:
        places += [(("camera", "position"), camera.position)]
        places += [(("camera", "path", i, "position"), stop.position) for i, stop in enumerate(camera.path)]
    width, depth = terrain.whole
    for name, kind in trees.items():
        place = np.abs(np.array(kind.positions).reshape(-1, 2))
        off = (place > (width / 2, depth / 2)).any(axis=1).nonzero()[0]
        places += [(("trees", name, "positions", int(i)), kind.positions[i]) for i in off[:1]]
    for where, (x, z) in places:
        if abs(x) > width / 2 or abs(z) > depth / 2:
            extent = f"x from {-width / 2:g} to {width / 2:g} and z from {-depth / 2:g} to {depth / 2:g} m"
            yield document.problem(where, f"position is off the terrain, which spans {extent}")


def unusable(document: Document, folder: Path, /) -> Iterator[Problem]:
    """Yield problems of maps and places of a scene that has been refused already, as far as its parts are valid.

    So all problems are reported together, whatever else is wrong with the file.
    """
    if not isinstance(document.root.data, dict):
        return
    try:
        values = upgraded(document)
    except SceneError:
        return
    source, camera = _part(TerrainSource, values.get("terrain", {})), _part(CameraSource, values.get("camera", {}))
    kinds, trees = _parts(GrassKind, values.get("grass")), _parts(TreeKind, values.get("trees"))
    terrain = NOWHERE
    if source is not None:
        try:
            terrain = load_terrain(source, folder)
            yield from off_terrain(document, camera, trees, terrain)
        except MapError as error:
            yield bad_terrain(document, source, error)
    yield from bad_densities(document, kinds, terrain, folder, {})


def _parts(model: type[Model], values: Any) -> dict[str, Model]:
    """Return the valid parts of a mapping, by name."""
    parts = {name: _part(model, value) for name, value in values.items()} if isinstance(values, dict) else {}
    return {name: part for name, part in parts.items() if part is not None}


def _part(model: type[Model], values: Any) -> Model | None:
    """Return a part of the scene, or None where it is invalid."""
    try:
        return model.model_validate(values)
    except ValidationError:
        return None
