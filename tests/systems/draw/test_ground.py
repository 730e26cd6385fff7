"""The ground: tiles that cover the picture, and meet without cracks (T1, T2)."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from math import pi

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Point
from tallgrass.engine.gl.shaders import program, set_uniform
from tallgrass.engine.gl.stream import release_all
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.rectangle import Rectangle
from tallgrass.engine.terrain.sample import height_at
from tallgrass.systems.frame.block import FrameBlock
from tallgrass.systems.land.heights import Heights
from tallgrass.systems.land.part import density_texture
from tallgrass.systems.light.lie import map_texture
from tallgrass.systems.show.carpet.rims import NOWHERE, Rims
from tallgrass.systems.show.carpet.tiles import (
    GRID,
    TILE,
    bare_within,
    finest_spacing,
    records_of,
    tiles_around,
    which_seen,
)
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
RecordOf = Callable[..., NDArray[np.void]]
Corners = Callable[..., NDArray[np.float32]]

WIDE = Terrain(np.zeros((41, 61), np.float32), 10.0)
MIRRORED = replace(WIDE, mirrored=True)
ALL_ROUND = (0.0, pi)
SPACING = 1.25

eyes = st.tuples(st.floats(-310, 310), st.just(1.7), st.floats(-210, 210))


def tiles_seen(around: NDArray[np.float64], eye: Point, cone: tuple[float, float]) -> NDArray[np.void]:
    """Return the records of those tiles that may be seen."""
    return records_of(around, which_seen(around, eye, cone))


def ground_tiles(terrain: Terrain, eye: Point, cone: tuple[float, float], *, spacing: float) -> NDArray[np.void]:
    """Return the records of the tiles that cover the visible ground."""
    return tiles_seen(tiles_around(terrain, eye[::2], spacing=spacing), eye, cone)


def covering(tiles: NDArray[np.void], place: NDArray[np.float64]) -> NDArray[np.int64]:
    """Count the tiles over each place (n, 2)."""
    low, side = tiles["tile"][:, :2].astype(float), tiles["tile"][:, 2:3] * GRID
    inside = (place[:, None] >= low) & (place[:, None] < low + side)
    return np.asarray(inside.all(axis=2).sum(axis=1))


@pytest.mark.parametrize(("terrain", "beyond"), [(WIDE, 600.0), (MIRRORED, 4000.0)])
@given(eye=eyes)
def test_t1_every_place_of_the_terrain_and_beyond_is_under_one_tile(
    terrain: Terrain, beyond: float, eye: tuple[float, float, float]
) -> None:
    tiles = ground_tiles(terrain, eye, ALL_ROUND, spacing=SPACING)
    place = np.random.default_rng(0).uniform((-300 - beyond, -200 - beyond), (300 + beyond, 200 + beyond), (400, 2))
    assert (covering(tiles, place) == 1).all()


@given(eyes, st.floats(-pi, pi), st.floats(0.1, 1.4))
def test_t2_every_place_in_the_view_cone_is_under_a_tile(
    eye: tuple[float, float, float], middle: float, half: float
) -> None:
    tiles = ground_tiles(WIDE, eye, (middle, half), spacing=SPACING)
    place = np.random.default_rng(0).uniform((-300, -200), (300, 200), (400, 2))
    away = place - (eye[0], eye[2])
    off = np.abs(np.mod(np.arctan2(away[:, 0], -away[:, 1]) - middle + pi, 2 * pi) - pi)
    assert (covering(tiles, place[off < half]) == 1).all()


def test_t2_looking_one_way_needs_far_fewer_tiles() -> None:
    eye = (3.0, 1.7, 4.0)
    everywhere = len(ground_tiles(WIDE, eye, ALL_ROUND, spacing=SPACING))
    assert len(ground_tiles(WIDE, eye, (0.4, 0.5), spacing=SPACING)) < 0.45 * everywhere


@given(eyes)
def test_tiles_are_fine_near_the_viewer_and_coarser_with_distance(eye: tuple[float, float, float]) -> None:
    tiles = ground_tiles(WIDE, eye, ALL_ROUND, spacing=SPACING)["tile"].astype(float)
    low, side = tiles[:, :2], tiles[:, 2:3] * GRID
    here = np.array([eye[0], eye[2]])
    nearest = np.linalg.norm(here - np.clip(here, low, low + side), axis=1)
    assert (tiles[nearest < 20.0, 2] == SPACING).all()
    assert (tiles[:, 2] <= np.maximum(nearest / 20.0, SPACING)).all()


def test_the_finest_tiles_may_come_in_four_that_cover_the_same_ground() -> None:
    eye = (3.0, 1.7, 4.0)
    whole, quartered = (tiles_around(WIDE, (eye[0], eye[2]), spacing=SPACING, quartered=each) for each in (False, True))
    finest = whole[:, 2] == SPACING
    assert len(quartered) == len(whole) + 3 * finest.sum()
    fine = quartered[:, 2] == SPACING / 2
    assert fine.sum() == 4 * finest.sum() > 0
    assert set(quartered[fine, 3]) == set(whole[finest, 3])
    place = np.random.default_rng(0).uniform(-290, 290, (400, 2)) * (1.0, 0.6)
    assert (covering(tiles_seen(quartered, eye, ALL_ROUND), place) == 1).all()


def test_t5_tiles_come_from_far_to_near() -> None:
    eye = (3.0, 1.7, 4.0)
    tiles = ground_tiles(WIDE, eye, ALL_ROUND, spacing=SPACING)["tile"].astype(float)
    middle = tiles[:, :2] + tiles[:, 2:3] * GRID / 2
    assert (np.diff(np.linalg.norm(middle - (eye[0], eye[2]), axis=1)) <= 1e-3).all()


def test_mirrored_ground_takes_half_as_many_tiles_again_though_it_goes_on_seven_times_as_far() -> None:
    counts = [len(ground_tiles(each, (1.0, 1.7, 2.0), (0.4, 0.5), spacing=SPACING)) for each in (WIDE, MIRRORED)]
    assert counts[0] < counts[1] < 1.5 * counts[0]


def test_the_number_of_tiles_hardly_grows_with_the_terrain() -> None:
    counts = [
        len(ground_tiles(Terrain(np.zeros((9, 9), np.float32), size / 8), (1.0, 1.7, 2.0), ALL_ROUND, spacing=SPACING))
        for size in (1000.0, 10000.0)
    ]
    assert counts[1] < 2 * counts[0]


@pytest.mark.parametrize("side", [2.5, 5.0, 0.625])
@pytest.mark.parametrize("patch", [2.5, 5.0])
@pytest.mark.parametrize("reach", [4, -1])
def test_tiles_are_bare_where_none_of_their_patches_has_carpet(patch: float, side: float, reach: int) -> None:
    window, centre = 15, np.array([2, -3], np.int32)
    carpeted = np.zeros((window, window), np.bool_)
    cells = {(0, -3), (2, -6), (6, 1)}
    for x, z in cells:
        carpeted[z % window, x % window] = True
    line = side * np.arange(-round(40 / side), round(40 / side))
    tiles = np.zeros(len(line) ** 2, TILE)
    tiles["tile"][:, :2] = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
    tiles["tile"][:, 2] = side / GRID
    bare = bare_within(tiles, carpeted, centre, patch=patch, reach=reach)
    for (x, z), is_bare in zip(tiles["tile"][:, :2].tolist(), bare.tolist(), strict=True):
        lies_on = [range(int(low // patch), int(-(-(low + side) // patch))) for low in (x, z)]
        patches = {(i, j) for i in lies_on[0] for j in lies_on[1]}
        inside = all(abs(i - 2) <= reach and abs(j + 3) <= reach for i, j in patches)
        assert is_bare == (inside and not patches & cells)


@pytest.mark.parametrize("patch", [0.5, 2.5, 3.7, 20.0])
@pytest.mark.parametrize("cell", [0.05, 0.5, 1.0, 2.5])
def test_t1_the_ground_near_the_viewer_is_as_fine_as_the_terrain_whatever_the_patches_are(
    patch: float, cell: float
) -> None:
    spacing = finest_spacing(Terrain(np.zeros((5, 5), np.float32), cell), patch)
    assert spacing <= min(1.25, max(1.25 * cell, 0.3))
    assert spacing <= patch / 2
    assert np.log2(patch / spacing) % 1.0 == 0.0


@pytest.fixture
def corners(
    ctx: moderngl.Context, laid: Laid, record_of: RecordOf, request: pytest.FixtureRequest
) -> Iterator[Corners]:
    """Return the grid points of tiles (n,) as the graphics card computes them, shape (n, GRID + 1, GRID + 1, 3)."""
    defines: dict[str, str | int] = getattr(request, "param", {})
    site = laid()
    record = record_of(site)
    textures: dict[str, moderngl.Texture | moderngl.TextureArray] = {
        "heights": Heights(ctx, site.ground.terrain).texture,
        "lie": map_texture(ctx, np.full((4, 4, 4), 128, np.uint8)),
        "density": density_texture(ctx, site.ground.density),
        "rims": ctx.texture((1, 1), 1, np.full(1, NOWHERE, np.float32).tobytes(), dtype="f4"),
    }
    made = program(ctx, "systems/show/carpet/ground.vert", None, defines=defines, varyings=("place",))
    block = FrameBlock(ctx)
    block.join(made)
    line = np.arange(GRID + 1, dtype=np.float32)
    grid = ctx.buffer(np.stack(np.meshgrid(line, line), -1).reshape(-1, 2))

    def place(
        tiles: NDArray[np.void], eye: tuple[float, float, float], rims: Rims | None = None, stride: int = 1
    ) -> NDArray[np.float32]:
        set_uniform(made, "stride", float(stride))
        if rims is not None:
            textures["rims"].release()
            textures["rims"] = ctx.texture(rims.distance.shape[::-1], 1, rims.distance.tobytes(), dtype="f4")
            textures["rims"].repeat_x = textures["rims"].repeat_y = False
        record["eye"] = eye
        block.write(record)
        for unit, (name, texture) in enumerate(textures.items()):
            texture.use(unit)
            if name in made:
                made[name] = unit
        points = (GRID + 1) ** 2
        rows, result = ctx.buffer(tiles), ctx.buffer(reserve=12 * points * len(tiles))
        array = ctx.vertex_array(made, [(grid, "2f", "corner"), (rows, "4f 3f/i", "tile", "piece")])
        array.transform(result, moderngl.POINTS, vertices=points, instances=len(tiles))
        found = np.frombuffer(result.read(), np.float32).reshape(len(tiles), GRID + 1, GRID + 1, 3)
        release_all(array, rows, result)
        return found[:, ::stride, ::stride]

    yield place
    release_all(made, grid, block, *textures.values())


def borders(points: NDArray[np.float32]) -> list[NDArray[np.float32]]:
    """Return the four edges of a tile's grid (k, k, 3)."""
    return [points[0], points[-1], points[:, 0], points[:, -1]]


