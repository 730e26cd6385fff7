"""A game's floors are visible where grass was taken away, as among every blade in 3D (F4, T1)."""

from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass import Footprint, Pose, Prairie, testing
from tallgrass.engine.camera import Camera
from tallgrass.engine.terrain.plots import SIDE
from tallgrass.systems.mow.mown import Mown
from tallgrass.systems.show.carpet.edges import PARTS, Edges
from tallgrass.systems.show.carpet.holes import Rectangles
from tallgrass.systems.show.carpet.layer import EDGED
from tallgrass.systems.show.carpet.painter import CarpetPainter
from tallgrass.systems.show.carpet.pieces import PIECES
from tallgrass.systems.show.carpet.tiles import TILE
from tallgrass.systems.space.ground import Ground
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

FLAT = (
    LITTLE.replace("noise: rolling", "noise: flat")
    .replace("blades: 60", "blades: 300")
    .replace("models: 2", "models: 1")
)
NEAR, FAR = 16.0, -12.0
"""z of a floor among strips, and of one on the carpet [m]."""

HALF, LIFT = 2.0, 0.05
MAGENTA = 255.0, 0.0, 255.0


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Iterator[Stage]:
    with testing.stage(ctx, (320, 180)) as made:
        yield made


@pytest.fixture(scope="module")
def floor(ctx: moderngl.Context) -> Callable[..., None]:
    """Draw a floor as a game would, with its middle at z, from a camera."""
    made = ctx.program(
        "#version 330\nin vec3 at; uniform mat4 m; void main() { gl_Position = m * vec4(at, 1); }",
        fragment_shader="#version 330\nout vec4 c; void main() { c = vec4(1, 0, 1, 1); }",
    )

    def draw(z: float, matrices: tuple[NDArray[np.float32], NDArray[np.float32]]) -> None:
        corners = [(x * HALF, LIFT, z + y * HALF) for x, y in ((-1, -1), (1, -1), (-1, 1), (1, 1))]
        made["m"].write((matrices[1].astype(float) @ matrices[0]).T.astype("f4").tobytes())  # type: ignore[union-attr]
        ctx.enable_only(moderngl.DEPTH_TEST)
        array = ctx.vertex_array(made, [(ctx.buffer(np.array(corners, "f4").tobytes()), "3f", "at")])
        array.render(moderngl.TRIANGLE_STRIP)
        array.release()

    return draw


def seen_of(room: Stage, floor: Callable[..., None], prairie: Prairie, z: float, aim: Camera) -> tuple[Any, Any]:
    """Return the mask of the floor's pixels, and its visible fraction in each with the prairie: no grass is magenta."""
    matrices = room.matrices(aim)
    room.begin()
    floor(z, matrices)
    due = (room.read() == MAGENTA).all(axis=2)
    prairie.draw(*matrices)
    picture = room.read()
    return due, due * np.clip((picture[..., 0] - picture[..., 1] - 40.0) / 215.0, 0.0, 1.0)


def cut(prairie: Prairie) -> None:
    for z in (NEAR, FAR):
        prairie.cut(
            Footprint(corners=((-HALF, -HALF), (HALF, -HALF), (HALF, HALF), (-HALF, HALF))), 0.0, pose=Pose(0.0, z)
        )


@pytest.fixture(scope="module", params=["cut", pytest.param("map", marks=pytest.mark.slow)])
def built(
    request: pytest.FixtureRequest, load: Load, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Prairie, Prairie]:
    """Pictures of the prairie without grass on two squares: as it is drawn, and with every blade."""
    scene = FLAT
    if request.param == "map":
        x, z = np.meshgrid(np.arange(300) * 0.2 - 29.9, np.arange(300) * 0.2 - 29.9)
        square = (np.abs(x) < HALF) & ((np.abs(z - NEAR) < HALF) | (np.abs(z - FAR) < HALF))
        path = tmp_path_factory.mktemp("map") / "map.png"
        Image.fromarray(np.where(square, 0, 255).astype(np.uint8)).save(path)
        for tip in ("#dcc98f", "#8fae4a"):
            scene = scene.replace(f'tip: "{tip}"', f'tip: "{tip}", place: {{ map: {path} }}')
    found = load(scene), load(scene, lod="blades")
    if request.param == "cut":
        for each in found:
            cut(each)
    return found


