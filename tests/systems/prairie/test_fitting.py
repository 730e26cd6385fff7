"""States restored into a changed scene: of a later release, or of a game's next version (F4)."""

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import esper
import numpy as np
import pytest
from yaml import safe_load

from tallgrass import Footprint, Gust, Pose, Prairie, Tree
from tallgrass.components.wind import WindSource
from tallgrass.engine.plugins import wind_kinds
from tallgrass.engine.world import World
from tallgrass.systems import saving
from tallgrass.testing import LITTLE

GREEN, DRY = {"height": [0.3, 0.5]}, {"height": [0.4, 0.6]}
FEET = [-12, -12], [12, -12]
OAK = {"habit": "oak", "positions": [*FEET]}
SCENE: dict[str, Any] = {
    "tallgrass": 2,
    "terrain": {"size": [60, 60], "cell": 5.0},
    "grass": {"green": GREEN, "dry": DRY},
    "wind": [{"kind": "breeze", "strength": 0.3}, {"kind": "gust", "position": [-20, 0], "every": [3, 5]}],
    "pressers": [{"path": [{"at": 0, "position": [-20, 3]}, {"at": 30, "position": [20, 3]}]}],
    "trees": {"oak": OAK},
    "quality": safe_load(LITTLE)["quality"],
}
SAVED = Path(__file__).with_name("format-5.prairie")
"""State of this scene, as the first copy of format 5 wrote it: players keep such files."""

SOWN, DUG = (-10.0, 13.0), (2.5, 2.5)


@pytest.fixture
def state(world: World) -> bytes:
    """State of the scene after a bit of everything was done in it."""
    del world
    made = Prairie.load(SCENE)
    played(made)
    found = made.state()
    made.release()
    return found


def played(prairie: Prairie) -> None:
    prairie.add(Gust(position=[-20.0, 5.0], start=4.0), name="storm")
    prairie.cut(Footprint(radius=3.0), 0.1, pose=Pose(10.0, 10.0))
    prairie.sow("dry", Footprint(radius=4.0), 0.8, pose=Pose(-10.0, 10.0))
    prairie.clear(Footprint(radius=2.0), pose=Pose(-10.0, 10.0))
    prairie.set_heights((0.0, 0.0), np.full((2, 2), 1.5))
    (felled,) = (entity for entity, (_, pose) in esper.get_components(Tree, Pose) if pose.x == 12.0)
    esper.delete_entity(felled, immediate=True)
    prairie.change_kind("green", tip="#c86a1e")
    prairie.advance(11.0)


def assert_played(prairie: Prairie, *lost: str) -> None:
    """Assert that all contents of the state are there, except for those that are lost, by their names here."""
    names, sown = list(prairie.scene.grass), prairie.grass_at([SOWN]).density[0]
    found = {
        "time": prairie.time == 11.0,
        "cut": prairie.grass_at([(10.0, 10.0)]).height[0] == pytest.approx(0.1, abs=5e-3),
        "sown": "dry" in names and sown[names.index("dry")] == pytest.approx(0.8, abs=0.01),
        "cleared": not prairie.grass_at([(-10.0, 10.0)]).density.any(),
        "dug": prairie.height_at([DUG])[0] == 1.5,
        "felled": [pose.x for _, (_, pose) in esper.get_components(Tree, Pose)] == [-12.0],
        "storm": "storm" in [source.name for _, source in esper.get_component(WindSource)],
        "season": "green" in names and prairie.scene.grass["green"].tip == "#c86a1e",
    }
    assert {name for name, is_there in found.items() if not is_there} == {*lost}


@pytest.fixture
def other(world: World, request: pytest.FixtureRequest) -> Iterator[Prairie]:
    del world
    made = Prairie.load(SCENE | request.param)
    yield made
    made.release()


OTHERWISE = {
    "as it was": {},
    "its mixing": {"mixing": "priority"},
    "its grass": {"grass": {"green": GREEN | {"clumping": 0.1, "recovery": 30.0}, "dry": DRY}},
    "how its winds blow": {"wind": [{"kind": "breeze"}, {"kind": "gust", "speed": 3.0}]},
}
"""What the scene comes to say where another release takes other values for granted, or a game's next version does."""


