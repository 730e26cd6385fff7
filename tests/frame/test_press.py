"""Trodden grass in frames: alike in all representations, and the same whenever it is drawn (F4, N5)."""

from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Pose, Presser
from tallgrass.components.arrays import Floats
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.around.receivers import Receiving
from tallgrass.systems.features import UNITS
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.press.card import PressPart
from tallgrass.testing import LITTLE

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
OnCard = Callable[[Prairie], list[tuple[Receiving, Floats]]]

FLAT = LITTLE.replace("scale: 4", "scale: 0")
CLOSE = 1e-5
"""Tolerance between messages of the graphics card and of numpy, with pressers alone."""


def run(prairie: Prairie, entity: int, *, far: float) -> None:
    """Set the pose of a runner at the prairie's time: it runs to the right, at the distance `far` along -z [m]."""
    esper.add_component(entity, Pose(-6.0 + 2.5 * prairie.time, far, np.pi / 2))


@pytest.fixture
def runners() -> Iterator[list[int]]:
    made = [esper.create_entity(Presser(radius=0.5)) for _ in range(2)]
    yield made
    for entity in made:
        esper.delete_entity(entity, immediate=True)


def told_by_card(ctx: moderngl.Context, prairie: Prairie, place: Floats, kind: int) -> Floats:
    """Return the card's messages of pressers to a kind at places (n, 2), as computed for the carpet's pixels."""
    painter = prairie.painter
    assert painter is not None
    made = painter.air.program("systems/press/press.vert", None, varyings=("lies",))
    made["pressed"] = UNITS["pressed"]
    painter.part(PressPart).use()
    asked = np.column_stack([place, np.full(len(place), kind)]).astype(np.float32)
    source, result = ctx.buffer(asked), ctx.buffer(reserve=8 * len(place))
    array = ctx.vertex_array(made, [(source, "2f 1f", "place", "grass")])
    array.transform(result, moderngl.POINTS, vertices=len(place))
    lies = np.frombuffer(result.read(), np.float32).reshape(-1, 2)
    release_all(array, source, result)
    return lies


def test_f4_blades_strips_and_carpet_are_told_what_a_game_is_told_at_the_same_place(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim, on_card: OnCard, runners: list[int]
) -> None:
    prairie, names = load(LITTLE), ["tall", "short"]
    aim, most = camera(0.0, 6.0, 22.0, pitch=-15), {"blades": 0.0, "strips": 0.0}
    runners.append(esper.create_entity(Presser(radius=0.8), Pose(-3.0, 8.5)))  # it stands where one runs by
    for _ in range(8):
        for entity, far in zip(runners, (18.0, 8.0), strict=False):
            run(prairie, entity, far=far)
        stage.shot(prairie, aim)
        for receiving, texels in on_card(prairie):
            place, kind = receiving.pool.places(receiving.slots).reshape(-1, 2), receiving.pool.kind(receiving.slots)
            for number, name in enumerate(names):
                due, found = (
                    prairie.bent_at(place[kind == number], kind=name),
                    texels.reshape(-1, 4)[kind == number, :2],
                )
                np.testing.assert_allclose(found, due, atol=CLOSE, rtol=0.0)
                most[receiving.representation] = max(
                    most[receiving.representation], float(np.abs(due).max(initial=0.0))
                )
                np.testing.assert_allclose(told_by_card(ctx, prairie, place[kind == number], number), due, atol=CLOSE)
        prairie.advance(0.45)
    assert min(most.values()) > 0.6, "there is something to compare"


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_f4_a_way_shows_on_every_representation_where_it_is_and_nowhere_else(
    stage: Stage, load: Load, camera: Aim, runners: list[int], lod: str
) -> None:
    aim, pictures = camera(0.0, 9.0, 12.0, pitch=-50), []
    ground = np.array([(0.0, 4.0), (0.0, 6.5)])
    for walks in (False, True):
        prairie = load(LITTLE, lod=lod)
        for entity in runners:
            esper.add_component(entity, Pose(0.0, 500.0))
        for _ in range(12):
            if walks:
                run(prairie, runners[0], far=4.0)
            prairie.bent_at([(0.0, 4.0)])
            prairie.advance(0.3)
        pictures.append(stage.shot(prairie, aim))
        high = prairie.height_at(ground)
        prairie.release()
    changed = np.abs(pictures[1] - pictures[0]).max(axis=2)
    feet = np.column_stack([ground[:, 0], high, ground[:, 1]])
    (_, row), (_, below) = stage.project(aim, feet)
    near = changed[int(row) - 8 : int(row) + 3]
    assert (near > 0.02 * pictures[0].max()).mean() > 0.02
    assert changed[int(below) :].max() == 0.0


@pytest.mark.parametrize("lod", ["blades", "strips", "carpet"])
def test_f4_where_somebody_went_away_from_the_eye_grass_is_brighter_than_where_they_came(
    stage: Stage, load: Load, camera: Aim, lod: str
) -> None:
    prairie, aim, ways = load(FLAT, lod=lod), camera(0.0, 4.0, 20.0, pitch=-12, view=40), []
    before = prairie.state()
    for yaw in (0.0, np.pi):
        prairie.restore(before)
        walker = esper.create_entity(Presser(radius=1.5), Pose(0.0, 500.0))
        for far in np.linspace(8.0, -8.0, 33):
            esper.add_component(walker, Pose(0.0, far * np.cos(yaw), yaw))
            prairie.bent_at([(0.0, 0.0)])
            prairie.advance(0.1)
        esper.delete_entity(walker, immediate=True)
        place = np.abs(stage.ground(aim, 0.2))
        ways.append(stage.shot(prairie, aim)[(place[..., 0] < 1.0) & (place[..., 1] < 6.0)].mean())
    assert ways[0] > 1.025 * ways[1]


