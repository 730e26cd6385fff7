"""Terrains from elevation maps and from noise."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from logging import getLogger
from math import ceil
from pathlib import Path

import numpy as np

from ...components.arrays import Doubles, Floats, Mask
from ..declared.array import HeightFunction, MapArray
from ..declared.terrain import TerrainSource
from .blocks import BLOCK, PARTS, Blocks
from .density import at_samples, load_holes
from .elevation import Elevation, check_finite
from .errors import MapError
from .noise import LANDSCAPES, landscape
from .read import elevation_of, read_elevation
from .record import Terrain
from .resample import fill_voids, resample
from .stream import window_of

WIDEST = 10240.0
"""Longest side of a terrain [m]; farther out, positions in single precision are too coarse for blades of grass."""

NARROWEST = 5.0
"""Shortest side of a terrain [m]."""

SMOOTH = 2.5
"""Longest side of a terrain's cell [m], so that its bilinear surface does not look faceted."""

SIDE = 4097
"""Greatest number of samples along a side of a terrain; cells get longer than `SMOOTH` only for this limit."""

HIGHEST = 50_000.0
"""Greatest distance of a height from 0 [m]; a map beyond it is taken to be wrong."""

DEFAULT_SIZE = [200.0, 200.0]
"""Width and depth of a terrain, where the scene gives none [m]."""

RANGE = 100.0
"""Vertical scale of 16-bit heights, where the scene gives none [m]."""

SQUARE = 256
"""Number of samples along a side of the squares for which a function is called."""

_log = getLogger(__name__)


def load_terrain(source: TerrainSource, folder: Path, /, *, about: Sequence[float] = (0.0, 0.0)) -> Terrain:
    """Return the terrain that a scene declares; its files lie in `folder`.

    Cells longer than 2.5 m are divided by a smooth surface through their corners, and a map wider than the scene's
    size, or than 10240 m, is cut to its middle. Voids that an elevation model marks are filled from around them. For a
    ground that streams, the terrain is the window `about` a place (x, z) [m]. Raises `MapError` for an unusable map.
    """
    if isinstance(source.heights, HeightFunction) and source.window is not None:
        return _streamed(source.heights, source, source.window, about)
    loaded = _with_holes(_loaded(source, folder), source, folder)
    return replace(loaded, mirrored=True) if source.beyond == "mirror" else loaded


def _streamed(function: HeightFunction, source: TerrainSource, window: float, about: Sequence[float]) -> Terrain:
    """Return the window around a place (x, z) [m] of a function's ground; the window is at least `window` wide [m]."""
    cell = min(source.cell, SMOOTH)
    steps = max(ceil(window / cell / (PARTS * BLOCK) - 1e-6), 1)
    if steps * PARTS * BLOCK >= SIDE:
        raise MapError(None, f"a window of {window:g} m has more than {SIDE - 1} cells of {cell:g} m: enlarge cell")

    def ask(x: Doubles, z: Doubles) -> tuple[Floats, Mask | None]:
        elevation = Elevation(_heights_of(function, x, z), None)
        holes: Mask = np.isnan(elevation.values)
        if holes.all():
            return np.full(holes.shape, source.offset, np.float32), holes
        return _metres(None, elevation, source, holes if holes.any() else None), holes if holes.any() else None

    blocks = Blocks(ask, cell, steps * PARTS * BLOCK)
    made = window_of(blocks, blocks.first_about(about[0], about[1]))
    blocks.loads = False
    return made


def _loaded(source: TerrainSource, folder: Path) -> Terrain:
    if source.heights is None:
        return _noise(source)
    if isinstance(source.heights, HeightFunction):
        return _of_function(source.heights, source)
    if isinstance(source.heights, MapArray):
        path, elevation = None, elevation_of(source.heights.values)
    else:
        path = folder / source.heights
        elevation = read_elevation(path, source)
    holes = _holes_in(path, elevation)
    heights = _metres(path, elevation, source, holes)
    if source.flip:
        heights, holes = heights[::-1], None if holes is None else holes[::-1]
    return _spread(path, heights, elevation.cell or (source.cell, source.cell), source.size, holes)


def _of_function(function: HeightFunction, source: TerrainSource) -> Terrain:
    """Return the terrain of the scene's size that a program's function describes."""
    size = source.size or DEFAULT_SIZE
    cell = max(min(source.cell, SMOOTH), max(size) / (SIDE - 1))
    x, z = (_places(side, cell) for side in size)
    given = _heights_of(function, x, z)
    elevation = Elevation(given, None)
    holes = _holes_in(None, elevation)
    return Terrain(_metres(None, elevation, source, holes), cell, holes)


def _holes_in(path: Path | None, elevation: Elevation) -> Mask | None:
    """Return a mask of heights that are NaN, in a map that marks no voids; None if none are."""
    if elevation.void is not None or elevation.values.dtype.kind != "f":
        return None
    found: Mask = np.isnan(elevation.values)
    if found.all():
        raise MapError(path, "none of it has a height")
    return found if found.any() else None


def _with_holes(terrain: Terrain, source: TerrainSource, folder: Path) -> Terrain:
    """Return a terrain with the holes that its scene declares, in addition to its own."""
    declared = load_holes(source, folder)
    if declared is None:
        return terrain
    holes = at_samples(declared, *terrain.heights.shape) > 0.5
    if terrain.holes is not None:
        holes |= terrain.holes
    return replace(terrain, holes=holes) if holes.any() else terrain