@pytest.mark.parametrize("other", OTHERWISE.values(), ids=[*OTHERWISE], indirect=True)
def test_a_state_comes_back_to_its_scene_whatever_that_says_besides(state: bytes, other: Prairie) -> None:
    other.restore(state)
    assert_played(other)


GUST = {"kind": "gust", "position": [0, 15], "every": [2, 4]}


@pytest.mark.parametrize("other", [{"wind": [GUST, *SCENE["wind"]]}], indirect=True)
def test_a_wind_that_is_new_begins_as_the_scene_has_it_and_the_others_go_on(state: bytes, other: Prairie) -> None:
    other.restore(state)
    assert_played(other)
    there = {
        source.primitive.position[1]: source.name
        for source in other.winds.sources()
        if isinstance(source.primitive, Gust)
    }
    assert there[0.0] == "wind[1] gust"
    assert there[15.0] not in ("wind[1] gust", "storm")
    assert len(other.winds.sources()) == 4
    again = Prairie.load(SCENE | {"wind": [GUST, *SCENE["wind"]]})
    again.restore(other.state())
    np.testing.assert_array_equal(again.wind_at([SOWN, DUG]), other.wind_at([SOWN, DUG]))
    again.release()


@pytest.mark.parametrize("other", [{"pressers": [{"path": []}, *SCENE["pressers"]]}], indirect=True)
def test_a_presser_that_is_new_goes_its_way_beside_the_others(state: bytes, other: Prairie) -> None:
    other.restore(state)
    assert_played(other)
    fresh = Prairie.load(SCENE | {"pressers": [{"path": []}, *SCENE["pressers"]]})
    fresh.advance(other.time)
    way = [(x, 3.0) for x in np.linspace(-20.0, 20.0, 80)]
    trodden, due = ((each.bent_at(way) != each.wind_at(way)).any(axis=1) for each in (other, fresh))
    np.testing.assert_array_equal(trodden, due)
    assert 10 < due.sum() < 70
    fresh.release()


@pytest.mark.parametrize("other", [{"wind": [SCENE["wind"][1], GUST]}], indirect=True)
def test_a_wind_that_a_game_deleted_stays_deleted_where_others_are_gone(world: World, other: Prairie) -> None:
    del world
    made = Prairie.load(SCENE | {"wind": SCENE["wind"][1:]})
    esper.delete_entity(made.winds.declared[0], immediate=True)
    other.restore(made.state())
    made.release()
    assert [source.primitive.model_dump()["position"] for source in other.winds.sources()] == [[0.0, 15.0]]


@pytest.mark.parametrize("other", [{}], indirect=True)
def test_a_state_that_an_older_copy_saved_comes_back(other: Prairie) -> None:
    other.restore(SAVED.read_bytes())
    assert_played(other)


@pytest.mark.parametrize("other", [{"grass": {"dry": DRY, "green": GREEN}}], indirect=True)
def test_what_is_sown_goes_by_the_names_of_kinds_and_not_by_their_order(state: bytes, other: Prairie) -> None:
    other.restore(state)
    assert_played(other)


NEW = {
    "a flower": {"plant": "flower", "height": [0.3, 0.5], "place": {"map": np.full((2, 2), 0.4)}},
    "grass": {"height": [0.3, 0.5], "place": {"map": np.full((2, 2), 0.4)}},
}


@pytest.mark.parametrize(
    "other", [{"grass": {"new": kind, "green": GREEN, "dry": DRY}} for kind in NEW.values()], ids=[*NEW], indirect=True
)
def test_a_kind_that_is_new_grows_wherever_nothing_was_sown_or_cleared(state: bytes, other: Prairie) -> None:
    places = np.stack(np.meshgrid(np.linspace(-29.5, -0.5, 30), np.linspace(-29.5, 29.5, 60)), axis=-1).reshape(-1, 2)
    painted = other.grass_at(places).density
    away = np.hypot(*(places - (-10.0, 10.0)).T)
    other.restore(state)
    assert_played(other)
    found = other.grass_at(places).density
    assert not found[away < 3.8, 0].any()
    np.testing.assert_allclose(found[away > 4.3], painted[away > 4.3], atol=0.01)
    other.sow("new", Footprint(radius=1.0), 0.5, pose=Pose(-10.0, 10.0))
    assert other.grass_at([(-10.0, 10.0)]).density[0, 0] == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize(
    "other", [{"trees": {"oak": OAK | {"positions": [[0, 20], [-12, -12], [12, -12]]}}}], indirect=True
)
def test_a_felled_tree_is_found_by_where_it_stood(state: bytes, other: Prairie) -> None:
    other.restore(state)
    assert sorted(pose.x for _, (_, pose) in esper.get_components(Tree, Pose)) == [-12.0, 0.0]


