"""States saved and restored: the same wind, grass and light in another process, or one sentence (F4, N5)."""

from collections.abc import Callable, Iterator
from hashlib import blake2b
from pathlib import Path
from time import process_time
from typing import Any
from zlib import compress, decompress

import esper
import numpy as np
import pytest
from yaml import safe_load

from tallgrass import Lamp, Shade, Tree
from tallgrass.components.arrays import Floats
from tallgrass.components.footprint import Footprint, Road
from tallgrass.components.patch import Patch
from tallgrass.components.pose import Pose
from tallgrass.components.presser import Presser
from tallgrass.components.wind import WindSource
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.saved import FORMAT
from tallgrass.systems.wind.blast import Blast
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.testing import LITTLE, watch

SCENE: dict[str, Any] = {
    "tallgrass": 2,
    "terrain": {"size": [60, 60], "cell": 5.0},
    "grass": {"green": {"height": [0.3, 0.5], "recovery": 8.0}, "dry": {"height": [0.4, 0.6]}},
    "wind": [
        {"kind": "breeze", "strength": 0.3},
        {"kind": "gust", "position": [-20, 0], "every": [3, 5]},
        {"kind": "turbulence", "strength": 0.3, "speed": 3.0},
    ],
    "mixing": "weight",
    "pressers": [{"path": [{"at": 0, "position": [-20, 3]}, {"at": 30, "position": [20, 3]}]}],
    "light": {"hour": 9.0, "hours_per_minute": 6.0},
    "quality": safe_load(LITTLE)["quality"],
}
PLACES = np.random.default_rng(0).uniform(-25.0, 25.0, (600, 2)).astype(np.float32)
TREES = {"quality": "minimal", "trees": {"oak": {"habit": "oak", "positions": [[0, -10], [5, 8]]}}}
HEAD = len(b"tallgrass state\n")

Told = dict[str, Floats]


@pytest.fixture
def played(world: World) -> Iterator[Prairie]:
    """Return a prairie in which a game has used everything that a state saves."""
    del world
    made = Prairie.load(SCENE)
    walker = esper.create_entity(Presser(radius=0.8), Pose(0.0, -20.0))
    cart = esper.create_entity(Presser(corners=((-1, -1), (1, -1), (1, 2))), Pose(-5.0, 10.0, 0.3))
    esper.create_entity(
        WindSource(Breeze(strength=0.5, priority=3, weight=0.5, start=2.0, stop=40.0), "mine"), Pose(2.0, 3.0)
    )
    car = Presser(radius=0.9), Lamp(candela=20_000.0, cone=0.3), Shade((8.0, 1.0, 2.0), size=(1.8, 1.4, 4.2), yaw=0.4)
    esper.create_entity(*car, Pose(8.0, 2.0, 0.4, y=0.7))
    esper.create_entity(Shade((3.0, 2.0, 1.0), 0.3, 1.8, capsule=True))
    made.add(Gust(position=[-20.0, 5.0], start=4.0), name="storm")
    gone = made.add(Gust())
    moved = made.add(Blast(strength=0.6), pose=Pose(5.0, 5.0))
    made.remove(gone)
    watch(made)
    (cleared,) = made.patch_at([(0.0, 10.0)]).tolist()
    esper.component_for_entity(cleared, Patch).grows = False
    for number in range(40):
        made.advance(0.2)
        esper.add_component(walker, Pose(0.4 * number - 8.0, -20.0 + 0.2 * number))
        esper.add_component(cart, Pose(-5.0, 10.0 - 0.4 * number, 0.3))
        made.bent_at(PLACES[:1])
    made.move(moved, Pose(5.0, 3.0))
    watch(made)
    ramped = next(entity for entity, source in esper.get_component(WindSource) if source.name == "wind[2] turbulence")
    esper.add_component(ramped, WindSource(Turbulence(strength=0.3, speed=7.0), "wind[2] turbulence"))
    made.cut(Footprint(radius=3.0), 0.1, pose=Pose(10.0, 10.0))
    made.cut(Footprint(radius=2.0, length=9.0), 0.2, pose=Pose(12.0, 4.0, 0.7))
    made.grow(Footprint(radius=1.0), pose=Pose(10.0, 10.0))
    made.sow("dry", Footprint(radius=4.0), 0.8, soft=2.0, pose=Pose(-10.0, -10.0))
    made.clear(Road(((-30.0, 12.0), (0.0, 18.0), (30.0, 10.0)), 3.0), soft=0.5)
    made.shine(clouds=0.5, hour=11.0)
    made.advance(0.313)
    yield made
    made.release()