@pytest.mark.parametrize("coarse", [False, True])
@pytest.mark.parametrize(
    ("eye", "off"), [((0.3, 3.0, 0.7), 0.0), ((-31.0, 3.0, 17.0), 0.33), ((7.77, 3.0, -22.2), -0.33)]
)
def test_t1_tiles_of_different_fineness_meet_without_cracks_for_all_who_stand_about_there(
    corners: Corners, hills: Terrain, eye: tuple[float, float, float], off: float, *, coarse: bool
) -> None:
    around = tiles_around(hills, (eye[0] + off, eye[2]), spacing=0.125, about=abs(off), quartered=coarse)
    tiles = tiles_seen(around, eye, ALL_ROUND)
    assert len(set(tiles["tile"][:, 2].tolist())) >= 4
    points = corners(tiles, eye, stride=1 + coarse)
    everything = np.unique(np.round(np.concatenate([np.concatenate(borders(tile)) for tile in points]), 3), axis=0)
    checked = 0
    for tile in points:
        for edge in borders(tile):
            axis = 0 if np.ptp(edge[:, 0]) < 1e-4 else 2
            low, high = edge[:, 2 - axis].min(), edge[:, 2 - axis].max()
            on = np.abs(everything[:, axis] - edge[0, axis]) < 2e-3
            on &= (everything[:, 2 - axis] > low - 1e-3) & (everything[:, 2 - axis] < high + 1e-3)
            mine = np.unique(np.round(edge[:, 2 - axis], 3))
            theirs = np.unique(np.round(everything[on][:, 2 - axis], 3))
            assert all(np.abs(mine - place).min() < 3e-3 for place in theirs)
            checked += len(theirs)
    assert checked > 3000