UNFIT = {
    "its seed is 1, and this one's 2": {"seed": 2},
    "its ground is 60 by 60 m with a sample every 5 m, and this one's 60 by 50 m with a sample every 5 m": {
        "terrain": {"size": [60, 50], "cell": 5.0}
    },
    "its ground has other heights or holes": {"terrain": {"size": [60, 60], "cell": 5.0, "offset": 1.0}},
    r"it has no place for the wind 'wind\[1\] gust'": {"wind": [{"kind": "breeze"}]},
    "it has no place for what was done to its pressers": {"pressers": []},
    "it has no place for the change of the grass 'green', what is sown where there was the grass 'green'": {
        "grass": {"lush": GREEN, "dry": DRY}
    },
    "it has no place for what is sown where there was the grass 'dry'": {"grass": {"green": GREEN, "red": DRY}},
    r"it has no place for the tree felled at \(12, -12\)": {
        "trees": {"oak": OAK | {"positions": [[-12, -12], [12, -10]]}}
    },
}


@pytest.mark.parametrize(("why", "other"), UNFIT.items(), indirect=["other"])
def test_what_does_not_fit_is_said_in_a_sentence_and_nothing_changes(state: bytes, other: Prairie, why: str) -> None:
    before = other.state()
    with pytest.raises(ValueError, match=f"^this state does not fit this scene: {why}$"):
        other.restore(state)
    assert other.state() == before


TURNS = np.linspace(0.0, 6.0, 40)
HILL = {"size": [60, 60], "cell": 5.0, "offset": 1.0}
PARTLY: dict[str, tuple[dict[str, Any], list[str], list[str]]] = {
    "another seed": ({"seed": 2}, [], []),
    "higher ground": ({"terrain": HILL}, ["dug"], ["the ground that was dug"]),
    "wider ground": ({"terrain": {"size": [90, 80], "cell": 2.0}}, ["dug"], ["the ground that was dug"]),
    "ground too narrow": (
        {"terrain": {"size": [24, 24], "cell": 4.0}},
        ["dug", "sown"],
        ["the ground that was dug", "what was cut or sown beyond its edge"],
    ),
    "no gust": ({"wind": [{"kind": "breeze"}]}, [], ["the wind 'wind[1] gust'"]),
    "no pressers": ({"pressers": []}, [], ["what was done to its pressers"]),
    "a kind that is gone": (
        {"grass": {"green": GREEN, "red": DRY}},
        ["sown"],
        ["what is sown where there was the grass 'dry'"],
    ),
    "another kind that is gone": (
        {"grass": {"lush": GREEN, "dry": DRY}},
        ["season", "sown"],
        ["the change of the grass 'green'", "what is sown where there was the grass 'green'"],
    ),
    "kinds that are all gone": (
        {"grass": {"lush": GREEN}},
        ["season", "sown"],
        [
            "the change of the grass 'green'",
            "what is sown where there was the grass 'green'",
            "what is sown where there was the grass 'dry'",
        ],
    ),
    "a tree that is gone": (
        {"trees": {"oak": OAK | {"positions": [[-12, -12]]}}},
        [],
        ["the tree felled at (12, -12)"],
    ),
}
"""Later versions of the scene, what of the state is lost in them, and what the log says of that."""


@pytest.mark.parametrize(("other", "lost", "said"), PARTLY.values(), ids=[*PARTLY], indirect=["other"])
def test_what_has_a_place_in_a_later_version_comes_back_and_the_rest_is_said_in_one_sentence(
    state: bytes, other: Prairie, lost: list[str], said: list[str], caplog: pytest.LogCaptureFixture
) -> None:
    ring = (-10.0, 10.0) + 4.5 * np.stack([np.cos(TURNS), np.sin(TURNS)], axis=1)
    as_before = other.grass_at(ring).density
    other.restore(state, partly=True)
    np.testing.assert_allclose(other.grass_at(ring).density, as_before, atol=0.01)
    assert_played(other, *lost)
    sentence = "a state was restored without what has no place in this scene: "
    assert caplog.messages == ([sentence + ", ".join(said)] if said else [])
    other.restore(other.state())
    assert_played(other, *lost)