def told(prairie: Prairie, *, on: float = 0.0) -> Told:
    """Return the answers of a prairie to all queries, now and a while later."""
    found: Told = {}
    for later in (0.0, on):
        prairie.advance(later)
        found |= {
            f"wind {later}": prairie.wind_at(PLACES),
            f"bent {later}": prairie.bent_at(PLACES),
            f"height {later}": prairie.grass_at(PLACES).height,
            f"density {later}": prairie.grass_at(PLACES).density,
            f"light {later}": np.array([prairie.light.hour, prairie.light.clouds, prairie.time]),
        }
    return found


def belongings() -> set[tuple[object, ...]]:
    """Return tallgrass's components on a game's entities that have a lamp or a shade."""
    kinds = Presser, Lamp, Shade, Pose
    found = {entity for kind in (Lamp, Shade) for entity, _ in esper.get_component(kind)}
    return {tuple(esper.try_component(entity, kind) for kind in kinds) for entity in found}


def assert_same(one: Told, other: Told) -> None:
    for name, due in one.items():
        np.testing.assert_array_equal(other[name], due, err_msg=name)


def test_n5_a_state_brings_everything_back_to_the_bit_in_another_world(played: Prairie, world: World) -> None:
    state, due, had = played.state(), told(played, on=2.5), belongings()
    played.release()
    esper.switch_world("another")
    other = Prairie.load(SCENE)
    entities = other.restore(state)
    assert len(entities) == 7
    assert belongings() == had
    assert_same(due, told(other, on=2.5))
    assert played.clearings.cells == other.clearings.cells != frozenset()
    other.release()
    esper.switch_world(world.name)
    esper.delete_world("another")


PROGRAM = """
import sys
from pathlib import Path
import numpy as np
from tallgrass import Prairie
scene, state, places, out = sys.argv[1:]
prairie = Prairie.load(eval(scene))
prairie.restore(Path(state).read_bytes())
at = np.load(places)
np.savez(out, wind=prairie.wind_at(at), bent=prairie.bent_at(at), height=prairie.grass_at(at).height)
Path(state).write_bytes(prairie.state())
"""


def test_n5_a_state_brings_everything_back_to_the_bit_in_another_process(
    played: Prairie, tmp_path: Path, python: Callable[..., str]
) -> None:
    state, places, out = tmp_path / "state", tmp_path / "places.npy", tmp_path / "out.npz"
    state.write_bytes(played.state())
    np.save(places, PLACES)
    (tmp_path / "program.py").write_text(PROGRAM, "utf-8")
    python(tmp_path, "program.py", repr(SCENE), str(state), str(places), str(out), place={})
    with np.load(out) as found:
        np.testing.assert_array_equal(found["wind"], played.wind_at(PLACES))
        np.testing.assert_array_equal(found["bent"], played.bent_at(PLACES))
        np.testing.assert_array_equal(found["height"], played.grass_at(PLACES).height)


def test_what_was_done_since_is_undone_and_handles_hold(played: Prairie) -> None:
    state, due = played.state(), told(played)
    before = {entity for entity, _ in esper.get_component(WindSource)}
    late = played.add(Breeze(strength=0.9, priority=9))
    played.cut(Footprint(radius=9.0), 0.05)
    played.advance(20.0)
    played.shine(hour=3.0)
    entities = played.restore(state)
    assert all(now == then for then, now in entities.items())
    assert {entity for entity, _ in esper.get_component(WindSource)} == before
    assert_same(due, told(played))
    with pytest.raises(ValueError, match="no wind has the handle"):
        played.move(late, Pose())
    storm = next(entity for entity, source in esper.get_component(WindSource) if source.name == "storm")
    played.move(storm, Pose(1.0, 1.0))


def test_a_wind_and_a_presser_of_the_scenes_that_a_game_has_deleted_stay_away(played: Prairie) -> None:
    winds = [entity for entity, source in esper.get_component(WindSource) if source.name == "wind[0] breeze"]
    for entity in (*winds, *played.pressers.declared):
        esper.delete_entity(entity, immediate=True)
    played.advance(0.1)
    state, due = played.state(), told(played)
    other = Prairie.load(SCENE)
    other.restore(state)
    assert "wind[0] breeze" not in [source.name for source in other.winds.sources()]
    assert_same({"bent": due["bent 0.0"]}, {"bent": other.bent_at(PLACES)})
    other.release()


