"""Parts of a picture: what a game draws by itself, and grass over its own ground (D6, T1)."""

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Footprint, testing
from tallgrass.engine.camera import Camera, view_of
from tallgrass.engine.declared.parts import as_parts
from tallgrass.engine.schedule import Phase
from tallgrass.systems.around.asked import Asked
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Picture = NDArray[np.float64]

STILL = LITTLE + "light: { elevation: 40 }\n"
LOW = STILL.replace("[0.2, 0.4]", "[0.12, 0.2]").replace("[0.5, 0.9]", "[0.15, 0.25]").replace("s: 60\n", "s: 600\n")
"""Dense grass, hardly higher than a game's own ground may be above the prairie's."""

SKY = 0.2, 0.4, 0.6
"""Colour with which a game clears its framebuffer."""

EARTH = np.array([255.0, 0.0, 255.0])
"""Colour of a game's own ground, which no grass has."""

VERTEX = """#version 330
in vec3 at;
uniform mat4 clip;
void main() { gl_Position = clip * vec4(at, 1.0); }"""
FRAGMENT = """#version 330
out vec4 pixel;
void main() { pixel = vec4(1.0, 0.0, 1.0, 1.0); }"""

Mesh = Callable[[Prairie, float, float], moderngl.VertexArray]


@pytest.fixture
def mesh(ctx: moderngl.Context) -> Iterator[Mesh]:
    """Return the function that makes a game's own ground, of cells of a width [m], at a height above the prairie's."""
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    made: list[Any] = [program]

    def ground(prairie: Prairie, cell: float, higher: float) -> moderngl.VertexArray:
        half = prairie.site.ground.terrain.size[0] / 2
        line = np.arange(-half, half + 1e-3, cell, dtype=np.float32)
        place = np.stack(np.meshgrid(line, line), -1).reshape(-1, 2)
        corners = np.column_stack([place[:, 0], prairie.height_at(place) + higher, place[:, 1]])
        first = (np.arange(len(line) - 1)[:, None] * len(line) + np.arange(len(line) - 1)).reshape(-1, 1)
        indices = first + np.array([0, len(line), 1, 1, len(line), len(line) + 1])
        buffers = ctx.buffer(corners.astype(np.float32)), ctx.buffer(indices.astype(np.int32))
        array = ctx.vertex_array(program, [(buffers[0], "3f", "at")], index_buffer=buffers[1])
        made.extend([*buffers, array])
        return array

    yield ground
    for each in reversed(made):
        each.release()


def drawn(stage: Stage, prairie: Prairie, camera: Camera, *draws: Sequence[str] | None) -> Picture:
    """Return the picture of parts of a prairie, drawn in turn into a framebuffer that a game has cleared."""
    stage.target.use()
    stage.target.clear(*SKY, depth=1.0)
    for parts in draws:
        prairie.draw(*stage.matrices(camera), parts=parts)
    return np.asarray(stage.read())


