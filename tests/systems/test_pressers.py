"""A game's pressers: entities with a footprint and a pose, and the effect on `bent_at` (F4)."""

from collections.abc import Callable, Iterator
from math import ceil, floor
from pathlib import Path
from time import process_time

import esper
import numpy as np
import pytest

from tallgrass import Pose, Presser, Receivers
from tallgrass.engine.schedule import Phase
from tallgrass.engine.world import World
from tallgrass.systems import pressers as pressers_module
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.pressers import RATE
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import LITTLE, little_prairie, step, watch

AROUND = np.stack(np.meshgrid(np.linspace(-3.0, 3.0, 25), np.linspace(-1.0, 1.0, 9)), -1).reshape(-1, 2)

RUN = """
import sys
import esper, numpy as np
from tallgrass import Pose, Presser
from tallgrass.testing import little_prairie
steps = int(sys.argv[1])
place = np.stack(np.meshgrid(np.linspace(-3.0, 3.0, 25), np.linspace(-1.0, 1.0, 9)), -1).reshape(-1, 2)
with little_prairie() as prairie:
    runner, cow = (esper.create_entity(Presser(radius=0.4, length=long)) for long in (0.0, 1.5))
    for number in range(steps + 1):
        prairie.advance(4.0 / steps if number else 0.0)
        esper.add_component(runner, Pose(-4.0 + 3.0 * prairie.time, 0.2))
        esper.add_component(cow, Pose(4.0 - 1.2 * prairie.time, -0.4, 1.5))
        prairie.bent_at(place[:1])
    np.save(sys.argv[2], prairie.bent_at(place))
"""


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world  # it is made the current one
    with little_prairie() as made:
        yield made


def walk(prairie: Prairie, entity: int, until: float, *, steps: int = 30) -> None:
    """Walk to +x along z = 0, from x = -3 at time 0 on, 1.5 m each second."""
    begun = prairie.time
    for _ in range(steps):
        prairie.advance((until - begun) / steps)
        esper.add_component(entity, Pose(-3.0 + 1.5 * prairie.time, 0.0, np.pi / 2))
        prairie.bent_at([(0.0, 0.0)])


def test_f4_without_pressers_grass_is_bent_as_the_wind_bends_it(prairie: Prairie) -> None:
    prairie.add(Breeze(strength=0.4))
    prairie.advance(1.0)
    np.testing.assert_array_equal(prairie.bent_at(AROUND), prairie.wind_at(AROUND))


def test_f4_a_game_moves_a_presser_by_its_pose_and_is_told_how_grass_is_bent(prairie: Prairie) -> None:
    walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, 0.0))
    walk(prairie, walker, 2.0)
    bent = prairie.bent_at([(0.0, 0.0), (0.0, 0.45), (2.0, 0.0)], kind="tall")
    assert bent[0, 0] > 0.95
    assert bent[1, 1] > 0.25
    assert np.abs(bent[2]).max() == 0.0
    assert np.abs(prairie.wind_at(AROUND)).max() == 0.0


def test_f4_kinds_stand_up_again_each_in_its_own_time(world: World) -> None:
    del world
    with little_prairie(scene=LITTLE.replace("stiffness: 2 }", "stiffness: 2, recovery: 2 }")) as prairie:
        walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, 0.0))
        walk(prairie, walker, 8.0)
        tall, short = (np.linalg.norm(prairie.bent_at([(0.0, 0.0)], kind=kind)) for kind in ("tall", "short"))
    assert tall > 0.3
    assert short < 0.02


def test_f4_who_is_taken_away_lets_go_of_the_grass_and_leaves_a_way(prairie: Prairie) -> None:
    walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, 0.0))
    walk(prairie, walker, 2.0)
    held = float(np.linalg.norm(prairie.bent_at([(0.0, 0.4)])))
    esper.delete_entity(walker, immediate=True)
    prairie.advance(0.5)
    left = prairie.bent_at([(0.0, 0.4), (-1.0, 0.0)])
    assert np.linalg.norm(left[0]) < 0.7 * held
    assert np.linalg.norm(left[1]) > 0.5


def test_f4_to_ask_again_or_to_draw_in_the_same_frame_changes_nothing(prairie: Prairie) -> None:
    walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, 0.0))
    walk(prairie, walker, 2.0)
    once = prairie.bent_at(AROUND)
    watch(prairie)
    np.testing.assert_array_equal(prairie.bent_at(AROUND), once)