def test_a_state_is_small_and_comes_back_fast_after_an_hour_of_mowing(world: World) -> None:
    del world
    scene = SCENE | {"terrain": {"size": [400, 400], "cell": 5.0}}
    made = Prairie.load(scene)
    random = np.random.default_rng(1)
    for _ in range(4000):
        x, z = random.uniform(-190.0, 190.0, 2).tolist()
        made.cut(Footprint(radius=0.5), float(random.choice([0.05, 0.06, 0.08])), pose=Pose(x, z))
    state = made.state()
    assert len(state) < 2_000_000
    other = Prairie.load(scene)
    begun = process_time()
    other.restore(state)
    assert process_time() - begun < 0.5
    np.testing.assert_array_equal(other.grass_at(PLACES).height, made.grass_at(PLACES).height)
    made.release()
    other.release()


def refused(prairie: Prairie, state: object, why: str) -> None:
    due, before = told(prairie), prairie.state()
    with pytest.raises(ValueError, match=why):
        prairie.restore(state)  # type: ignore[arg-type]
    assert prairie.state() == before
    assert_same(due, told(prairie))


def signed(body: bytes) -> bytes:
    return b"tallgrass state\n" + blake2b(body, digest_size=20).digest() + body


def test_a_state_of_another_scene_is_refused_and_nothing_changes(played: Prairie) -> None:
    other = Prairie.load(SCENE | {"wind": [*SCENE["wind"], {"kind": "whirlwind", "position": [0, 0]}]})
    other.set_heights((0.0, 0.0), np.full((3, 3), 9.0))
    refused(
        played,
        other.state(),
        r"^this state does not fit this scene: it has no place for the wind 'wind\[\d\] whirlwind'$",
    )
    other.release()


def test_a_state_serves_the_same_scene_in_other_light_and_another_camera(played: Prairie) -> None:
    other = Prairie.load(SCENE | {"light": {"elevation": 10.0}, "camera": {"eye": 3.0}})
    other.restore(played.state())
    assert other.light == played.light
    other.release()


def test_what_is_no_state_of_this_release_is_refused_in_a_sentence(played: Prairie) -> None:
    state = played.state()
    refused(played, b"", "^these bytes are no state of a prairie$")
    refused(played, b"PK" + state, "^these bytes are no state of a prairie$")
    refused(played, state[:-1], "^this state has been altered or truncated$")
    refused(
        played,
        signed(b"\x00\x01" + state[HEAD + 22 :]),
        r"^this state is of format 1, and this release reads format 5$",
    )
    with pytest.raises(TypeError, match=r"^a state is the bytes that state\(\) returned, not str$"):
        played.restore("state")  # type: ignore[arg-type]


def test_200_mutated_states_are_refused_and_nothing_changes(played: Prairie) -> None:
    state, random = played.state(), np.random.default_rng(7)
    due = told(played)
    for number in range(200):
        changed = bytearray(state)
        for place in random.integers(0, len(state), random.integers(1, 4)).tolist():
            changed[place] ^= 1 << int(random.integers(8))
        if number % 3 == 0:
            del changed[int(random.integers(len(changed))) :]
        if bytes(changed) == state:
            continue
        with pytest.raises(ValueError, match=r"^(this state|these bytes) "):
            played.restore(bytes(changed))
    assert_same(due, told(played))


def test_a_forged_state_is_refused_or_restored_and_never_a_traceback(played: Prairie) -> None:
    plain, random = decompress(played.state()[HEAD + 22 :]), np.random.default_rng(1)
    for _ in range(60):
        changed = bytearray(plain)
        for place in random.integers(0, len(plain), random.integers(1, 3)).tolist():
            changed[place] = int(random.integers(256))
        before = played.state()
        try:
            played.restore(signed(FORMAT.to_bytes(2) + compress(bytes(changed), 1)))
        except ValueError:
            assert played.state() == before, "refused, it has changed nothing"
        played.bent_at(PLACES[:20])