def _metres(path: Path | None, elevation: Elevation, source: TerrainSource, holes: Mask | None) -> Floats:
    """Return an elevation map's heights [m], with voids and holes (`holes`) filled from their surroundings."""
    values, void = elevation.values, elevation.void if holes is None else holes
    check_finite(path, values, "height", "heights", void)
    if elevation.whole is None:
        factor = 1.0 if source.scale is None else source.scale
    else:
        factor = (RANGE if source.scale is None else source.scale) / elevation.whole
    with np.errstate(over="ignore", invalid="ignore"):
        heights = values.astype(np.float32)
        heights *= np.float32(factor)
        heights += np.float32(source.offset)
    if void is not None and void.any():
        if holes is None and void.mean() > 0.5:
            raise MapError(path, f"{void.mean():.0%} of it has no height; at most half may be filled from around")
        heights = fill_voids(heights, void)
    low, high = float(heights.min()), float(heights.max())
    if max(-low, high) > HIGHEST:
        raise MapError(path, f"its heights go from {low:.6g} to {high:.6g} m; scale them, or mark its voids")
    return heights


def _spread(
    path: Path | None, heights: Floats, cells: tuple[float, float], wanted: list[float] | None, holes: Mask | None
) -> Terrain:
    """Return the terrain of `heights` with `cells` in x and z [m], cut to its middle of the `wanted` size [m]."""
    counts = heights.shape[::-1]
    size = [(count - 1) * cell for count, cell in zip(counts, cells, strict=True)]
    if min(size) < NARROWEST:
        raise MapError(path, f"it is only {size[0]:.3g} by {size[1]:.3g} m; give a larger cell, in metres")
    if wanted is None and max(size) > WIDEST * 1.0001:
        name = "the array of heights" if path is None else path.name
        _log.warning("%s is %.0f by %.0f m; only its middle %.0f m are used", name, *size, WIDEST)
    sides = [min(side, most) for side, most in zip(size, wanted or (WIDEST, WIDEST), strict=True)]
    cell = min(cells)
    cell = max(cell / ceil(cell / SMOOTH - 1e-6), max(sides) / (SIDE - 1))
    columns, rows = (
        _places(side, cell) / own + (count - 1) / 2 for side, own, count in zip(sides, cells, counts, strict=True)
    )
    if cells == (cell, cell) and (len(rows), len(columns)) == heights.shape:
        return Terrain(np.ascontiguousarray(heights), cell, None if holes is None else np.ascontiguousarray(holes))
    if holes is not None:
        near_rows, near_columns = (np.rint(each).astype(np.intp) for each in (rows, columns))
        holes = holes[np.ix_(np.clip(near_rows, 0, counts[1] - 1), np.clip(near_columns, 0, counts[0] - 1))]
    return Terrain(_resample_part(heights, rows, columns), cell, holes)


def _resample_part(heights: Floats, rows: Doubles, columns: Doubles) -> Floats:
    """Return `heights` interpolated at fractional `rows` and `columns`, reading only the cells around them."""
    margin = 8
    top, left = (max(0, int(axis[0]) - margin) for axis in (rows, columns))
    part = heights[top : int(rows[-1]) + margin, left : int(columns[-1]) + margin]
    return resample(part, rows - top, columns - left)


def _places(side: float, cell: float) -> Doubles:
    """Return places `cell` apart that fill `side` [m], symmetric about 0."""
    count = int(side / cell + 1e-6) + 1
    return np.asarray((np.arange(count) - (count - 1) / 2) * cell, np.float64)


def _noise(source: TerrainSource) -> Terrain:
    size = source.size or DEFAULT_SIZE
    kind = LANDSCAPES.get(source.noise or "flat")
    feature = source.feature or (kind.feature if kind else WIDEST)
    cell = min(source.cell, SMOOTH, feature / 8) if kind else max(source.cell, max(size) / 1024)
    cell = max(size) / min(ceil(max(size) / cell), SIDE - 1)
    x, z = (_places(max(round(side / cell), 1) * cell, cell) for side in size)
    heights = np.full((len(z), len(x)), source.offset, np.float32)
    if source.noise is not None and kind is not None:
        scale = kind.scale if source.scale is None else source.scale
        heights += landscape(source.noise, x, z, seed=source.seed, feature=feature) * np.float32(scale)
    return Terrain(heights, cell)


def _heights_of(function: HeightFunction, x: Doubles, z: Doubles, /) -> Floats:
    """Return a function's heights [m] on the grid of columns at `x` and rows at `z` [m], (rows, columns).

    NaN is a hole. Raises `MapError` where the function raises anything, or returns invalid heights.
    """
    heights = np.empty((len(z), len(x)), np.float32)
    for row, column in product(range(0, len(z), SQUARE), range(0, len(x), SQUARE)):
        rows, columns = slice(row, row + SQUARE), slice(column, column + SQUARE)
        heights[rows, columns] = _call(function, *np.meshgrid(x[columns], z[rows]))
    return heights


def _call(function: HeightFunction, x: Doubles, z: Doubles) -> Floats:
    where = f"{function.name}, asked for x from {x[0, 0]:g} to {x[0, -1]:g} and z from {z[0, 0]:g} to {z[-1, 0]:g} m"
    try:
        with np.errstate(all="ignore"):
            given = np.asarray(function.function(x, z))
    except Exception as error:  # a program's own function may raise anything
        raise MapError(None, f"{where}, raised {type(error).__name__}: {' '.join(str(error).split())}") from error
    if given.shape not in (x.shape, ()) or given.dtype.kind not in "fiu":
        raise MapError(
            None, f"{where}, must return {x.shape[0]} by {x.shape[1]} numbers, and returned an array of "
            f"{given.dtype} of shape {given.shape}"
        )  # fmt: skip
    with np.errstate(over="ignore"):  # a height too large for single precision is refused as infinite
        heights = given.astype(np.float32)
    if np.isinf(heights).any():
        raise MapError(None, f"{where}, returned a height that is infinite")
    return np.broadcast_to(heights, x.shape)