def test_f4_what_a_game_reads_of_receivers_is_what_it_is_told_at_their_places(prairie: Prairie) -> None:
    walker = esper.create_entity(Presser(radius=0.6), Pose(0.0, 17.0))
    watch(prairie)
    esper.add_component(walker, Pose(0.6, 17.0))
    prairie.advance(0.3)
    watch(prairie)
    step(prairie, Phase.BLOW)
    bent = 0.0
    for _, receivers in esper.get_component(Receivers):
        if receivers.representation == "blades":
            kind = receivers.kind
            for number, name in enumerate(prairie.scene.grass):
                due = prairie.bent_at(receivers.place[kind == number], kind=name)
                np.testing.assert_array_equal(receivers.message[kind == number], due)
                bent = max(bent, float(np.abs(due).max(initial=0.0)))
    assert bent > 0.8


def test_f4_two_processes_with_different_steps_tread_the_same(tmp_path: Path, python: Callable[..., str]) -> None:
    (tmp_path / "program.py").write_text(RUN, "utf-8")
    found = []
    for steps in (50, 240):
        python(tmp_path, "program.py", str(steps), f"{steps}.npy", place={})
        found.append(np.load(tmp_path / f"{steps}.npy"))
    assert np.linalg.norm(found[0], axis=1).max() > 0.9
    np.testing.assert_allclose(found[0], found[1], atol=1e-4)


def test_f4_a_hundred_pressers_cost_less_than_a_millisecond(prairie: Prairie) -> None:
    rng = np.random.default_rng(1)
    place, yaw = rng.uniform(-25.0, 25.0, (100, 2)), rng.uniform(0.0, 6.3, 100)
    way = 1.5 / 60 * np.stack([np.sin(yaw), -np.cos(yaw)], axis=1)
    entities, spent = [esper.create_entity(Presser()) for _ in place], []
    for _ in range(300):
        place += way
        for entity, (x, z), turned in zip(entities, place.tolist(), yaw.tolist(), strict=True):
            esper.add_component(entity, Pose(x, z, turned))
        prairie.advance(1 / 60)
        begun = process_time()
        prairie.pressers.note(prairie.time)
        spent.append(process_time() - begun)
    assert len(prairie.pressers.trodden.settled.marks) > 1000
    assert np.median(spent) < 1e-3


def test_f4_a_polygon_presses_where_its_corners_are_turned_to(prairie: Prairie) -> None:
    long = ((-0.4, -2.0), (0.4, -2.0), (0.4, 2.0), (-0.4, 2.0))
    esper.create_entity(Presser(corners=long), Pose(0.0, 0.0, np.pi / 2))
    ahead, beside = np.linalg.norm(prairie.bent_at([(1.6, 0.05), (0.0, 1.6)]), axis=1)
    assert ahead > 0.6
    assert beside == 0.0


WALKED = """\
pressers:
  - radius: 0.4
    path:
      - { at: 0, position: [-3, 0] }
      - { at: 1, position: [0, 0.6] }
      - { at: 3, position: [3, -0.4] }
  - { radius: 0.3, length: 1, position: [-1, 0.7], yaw: 30, strength: 0.8 }
"""


def test_f4_who_a_scene_declares_treads_where_its_path_leads(world: World) -> None:
    del world
    with little_prairie(scene=LITTLE + WALKED) as prairie:
        prairie.advance(2.0)
        bent = np.linalg.norm(prairie.bent_at([(-3.0, 0.0), (0.0, 0.6), (3.0, -0.4), (-1.0, 0.7)]), axis=1)
        assert len(esper.get_component(Presser)) == 2
    assert bent[[0, 1, 3]].min() > 0.4
    assert bent[2] == 0.0


@pytest.mark.parametrize("steps", [[0.7, 0.7, 0.9], [0.01] * 230, [0.25] * 9 + [0.05]])
def test_n5_what_a_scene_declares_treads_the_same_whenever_it_is_looked_at(world: World, steps: list[float]) -> None:
    del world
    found = []
    for each in ([2.3], steps):
        with little_prairie(scene=LITTLE + WALKED) as prairie:
            for step_on in each:
                prairie.advance(step_on)
                prairie.bent_at(AROUND[:1])
            assert prairie.time == pytest.approx(2.3)
            found.append(prairie.bent_at(AROUND))
    assert np.linalg.norm(found[0], axis=1).max() > 0.9
    np.testing.assert_allclose(found[0], found[1], atol=1e-6)