def test_a_wind_that_nobody_could_make_again_is_named(played: Prairie, build: Callable[[], WindSource]) -> None:
    esper.create_entity(build())
    with pytest.raises(ValueError, match=r"^the wind 'odd' cannot be saved: "):
        played.state()


def test_a_wind_whose_class_has_other_keys_by_now_is_refused_in_a_sentence(
    played: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Draught(Breeze):
        """A plugin's wind when the game was saved."""

        kind: str = "draught"  # type: ignore[assignment]
        power: float = 0.3

    class Later(Breeze):
        """The same wind in a later version of its package."""

        kind: str = "draught"  # type: ignore[assignment]
        force: float = 0.3

    monkeypatch.setitem(wind_kinds()._classes, "draught", Draught)  # noqa: SLF001
    played.add(Draught())
    state = played.state()
    monkeypatch.setitem(wind_kinds()._classes, "draught", Later)  # noqa: SLF001
    with pytest.raises(ValueError, match=r"^a wind of this state, a draught, cannot be made: unknown key 'power'"):
        played.restore(state)
    played.restore(state, partly=True)
    assert "draught" not in [source.name for source in played.winds.sources()]


def test_a_wind_whose_class_has_more_rates_by_now_is_left_out_of_what_is_restored_partly(
    played: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Pulse(Breeze):
        """A plugin's wind when the game was saved."""

        kind: str = "pulse"  # type: ignore[assignment]
        beats: float = 0.3

        def rates(self) -> tuple[float, ...]:
            return (self.beats,)

    class Later(Pulse):
        """The same wind in a later version of its package."""

        def rates(self) -> tuple[float, ...]:
            return self.beats, 2.0 * self.beats

    monkeypatch.setitem(wind_kinds()._classes, "pulse", Pulse)  # noqa: SLF001
    handle = played.add(Pulse())
    played.wind_at([(0.0, 0.0)])
    played.advance(1.0)
    esper.add_component(handle, WindSource(Pulse(beats=0.9), "pulse"))
    played.advance(1.0)
    state = played.state()
    monkeypatch.setitem(wind_kinds()._classes, "pulse", Later)  # noqa: SLF001
    with pytest.raises(ValueError, match="the phases of a wind have a wrong number of rates or offsets"):
        played.restore(state)
    played.restore(state, partly=True)
    assert "pulse" not in [source.name for source in played.winds.sources()]


@pytest.fixture
def build() -> Callable[[], WindSource]:
    class Odd(Breeze):
        """A wind that nobody has registered."""

    return lambda: WindSource(Odd(kind="breeze"), "odd")


def test_two_prairies_of_one_world_bring_back_what_they_share_once(played: Prairie, world: World) -> None:
    twin, had = Prairie.load(SCENE), belongings()
    esper.create_entity(Tree("birch"), Pose(3.0, 3.0))
    states = [prairie.state() for prairie in (played, twin)]
    twin.release()
    played.release()
    esper.switch_world("another")
    try:
        prairies, entities = [Prairie.load(SCENE) for _ in states], dict[int, int]()
        for prairie, state in zip(prairies, states, strict=True):
            entities |= prairie.restore(state, entities)
        assert belongings() == had
        counts = [len(esper.get_component(kind)) for kind in (Presser, Lamp, Shade, Tree)]
        for prairie in prairies:
            prairie.release()
        assert counts == [3 + 2 * len(SCENE["pressers"]), 1, 2, 1]
    finally:
        esper.switch_world(world.name)
        esper.delete_world("another")


def test_what_a_game_has_deleted_is_not_saved_even_if_esper_still_defers_that(world: World) -> None:
    del world
    made = Prairie.load(SCENE | TREES)
    doomed = [
        esper.get_component(Tree)[0][0],
        made.add(Blast()),
        esper.create_entity(Presser(), Pose(0.0, 0.0)),
        esper.create_entity(Lamp(), Pose(0.0, 0.0, y=2.0)),
    ]
    for entity in doomed:
        esper.delete_entity(entity)
    state = made.state()
    made.release()
    esper.clear_dead_entities()
    again = Prairie.load(SCENE | TREES)
    counts = [len(esper.get_component(each)) for each in (WindSource, Presser)]
    assert again.restore(state) == {}
    assert [len(esper.get_component(each)) for each in (WindSource, Presser)] == counts
    assert (len(esper.get_component(Tree)), esper.get_component(Lamp)) == (1, [])
    again.release()