def test_n3_a_coarse_carpet_stays_one_when_somebody_walks_elsewhere(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load(LITTLE + "  coarse: true\n", lod="carpet")
    aim = camera(0.0, 6.0, 24.0, pitch=-12)
    before = stage.shot(prairie, aim)
    walker = esper.create_entity(Presser(radius=0.2), Pose(0.0, 29.0))  # behind the camera
    prairie.advance(1e-4)
    after = stage.shot(prairie, aim)
    esper.delete_entity(walker, immediate=True)
    assert np.abs(after - before).max() <= 4.0


def test_n5_a_film_that_begins_in_the_middle_shows_the_same_trodden_grass(
    stage: Stage, load: Load, camera: Aim, runners: list[int]
) -> None:
    aim, pictures = camera(0.0, 5.0, 14.0, pitch=-35), []
    for begins in (0, 9):
        prairie = load(LITTLE)
        for frame in range(11):
            for entity, far in zip(runners, (8.0, 4.0), strict=True):
                run(prairie, entity, far=far)
            if frame < begins:
                prairie.follow(*stage.matrices(aim))
            else:
                picture = stage.shot(prairie, aim)
            prairie.advance(0.2)
        pictures.append(picture)
        prairie.release()
    np.testing.assert_array_equal(*pictures)


def test_f4_where_many_walk_who_wear_grass_off_earth_comes_out_and_a_state_keeps_it(
    stage: Stage, load: Load, camera: Aim
) -> None:
    prairie, aim = load(), camera(0.0, 14.0, 0.0, pitch=-90)
    before = prairie.state()
    entity, dense, pictures = esper.create_entity(Presser(radius=0.5, wear=0.05), Pose(-4.0, 0.0)), [], []
    for walked in range(30):
        for step in range(9):
            esper.add_component(entity, Pose((step - 4.0) * (1 if walked % 2 else -1), 0.0))
            prairie.advance(0.1)
            prairie.bent_at([(0.0, 0.0)])
        if walked in (0, 29):
            dense.append(prairie.grass_at([(0.0, 0.0), (0.0, 3.0)]).density.sum(axis=1))
    esper.delete_entity(entity, immediate=True)
    prairie.advance(60.0)
    pictures.append(stage.shot(prairie, aim))
    worn = prairie.state()
    prairie.restore(before)
    pictures.append(stage.shot(prairie, aim))
    prairie.restore(worn)
    np.testing.assert_allclose(prairie.grass_at([(0.0, 0.0)]).density.sum(axis=1), dense[1][:1])
    assert dense[0][0] > 0.85
    assert dense[1][0] < 0.4
    np.testing.assert_allclose(dense[1][1], 1.0, atol=0.01)
    place = stage.ground(aim)
    way = (np.abs(place[..., 0]) < 3.0) & (np.abs(place[..., 1]) < 0.3)
    assert np.abs(pictures[0] - pictures[1])[way].mean() > 5.0


def test_f4_what_a_game_lays_on_trodden_grass_lies_free_on_the_carpet(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim
) -> None:
    meadow = LITTLE.replace("scale: 4", "scale: 0").replace(
        "short: { height: [0.2, 0.4]", "short: { height: [0.5, 0.9]"
    )
    prairie, aim = load(meadow, lod="carpet"), camera(0.0, 6.0, 20.0, pitch=-16)
    corners = np.array([(-2.0, -2.0), (2.0, -2.0), (-2.0, 2.0), (2.0, 2.0)])
    mat = np.insert(corners, 1, prairie.height_at(corners) + 0.08, axis=1).astype(np.float32)
    program = ctx.program(
        vertex_shader="#version 330\nin vec3 at; uniform mat4 clip; void main() { gl_Position = clip * vec4(at, 1); }",
        fragment_shader="#version 330\nout vec4 color; void main() { color = vec4(1.0, 0.0, 1.0, 1.0); }",
    )
    array = ctx.vertex_array(program, [(ctx.buffer(mat), "3f", "at")])
    view, projection = stage.matrices(aim)
    program["clip"] = np.ascontiguousarray((projection.astype(np.float64) @ view).T, np.float32).ravel()
    seen = []
    for presses in (False, True):
        if presses:
            entity = esper.create_entity(Presser(corners=[(-2.5, -2.5), (2.5, -2.5), (2.5, 2.5), (-2.5, 2.5)]), Pose())
            prairie.advance(1.0)
        stage.begin()
        ctx.enable_only(moderngl.DEPTH_TEST)
        array.render(moderngl.TRIANGLE_STRIP)
        due = (stage.read() == (255, 0, 255)).all(axis=2)
        prairie.draw(view, projection)
        seen.append((stage.read() == (255, 0, 255)).all(axis=2)[due].mean())
    esper.delete_entity(entity, immediate=True)
    release_all(array, program)
    assert due.sum() > 50
    assert seen[0] < 0.1
    assert seen[1] > 0.9