def test_f4_a_game_walks_beside_those_that_a_scene_declares(world: World) -> None:
    del world
    bent = []
    for scene in (LITTLE, LITTLE + WALKED.replace("[-3, 0]", "[-3, 20]").replace("[0, 0.6]", "[0, 20]")):
        with little_prairie(scene=scene) as prairie:
            walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, -8.0))
            for step_on in (0.4, 0.3, 0.5):
                prairie.advance(step_on)
                esper.add_component(walker, Pose(-3.0 + 1.5 * prairie.time, -8.0, 6.2 - 6.0 * prairie.time))
                prairie.bent_at(AROUND[:1])
            bent.append(prairie.bent_at(AROUND + np.array([0.0, -8.0])))
            esper.delete_entity(walker, immediate=True)
    np.testing.assert_allclose(bent[0], bent[1], atol=1e-6)


def test_n7_a_scene_read_again_keeps_who_stays_and_lets_go_who_is_gone(
    world: World, tmp_path_factory: pytest.TempPathFactory
) -> None:
    del world
    path = tmp_path_factory.mktemp("walked") / "scene.yaml"
    path.write_text(LITTLE + WALKED, "utf-8")
    prairie = Prairie.load(path)
    try:
        prairie.advance(1.0)
        prairie.bent_at(AROUND)
        first, second = sorted(entity for entity, _ in esper.get_component(Presser))
        path.write_text(LITTLE + WALKED.replace("strength: 0.8", "strength: 0.5"), "utf-8")
        prairie.reload()
        left = {entity for entity, _ in esper.get_component(Presser)}
        assert first in left
        assert second not in left
        assert len(left) == 2
    finally:
        prairie.release()
    assert not esper.get_component(Presser)


@pytest.mark.parametrize("change", ["comes", "goes", "grows"])
def test_n5_what_a_scene_declares_treads_does_not_depend_on_who_else_comes_or_goes(world: World, change: str) -> None:
    del world
    found = []
    for is_changed in (False, True):
        with little_prairie(scene=LITTLE + WALKED) as prairie:
            other = esper.create_entity(Presser(), Pose(30.0, 30.0))
            prairie.bent_at(AROUND[:1])
            prairie.advance(2.3)
            if is_changed and change == "comes":
                esper.create_entity(Presser(), Pose(-30.0, 30.0))
            elif is_changed and change == "goes":
                esper.delete_entity(other, immediate=True)
            elif is_changed:
                esper.add_component(other, Presser(radius=0.6))
            found.append(prairie.bent_at(AROUND))
            esper.clear_database()
    assert np.linalg.norm(found[0], axis=1).max() > 0.9
    np.testing.assert_array_equal(found[0], found[1])


@pytest.mark.parametrize("text", [WALKED, "", WALKED.replace("[0, 0.6]", "[0, -0.6]")], ids=["come", "gone", "moved"])
@pytest.mark.parametrize("before", ["", WALKED], ids=["nobody", "walked"])
def test_n7_those_of_a_scene_read_again_have_trodden_what_they_have_in_one_that_is_loaded(
    world: World, tmp_path_factory: pytest.TempPathFactory, before: str, text: str
) -> None:
    del world
    path = tmp_path_factory.mktemp("walked") / "scene.yaml"
    found = []
    for first in (text, before):
        path.write_text(LITTLE + first, "utf-8")
        prairie = Prairie.load(path)
        try:
            walker = esper.create_entity(Presser(radius=0.4), Pose(-3.0, -8.0))
            for _ in range(23):
                prairie.advance(0.1)
                esper.add_component(walker, Pose(-3.0 + 1.5 * prairie.time, -8.0))
                prairie.bent_at(AROUND)
            path.write_text(LITTLE + text, "utf-8")
            prairie.reload()
            found.append(prairie.bent_at(np.concatenate([AROUND, AROUND + np.array([0.0, -8.0])])))
            assert np.linalg.norm(found[-1][len(AROUND) :], axis=1).max() > 0.9, "what a game's own trod stays"
            esper.delete_entity(walker, immediate=True)
        finally:
            prairie.release()
    np.testing.assert_allclose(found[0], found[1], atol=1e-6)