def over(
    stage: Stage,
    prairie: Prairie,
    camera: Camera,
    ground: moderngl.VertexArray,
    sky: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Picture:
    """Return the visible fraction of a game's own ground in each pixel, 0 to 1; NaN beside it."""
    view, projection = stage.matrices(camera)
    ground.program["clip"] = (projection.astype(float) @ view).T.reshape(16).tolist()

    def lay() -> Picture:
        stage.target.use()
        stage.target.clear(*sky, depth=1.0)
        stage.ctx.enable_only(moderngl.DEPTH_TEST)
        ground.render()
        return np.asarray(stage.read())

    where = (lay() == EARTH).all(axis=-1)
    prairie.draw(view, projection, parts=("grass",))
    seen = stage.read()
    return np.where(where, np.clip((0.5 * (seen[..., 0] + seen[..., 2]) - seen[..., 1]) / 255.0, 0.0, 1.0), np.nan)


@pytest.mark.parametrize(
    "draws",
    [
        [("ground", "beyond"), ("sky",), ("grass", "beyond")],
        [("sky", "ground", "beyond"), ("grass", "beyond")],
    ],
)
@pytest.mark.parametrize("height", [1.7, 25.0])
def test_parts_drawn_in_turn_are_the_whole_bit_for_bit(
    stage: Stage, load: Load, camera: Aim, draws: list[Sequence[str]], height: float
) -> None:
    prairie, aim = load(STILL), camera(0.0, height, 25.0, pitch=-10)
    whole = drawn(stage, prairie, aim, None)
    np.testing.assert_array_equal(drawn(stage, prairie, aim, *draws), whole)
    assert len(np.unique(whole.reshape(-1, 3), axis=0)) > 1000
    without = drawn(stage, prairie, aim, *draws[:-1])
    assert (without != whole).any(axis=-1).mean() > 0.2


def test_a_frame_that_is_drawn_in_parts_is_one_frame(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim, seen = load(STILL), camera(0.0, 1.7, 25.0), []
    prairie.systems.add(Phase.SEE, "see twice", lambda: seen.append(prairie.time))
    for _ in range(3):
        prairie.advance(0.5)
        drawn(stage, prairie, aim, ("ground",), ("sky",), ("grass",))
    assert seen == [0.5, 1.0, 1.5]
    drawn(stage, prairie, aim, ("ground",), ("ground",))  # what comes again is another frame's
    assert len(seen) == 5


def test_without_the_sky_nothing_is_written_where_nothing_is(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(STILL)
    prairie.shine(haze=30.0)
    aim = camera(0.0, 1.0, 20.0, pitch=6)
    whole, own = drawn(stage, prairie, aim, None), drawn(stage, prairie, aim, ("ground", "grass", "beyond"))
    cleared = np.round(np.array(SKY) * 255.0)
    beside = (drawn(stage, prairie, aim, ("ground", "grass", "beyond")) == cleared).all(axis=-1)
    assert 0.2 < beside.mean() < 0.9
    assert (own[beside] == cleared).all()
    np.testing.assert_array_equal(own[60:], whole[60:])  # below the horizon it is the same picture
    assert (whole[beside] != cleared).any(axis=-1).all()


@pytest.mark.parametrize(("lod", "height", "left"), [("carpet", 1.7, 0.05), ("carpet", 8.0, 0.05), ("auto", 6.0, 1.0)])
def test_grass_over_a_games_own_ground_is_neither_cut_by_it_nor_hidden(
    stage: Stage, load: Load, camera: Aim, mesh: Mesh, lod: str, height: float, left: float
) -> None:
    prairie = load(LOW, lod=lod)
    prairie.cut(Footprint(radius=60.0), left)
    aim = camera(0.0, height + float(prairie.height_at([(0.0, 25.0)])[0]), 25.0, pitch=-12)
    exact = over(stage, prairie, aim, mesh(prairie, 0.5, 0.0))
    assert 0.1 < np.nanmean(exact) < 0.9
    for cell, higher in ((0.5, 0.1), (0.5, -0.1), (5.0, 0.0)):
        other = over(stage, prairie, aim, mesh(prairie, cell, higher))
        both = ~np.isnan(exact) & ~np.isnan(other)
        assert abs(np.mean(exact[both] - other[both])) < (0.02 if lod == "carpet" else 0.15), (cell, higher)


@pytest.mark.parametrize("preset", ["medium", pytest.param("high", marks=pytest.mark.slow)])
def test_where_strips_give_way_to_the_carpet_no_line_of_a_games_own_ground_shows(
    ctx: moderngl.Context, load: Load, camera: Aim, mesh: Mesh, preset: str
) -> None:
    thin = "tallgrass: 2\nseed: 5\nterrain: { noise: flat, size: [200, 200] }\n"
    thin += "grass: { thin: { height: [0.2, 0.4] } }\n"
    prairie = load(thin, preset=preset)
    with testing.stage(ctx, (96, 270)) as tall:
        ground = over(tall, prairie, camera(0.0, 2.2, 19.0, pitch=-20), mesh(prairie, 5.0, 0.0))
    rows = np.nanmean(ground[24:110], axis=1)
    about = np.array([np.median(rows[max(row - 9, 0) : row + 10]) for row in range(len(rows))])
    assert about[0] < 0.1
    assert about[-1] > 0.3
    assert (rows - about).max() < 0.12, "without strips' feet the carpet alone covers half as much"


def test_x5_no_sky_shows_between_grass_on_a_crest_and_a_games_own_ground_a_little_lower(
    ctx: moderngl.Context, load: Load, camera: Aim, mesh: Mesh
) -> None:
    prairie = load("hills", preset="low", lod="carpet")
    x, z = prairie.scene.camera.position
    aim = camera(x, 1.7 + float(prairie.height_at([(x, z)])[0]), z, pitch=-4)
    with testing.stage(ctx, (480, 270)) as large:
        over(large, prairie, aim, mesh(prairie, 1.0, -0.1), sky=(0.0, 1.0, 1.0))
        red, green, blue = np.moveaxis(large.read(), -1, 0)
    sky = np.clip((green + blue) / 2.0 - red, 0.0, 255.0) / 255.0
    above = np.roll(np.maximum.accumulate(sky < 0.3, axis=0), 2, axis=0)
    above[:3] = False
    assert (sky == 1.0).mean() > 0.1
    assert (sky[above] > 0.3).sum() < 18, "three times as many where grass counts on ground as high as its own"
    assert sky[above].sum() < 18.0


def test_the_carpet_thins_out_toward_the_rim_of_ground_that_nothing_is_beyond(stage: Stage, load: Load) -> None:
    prairie = load(STILL.replace("rolling, seed: 2", "flat").replace(", feature: 30, scale: 4", ""), lod="carpet")
    aim = Camera((0.0, 8.0, 15.0), 0.0, -0.167, 0.105)
    stage.target.use()
    stage.target.clear(0.0, 0.0, 1.0, depth=1.0)
    prairie.draw(*stage.matrices(aim), parts=("grass",))
    cover = 1.0 - stage.read()[..., 2].mean(axis=1) / 255.0
    first = int(np.argmax(cover > 0.002))
    assert 20 < first < 60
    assert cover[first + 20 :].min() > 0.08
    assert np.diff(cover[first - 1 : first + 10]).max() < 0.04


def test_no_ground_of_ours_is_seen_where_a_game_draws_its_own(
    stage: Stage, load: Load, camera: Aim, mesh: Mesh
) -> None:
    prairie = load(STILL.replace("seed: 5\n", "seed: 5\nparts: [grass]\n"))
    prairie.shine(ground="#00ff00")
    aim = camera(0.0, 4.0, 25.0, pitch=-15)
    view, projection = stage.matrices(aim)
    ground = mesh(prairie, 0.5, 0.0)
    pictures = []
    for color in ("#00ff00", "#ff0000"):
        prairie.shine(ground=color)
        over(stage, prairie, aim, ground)
        pictures.append(stage.read())
    np.testing.assert_array_equal(*pictures)
    stage.begin()
    prairie.draw(view, projection)  # a scene's own parts are those that are drawn
    assert (stage.depth() == 1.0).mean() > 0.2


def test_the_ground_ends_with_the_terrain_where_nothing_beyond_is_asked_for(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(STILL), camera(0.0, 30.0, 60.0, pitch=-30)
    drawn(stage, prairie, aim, ("ground",))
    where = stage.ground(aim)
    ends = np.abs(where).max(axis=-1)  # hills rise 4 m: they hide, and show, a few metres more
    depth = stage.depth()
    assert (depth[ends > 40.0] == 1.0).all()
    assert (depth[ends < 22.0] < 1.0).all()
    drawn(stage, prairie, aim, ("ground", "beyond"))
    assert (stage.depth()[ends > 40.0] < 1.0).all()


@pytest.mark.parametrize(
    ("parts", "error", "said"),
    [
        (("gras",), ValueError, r"no part of a prairie is called 'gras', did you mean 'grass'\?"),
        ((3,), ValueError, "no part of a prairie is called 3; known: beyond, grass, ground, sky"),
        ("grass", TypeError, r"parts are given as a list of names such as \('ground', 'grass'\), unlike 'grass'"),
        (7, TypeError, "parts are given as a list of names"),
    ],
)
def test_parts_that_are_none_are_told_before_anything_is_drawn(
    stage: Stage, load: Load, camera: Aim, parts: Any, error: type[Exception], said: str
) -> None:
    prairie = load(STILL)
    stage.begin()
    with pytest.raises(error, match=said):
        prairie.draw(*stage.matrices(camera(0.0, 1.7, 20.0)), parts=parts)
    with pytest.raises(error, match=said):
        prairie.group(None, lambda: stage.matrices(camera(0.0, 1.7, 20.0)), parts=parts)  # type: ignore[arg-type]
    assert not stage.read().any()
    assert prairie.painter is None


def test_far_ground_fades_into_the_haze_that_a_game_gives(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(STILL)
    prairie.shine(haze=10.0)
    eye = prairie.height_at([(0.0, 0.0)])[0] + 30.0
    north, east = (camera(0.0, float(eye), 0.0, yaw=yaw, pitch=-12) for yaw in (0.0, 90.0))
    before = drawn(stage, prairie, north, None)
    colours = []

    def around(toward: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.where(toward[:, :1] > 0.5, (0.1, 0.6, 0.3), (0.8, 0.2, 0.4))

    for haze in ((0.8, 0.2, 0.4), "#cc3366", around):
        prairie.haze = haze
        assert prairie.haze is haze
        colours.append([drawn(stage, prairie, aim, ("ground", "grass", "beyond"))[45, 80] for aim in (north, east)])
    red, green = np.array((204.0, 51.0, 102.0)), np.array((26.0, 153.0, 76.0))
    for seen in colours[:2]:
        np.testing.assert_allclose(seen, [red, red], atol=12.0)
    assert np.abs(colours[2][0] - red).max() < 50.0
    assert np.abs(colours[2][1] - red).max() > 60.0
    assert np.abs(colours[2][1] - green).max() < 50.0
    prairie.haze = None
    np.testing.assert_array_equal(drawn(stage, prairie, north, None), before)


@pytest.mark.parametrize("haze", [None, lambda toward: np.where(toward[:, :1] > 0.5, (0.1, 0.6, 0.3), (0.8, 0.2, 0.4))])
@pytest.mark.parametrize("x", [0.0, 5000.0], ids=["the ground's", "the sky's"])
def test_haze_has_no_seam_straight_below(stage: Stage, load: Load, camera: Aim, haze: Any, x: float) -> None:
    """As from an airship, or on a strategy game's map; beyond the terrain, the sky goes on below its horizon."""
    prairie = load(STILL)
    prairie.shine(haze=10.0, azimuth=70.0, elevation=20.0)
    prairie.haze = haze
    seen = drawn(stage, prairie, camera(x, 300.0, 0.0, pitch=-90), None)
    assert np.ptp(seen[41:49, 76:84], axis=(0, 1)).max() < 10.0


@pytest.mark.parametrize(
    "haze", ["greyish", (0.1, 0.2), (0.1, -1.0, 0.0), lambda toward: toward[:, 0], (np.nan, 0.0, 0.0)]
)
def test_haze_without_a_colour_is_refused_in_a_sentence(load: Load, haze: Any) -> None:
    prairie = load(STILL)
    with pytest.raises(ValueError, match=r"^haze has a colour"):
        prairie.haze = haze
    assert prairie.haze is None


def test_outlines_are_no_broader_where_fewer_pixels_are_drawn_and_no_sky(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim, parts = load(STILL), camera(0.0, 1.0, 20.0, pitch=6), as_parts(["ground", "grass", "beyond"])
    drawn(stage, prairie, aim, list(parts))
    assert prairie.painter is not None
    view, shares = view_of(*stage.matrices(aim)), []
    for scale in (1.0, 0.5):
        stage.target.use()
        stage.target.clear(1.0, 0.0, 1.0, depth=1.0)
        prairie.painter.draw(view, Asked(parts), scale=scale)
        seen = stage.read()
        shares.append(np.clip((0.5 * (seen[..., 0] + seen[..., 2]) - seen[..., 1]) / 255.0, 0.0, 1.0).mean())
    assert 0.2 < shares[0] < 0.9
    assert shares[1] == pytest.approx(shares[0], rel=0.02)