@pytest.fixture(scope="module")
def cliff(hills: Terrain) -> Rims:
    """Return the hills' distances to a rim that crosses them."""
    x, z = ((np.arange(60) + 0.5) * side / 60 - side / 2 for side in hills.size)
    rims = Rims(hills)
    rims.distance = np.maximum(np.abs(z[:, None] - 0.3 * x - 4.0) / 1.05 - 1.0, 0.0).astype(np.float32)
    rims.version = 1
    return rims


@pytest.mark.parametrize("quartered", [False, True])
@pytest.mark.parametrize("eye", [(0.3, 3.0, 0.7), (-31.0, 3.0, 17.0), (7.77, 3.0, -22.2)])
def test_t1_tiles_meet_without_cracks_at_rims_of_cliffs_where_they_are_finer(
    corners: Corners, hills: Terrain, cliff: Rims, eye: tuple[float, float, float], *, quartered: bool
) -> None:
    spacing = 2.5
    around = tiles_around(hills, (eye[0], eye[2]), spacing=spacing, rims=cliff, quartered=quartered)
    tiles = tiles_seen(around, eye, ALL_ROUND)
    assert tiles["tile"][:, 2].min() <= hills.cell < spacing
    assert len(tiles) < 4 * len(ground_tiles(hills, eye, ALL_ROUND, spacing=spacing))
    ways: dict[tuple[tuple[float, ...], ...], int] = {}
    for tile in corners(tiles, eye, cliff, 1 + quartered):
        for edge in borders(tile):
            at = np.round(edge[:, ::2].astype(float), 2) + 0.0
            for one, other in zip(map(tuple, at), map(tuple, at[1:]), strict=False):
                if one != other:
                    way = (min(one, other), max(one, other))
                    ways[way] = ways.get(way, 0) + 1
    inside = [count for way, count in ways.items() if np.abs(np.array(way)).max() < hills.size[0] / 2]
    assert len(inside) > 500
    assert set(inside) == {2}, "each stretch of a border is one of both tiles"