def test_n5_instants_at_which_nobody_of_a_scene_moves_are_left_out_and_change_nothing(
    world: World, monkeypatch: pytest.MonkeyPatch
) -> None:
    del world
    late = WALKED.replace("at: 0", "at: 2.51").replace("at: 1", "at: 3.7").replace("at: 3,", "at: 6.02,")
    asked, found = list[int](), []
    instants = pressers_module._instants  # noqa: SLF001 - the short way is held against the long one

    def short(*given: object) -> range:
        asked.append(len(instants(*given)))  # type: ignore[arg-type]
        return instants(*given)  # type: ignore[arg-type]

    def long(_: object, since: float, until: float) -> range:
        return range(floor(since * RATE) + 1, ceil(until * RATE))

    for way in (short, long):
        monkeypatch.setattr(pressers_module, "_instants", way)
        with little_prairie(scene=LITTLE + late) as prairie:
            for step_on in (1.23, 1.5, 2.0, 5.0, 0.51):
                prairie.advance(step_on)
                found.append(prairie.pressers.note(prairie.time))
    assert sum(asked) < 0.4 * prairie.time * RATE
    for one, other in zip(found[:5], found[5:], strict=True):
        for ours, theirs in ((one.settled, other.settled), (one.fresh, other.fresh)):
            np.testing.assert_array_equal(ours.marks, theirs.marks)
            np.testing.assert_array_equal(ours.listed, theirs.listed)
    assert len(found[3].settled.marks) > 10


@pytest.mark.parametrize(
    "still",
    [
        "",
        "  - { position: [5, 5] }\n  - { path: [{ at: 190, position: [9, 9] }] }\n",
        "  - { path: [{ at: 3, position: [-5, 5] }, { at: 9, position: [5, 5] }] }\n",
    ],
    ids=["all walk", "some have not set out", "one has arrived"],
)
def test_n5_what_a_scene_has_forgotten_is_not_gone_again_and_changes_nothing(
    world: World, monkeypatch: pytest.MonkeyPatch, still: str
) -> None:
    del world
    stops = ((0, -9, 0), (60, 9, 4), (160, -3, -9), (200, 9, 0))
    ways = ", ".join(f"{{ at: {at}, position: [{east}, {south}] }}" for at, east, south in stops)
    scene = f"{LITTLE}pressers:\n  - {{ radius: 0.4, path: [{ways}] }}\n  - {{ length: 1, path: [{ways}] }}\n{still}"
    start, begun, found, bent = pressers_module._replay_start, list[float](), [], []  # noqa: SLF001 - as above
    x, z = np.random.default_rng(5).uniform(-10.0, 10.0, (2, 4000))

    def late(*given: object) -> float:
        begun.append(start(*given))  # type: ignore[arg-type]
        return begun[-1]

    for way in (late, lambda *_: 0.0):
        monkeypatch.setattr(pressers_module, "_replay_start", way)
        with little_prairie(scene=scene) as prairie:
            prairie.advance(181.4)
            bent.append(prairie.bent_at(np.stack([x, z], axis=1)))
            found.append(prairie.pressers.trodden)
    assert begun == [120.0]
    assert np.linalg.norm(bent[0], axis=1).max() > 0.9
    np.testing.assert_array_equal(bent[0], bent[1])
    for ours, theirs in ((found[0].settled, found[1].settled), (found[0].fresh, found[1].fresh)):
        np.testing.assert_array_equal(ours.listed, theirs.listed)
        if not still:  # who stands has begun to before
            np.testing.assert_array_equal(ours.marks, theirs.marks)
    assert len(found[0].settled.marks) > 50


def test_n5_when_time_is_skipped_what_is_forgotten_is_not_gone(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    del world
    stops = ", ".join(f"{{ at: {60 * k}, position: [{9 if k % 2 else -9}, {k % 7 - 3}] }}" for k in range(16))
    asked, found, instants = [0], [], pressers_module._instants  # noqa: SLF001 - counted, as above

    def counted(*given: object) -> range:
        asked[0] += len(instants(*given))  # type: ignore[arg-type]
        return instants(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(pressers_module, "_instants", counted)
    for steps in ((2.3, 850.0), (852.3,)):
        with little_prairie(scene=f"{LITTLE}pressers:\n  - {{ path: [{stops}] }}\n") as prairie:
            runner = esper.create_entity(Presser(radius=0.4), Pose(0.0, 0.5))
            for seconds in steps:
                prairie.advance(seconds)
                found.append(prairie.bent_at(AROUND))
            esper.delete_entity(runner, immediate=True)
    np.testing.assert_array_equal(found[1], found[2])
    assert asked[0] < 250 * RATE


def test_f4_who_adds_a_presser_as_a_wind_is_told_how_it_is_done(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"a Presser goes with a Pose: esper\.create_entity\(presser, Pose\(x, z\)\)$"):
        prairie.add(Presser(), pose=Pose(0.0, 0.0))  # type: ignore[arg-type]