def raised(value: float) -> dict[str, Any]:
    """Return a terrain with samples every 2.5 m whose left third is raised [m]."""
    heights = np.zeros((25, 25), np.float32)
    heights[:, :9] = value
    return {"terrain": {"heights": heights, "cell": 2.5}}


@pytest.mark.parametrize("other", [raised(2.0)], indirect=True)
def test_what_was_dug_stays_where_the_ground_is_as_it_was_and_the_log_says_where_it_is_not(
    other: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    made = Prairie.load(SCENE | raised(0.0))
    made.set_heights((10.0, 0.0), [[-1.0, -1.0], [-1.0, -1.0]])
    made.set_heights((-25.0, 0.0), [[-1.0, -1.0]])
    state = made.state()
    made.release()
    with pytest.raises(ValueError, match="its ground has other heights or holes"):
        other.restore(state)
    other.restore(state, partly=True)
    heights = other.height_at([(10.0, 0.0), (12.5, 0.0), (10.0, 2.5), (-25.0, 0.0), (-22.5, 0.0), (-12.5, 20.0)])
    np.testing.assert_allclose(heights, [-1.0, -1.0, -1.0, 2.0, 2.0, 2.0])
    where = "between (-30, -30) and (-10, 7.5), where it lies otherwise now"
    assert caplog.messages == [
        f"a state was restored without what has no place in this scene: the ground that was dug {where}"
    ]


def streaming(value: float, *, asked: list[float] | None = None) -> dict[str, Any]:
    """Return a ground that streams, raised to the left of 100 m [m]; `asked` gets where its function is asked (x)."""

    def heights(x: np.ndarray, z: np.ndarray) -> np.ndarray:
        if asked is not None:
            asked.append(float(x.min()))
        return np.where(x < 100.0, value, 0.0) + 0.0 * z

    return {"terrain": {"heights": heights, "window": 512.0, "cell": 1.0}, "pressers": [], "trees": {}}


def test_what_was_dug_into_ground_that_streams_stays_where_that_is_as_it_was(
    world: World, caplog: pytest.LogCaptureFixture
) -> None:
    del world
    made = Prairie.load(SCENE | streaming(0.0))
    made.set_heights((9000.0, 40.0), [[-1.0, -1.0], [-1.0, -1.0]])
    made.set_heights((-25.0, 0.0), [[-1.0, -1.0]])
    state = made.state()
    made.release()
    asked = list[float]()
    again = Prairie.load(SCENE | streaming(0.0, asked=asked))
    asked.clear()
    again.restore(state)
    again.state()  # nothing far off is asked for, in order to save it
    assert max(asked, default=0.0) < 8000.0
    again.release()
    other = Prairie.load(SCENE | streaming(2.0))
    other.restore(state, partly=True)
    np.testing.assert_allclose(other.height_at([(9000.5, 40.5), (9003.0, 40.0), (-25.0, 0.0)]), [-1.0, 0.0, 2.0])
    where = "between (-32, 0) and (-16, 16), where it lies otherwise now"
    assert caplog.messages == [
        f"a state was restored without what has no place in this scene: the ground that was dug {where}"
    ]
    saved = other.state()
    other.set_heights((9000.0, 40.0), [[5.0]])
    other.restore(saved)
    assert other.height_at([(9000.5, 40.5)])[0] == -1.0
    other.release()


@pytest.mark.parametrize("other", [{"wind": [{"kind": "breeze"}]}], indirect=True)
def test_a_wind_that_no_package_brings_any_more_is_left_out_alone(
    state: bytes, other: Prairie, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def find(kind: str) -> type:
        if kind == "gust":
            raise ValueError("unknown wind 'gust'")
        return wind_kinds().find(kind)

    monkeypatch.setattr(saving, "wind_kinds", lambda: SimpleNamespace(find=find))
    other.restore(state, partly=True)
    assert_played(other, "storm")
    (message,) = caplog.messages
    assert message.endswith("scene: the wind 'wind[1] gust', the wind 'storm'")