def test_rims_are_found_where_the_ground_breaks_off_and_nowhere_else() -> None:
    z, x = np.meshgrid(np.arange(101.0), np.arange(101.0), indexing="ij")
    for heights, found in ((5.0 * np.sin(z / 15.0), False), (np.clip(60.0 - z, 0.0, 12.0) + 0.0 * x, True)):
        rims = Rims(Terrain(heights.astype(np.float32), 1.0))
        assert rims.any == found
    away = rims.mesh_distance(np.array([(0.0, z - 50.0) for z in (48.0, 60.0, 90.0)]), np.zeros(2))
    assert away[0] < 2.0
    assert away[2] > away[1] > away[0]
    terrain = Terrain(np.zeros((101, 101), np.float32), 1.0)
    flat = Rims(terrain)
    terrain.put(Rectangle(40, 40, 10, 10), np.full((10, 10), 5.0, np.float32), np.zeros((10, 10), np.bool_))
    flat.follow()
    assert flat.any


def test_rims_that_a_game_makes_and_takes_away_are_those_of_the_ground_as_it_is() -> None:
    random = np.random.default_rng(3)
    terrain = Terrain(np.zeros((300, 290), np.float32), 1.0)
    followed = Rims(terrain)
    for height in (3.0, 0.0, 5.0, 0.0, 0.0):
        row, column = random.integers(0, 280, 2).tolist()
        part = Rectangle(row, column, 10, 10) if height else Rectangle(0, 0, 300, 145)
        shape = part.rows, part.columns
        terrain.put(part, np.full(shape, height, np.float32), np.zeros(shape, np.bool_))
        followed.follow()
        found = Rims(terrain)
        np.testing.assert_array_equal(followed.distance, found.distance)
        assert followed.any == found.any


def test_t1_the_points_of_the_ground_lie_on_the_terrain_and_beyond_it_as_high_as_its_edge(
    corners: Corners, hills: Terrain
) -> None:
    eye = (0.3, 3.0, 0.7)
    points = corners(ground_tiles(hills, eye, ALL_ROUND, spacing=SPACING), eye).reshape(-1, 3)
    np.testing.assert_allclose(points[:, 1], height_at(hills, np.ascontiguousarray(points[:, ::2])), atol=1e-4)
    half = np.array(hills.size) / 2
    outermost = np.abs(points[:, ::2]).max(axis=0)
    assert (outermost >= half + hills.beyond).all()


@pytest.mark.parametrize("corners", [{"MIRRORED": 1}], indirect=True)
def test_t1_the_points_of_mirrored_ground_lie_where_heights_are_asked_for(corners: Corners, hills: Terrain) -> None:
    eye, ground = (0.3, 3.0, 0.7), replace(hills, mirrored=True)
    points = corners(ground_tiles(ground, eye, ALL_ROUND, spacing=SPACING), eye).reshape(-1, 3)
    assert (np.abs(points[:, ::2]).max(axis=0) >= 4000.0).all()
    # Single precision knows places 4 km off to a quarter of a millimetre.
    np.testing.assert_allclose(points[:, 1], height_at(ground, np.ascontiguousarray(points[:, ::2])), atol=2e-3)