@pytest.mark.parametrize(("z", "eye", "pitch"), [(NEAR, 1.7, -6), (NEAR, 6.0, -25), (FAR, 4.0, -6), (FAR, 14.0, -18)])
def test_f4_a_floor_is_seen_as_among_every_blade(
    room: Stage,
    floor: Callable[..., None],
    built: tuple[Prairie, Prairie],
    camera: Aim,
    z: float,
    eye: float,
    pitch: float,
) -> None:
    aim = camera(0.5, eye, 28.0, pitch=pitch, view=30)
    (due, seen), (_, right) = (seen_of(room, floor, prairie, z, aim) for prairie in built)
    assert due.sum() > 100
    assert right.sum() > 0.2 * due.sum()
    assert 0.93 < seen.sum() / right.sum() < 1.1, "a row of cells at its edge, where what is left rises, hides it"


def test_f4_no_depth_is_written_above_the_ground_where_grass_was_cut(
    room: Stage, built: tuple[Prairie, Prairie], camera: Aim
) -> None:
    aim = camera(0.0, 20.0, FAR + 20.0, pitch=-45, view=30)
    room.shot(built[0], aim)
    place, deep = room.ground(aim), room.depth()
    bare = np.abs(place - (0.0, FAR)).max(axis=2) < HALF - 0.8
    view, projection = room.matrices(aim)
    spots = np.column_stack([place[bare][:, 0], np.zeros(bare.sum()), place[bare][:, 1], np.ones(bare.sum())])
    clip = spots @ (projection.astype(float) @ view).T
    due = 0.5 + 0.5 * clip[:, 2] / clip[:, 3]
    assert bare.sum() > 100
    np.testing.assert_allclose(deep[bare], due, atol=2e-5)


HILLS = (
    "\n".join(line for line in LITTLE.splitlines() if not line.startswith("  short"))
    .replace("blades: 60", "blades: 300")
    .replace("scale: 4", "scale: 3")
    .replace("[60, 60]", "[160, 160]")
)
"""Rolling ground with crests near and far."""


@pytest.mark.slow
def test_x5_even_grass_looks_the_same_where_pixels_look_for_its_edges(
    room: Stage, load: Load, camera: Aim, monkeypatch: pytest.MonkeyPatch
) -> None:
    pictures = []
    for looks in (False, True):
        if looks:
            monkeypatch.setattr(Edges, "touch", lambda *told: np.ones_like(sum(told[-1]), np.bool_))
        prairie = load(HILLS)
        prairie.cut(Footprint(radius=150.0), np.inf)  # which cuts nothing
        for x, z, eye, pitch in ((0.0, 40.0, 1.5, 0), (10.0, 60.0, 2.5, 0), (0.0, 70.0, 9.0, -8)):
            high = float(prairie.height_at([(x, z)])[0])
            pictures.append(room.shot(prairie, camera(x, high + eye, z, pitch=pitch, view=30)))
    for even, other in zip(pictures[:3], pictures[3:], strict=True):
        assert (np.abs(other - even).max(axis=2) > 12.0).mean() < 0.02
        assert np.abs((other - even).mean(axis=(0, 1))).max() < 0.15  # no seam between tiles of both sorts
        assert np.abs(other - even).mean() < 1.0  # those that look light their soil, and choose their images, by pixel


def squares(*places: tuple[float, float]) -> Rectangles:
    x, z = np.array(places).T
    return Rectangles(x - 1.0, x + 1.0, z - 1.0, z + 1.0)


def test_edges_are_found_where_density_or_cuts_end_and_nowhere_else(load: Load) -> None:
    prairie = load(FLAT)
    ground, edges = prairie.site.ground, Edges()
    mown = Mown(ground.terrain)
    where = squares((0.0, 25.0), (7.0, 0.0), (-20.0, -20.0))
    assert not edges.touch(ground, mown, 1.0, where).any()
    mown.cut(Footprint(radius=7.0), 0.1, Pose())
    np.testing.assert_array_equal(edges.touch(ground, mown, 1.0, where), [False, True, False])
    mown.cut(Footprint(radius=4.0), 0.1, Pose(-20.0, -24.0))
    np.testing.assert_array_equal(edges.touch(ground, mown, 1.0, where), [False, True, True])
    whole = Mown(ground.terrain)
    whole.cut(Footprint(radius=7.0), np.inf, Pose())  # which cuts nothing
    assert not Edges().touch(ground, whole, 1.0, where).any()
    soft = np.linspace(0.0, 1.0, 60, dtype=np.float32)
    for line, found in ((soft, False), ((soft > 0.5).astype(np.float32), True)):
        density = type(ground.density)(np.broadcast_to(line, (1, 60, 60)).copy(), ground.terrain.size)
        assert Edges().touch(Ground(ground.terrain, density, ground.patch), None, 1.0, where)[0] == found


def test_parts_of_plots_in_which_grass_is_cut_alike_have_no_edge_and_all_others_have(load: Load) -> None:
    prairie, random = load(FLAT), np.random.default_rng(5)
    ground, edges, mown = prairie.site.ground, Edges(), Mown(prairie.site.ground.terrain)
    apart = SIDE / PARTS
    low = np.stack(np.meshgrid(np.arange(-8.0, 8.0), np.arange(-8.0, 8.0)), -1).reshape(-1, 2) * apart
    line = np.linspace(0.02, apart - 0.02, 64)  # about three places in a cell
    places = (low[:, None] + np.stack(np.meshgrid(line, line), -1).reshape(1, -1, 2)).astype(np.float32)
    inside = Rectangles(low[:, 0] + 0.2, low[:, 0] + apart - 0.2, low[:, 1] + 0.2, low[:, 1] + apart - 0.2)
    for _ in range(6):
        x, z = random.uniform(-24.0, 24.0, 2).tolist()
        mown.cut(Footprint(radius=float(random.uniform(0.5, 6.0))), float(random.choice([0.05, 0.2])), Pose(x, z))
        left = np.minimum(mown.at(places.reshape(-1, 2)), 1.0).reshape(len(low), -1)
        found = edges.touch(ground, mown, 1.0, inside)
        uneven = np.ptp(left, axis=1) > 0.1
        assert found[uneven].all()
        assert 0 < found.sum() < 2.5 * uneven.sum() + 8
    prairie.release()


def carpet_of(prairie: Prairie) -> CarpetPainter:
    painter = prairie.painter
    assert painter is not None
    carpet = painter.painters["carpet"]
    assert isinstance(carpet, CarpetPainter)
    return carpet


def test_edges_without_lamps_shades_and_people_take_no_program_that_knows_of_those(
    room: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(FLAT), camera(0.0, 3.0, 20.0, pitch=-10)
    prairie.clear(Footprint(radius=3.0), pose=Pose(4.0, -20.0))
    made = []
    for cuts in (False, True):
        if cuts:
            prairie.cut(Footprint(radius=3.0), 0.05, pose=Pose(-4.0, -20.0))
        room.shot(prairie, aim)
        ground = carpet_of(prairie).ground
        layers = ground.edged_bare, ground.edged_under, ground.edged
        made.append([{name for name, layer in some.items() if layer.made is not None} for some in layers])
    assert made[0] == [{"usual"}, {"untrodden"}, {"uncut"}]
    assert made[1] == [{"usual"}, {"untrodden"}, {"uncut", "cut"}]
    prairie.release()


def test_only_pieces_of_the_ground_at_edges_are_drawn_as_those_and_a_stroke_moves_them(
    room: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(FLAT), camera(0.0, 3.0, 20.0, pitch=-10)

    def dear() -> list[tuple[float, ...]]:
        """Return the places (x, z) [m] of pieces that are drawn as edges need it."""
        room.shot(prairie, aim)
        shelf = carpet_of(prairie).ground.shelves.now
        stream = shelf.streams[EDGED]
        rows = (
            np.frombuffer(stream.buffer.read(stream.count * TILE.itemsize), TILE) if stream.count else np.zeros(0, TILE)
        )
        return [tuple(at) for at in rows["tile"][:, :2] + rows["tile"][:, 2:3] * rows["piece"][:, :2]]

    assert not dear()
    prairie.cut(Footprint(radius=0.7), 0.05, pose=Pose(4.0, -20.0))
    first = dear()
    tiles = len({(x // 10.0, z // 10.0) for x, z in first})
    assert 0 < len(first) < 0.5 * PIECES * tiles
    prairie.clear(Footprint(radius=0.7), pose=Pose(-14.0, -6.0))
    second = dear()
    assert set(first) < set(second)
    assert any(x < -8.0 for x, _ in second)
    assert not any(x < -8.0 for x, _ in first)
    prairie.release()
