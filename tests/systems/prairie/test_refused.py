"""Arguments that a prairie refuses in one sentence, and unusual ones that it accepts (N4, D5)."""

import pickle
from collections.abc import Callable
from copy import copy, deepcopy
from functools import partial
from pathlib import Path
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray
from pyglet.math import Mat4

from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindSource
from tallgrass.engine.scene import LoadedScene, SceneError
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.gust import Gust

Load = Callable[..., Prairie]

PLACES = np.random.default_rng(0).uniform(-25.0, 25.0, (50, 2)).astype(np.float32)


@pytest.mark.parametrize("time", ["1", [0.0, 1.0], np.zeros(2), 1j, -1.0, float("nan"), float("inf")])
def test_a_bad_time_is_refused_in_a_sentence_and_no_wind_is_blamed_for_it(prairie: Prairie, time: Any) -> None:
    felt = prairie.wind_at(PLACES, 2.0)
    with pytest.raises(
        (TypeError, ValueError), match=r"^a wind is asked for at (a number of seconds|0 s to 1e\+09 s), not"
    ):
        prairie.wind_at(PLACES, time)
    assert not prairie.winds.quarantine.reasons
    np.testing.assert_array_equal(prairie.wind_at(PLACES, 2.0), felt)


@pytest.mark.parametrize(
    ("option", "sentence"),
    [
        ({"preset": "hgih"}, r"^unknown preset 'hgih'; there are minimal, low, medium, high, "),
        ({"lod": "voxels"}, r"^unknown representation 'voxels'; there are auto, blades, strips, carpet$"),
        ({"hold": -1.0}, r"^hold is a time above 0 s and up to 5 s, such as 1 / 60, or None for no limit, not -1.0$"),
    ],
)
def test_an_unknown_option_is_refused_in_a_sentence_and_leaves_the_world_alone(
    load: Load, option: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(ValueError, match=sentence):
        load(**option)
    assert [*esper.get_entities()] == []


@pytest.mark.parametrize(
    ("option", "sentence"),
    [
        ({"transitions": False}, r"^transitions are made as Transitions\(\), unlike False$"),
        ({"ctx": 3}, "^ctx is a moderngl context, unlike 3$"),
    ],
)
def test_an_option_of_another_type_is_refused_in_a_sentence(load: Load, option: dict[str, Any], sentence: str) -> None:
    with pytest.raises(TypeError, match=sentence):
        load(**option)


def test_a_reload_with_what_is_no_site_is_refused_in_a_sentence(load: Load) -> None:
    with pytest.raises(TypeError, match=r"^site is what finding\(\.\.\.\)\(\) of this prairie returned, and"):
        load().reload(site=3)  # type: ignore[arg-type]


def test_what_is_no_scene_is_refused_in_a_sentence() -> None:
    with pytest.raises(
        TypeError, match=r"^a scene is the path of a file, .* mapping of its keys or a Scene, unlike 5$"
    ):
        Prairie.load(5)  # type: ignore[arg-type]


def test_an_unknown_scene_is_refused_in_a_sentence(load: Load) -> None:
    with pytest.raises(SceneError, match="no scene file 'meadwo', did you mean 'meadow'"):
        load("meadwo")


GOOD = np.eye(4)
BAD: list[tuple[object, str]] = [
    (np.eye(3), r"must have 4 x 4 finite numbers, not \(3, 3\)$"),
    (np.full((4, 4), np.nan), "must have 4 x 4 finite numbers, not NaN or infinity$"),
    (None, "must have 4 x 4 finite numbers, not None$"),
    ("view", "must have 4 x 4 finite numbers, not 'view'$"),
    ([[1.0, 2.0], [3.0]], r"must have 4 x 4 finite numbers, not \[\[1.0, 2.0\], \[3.0\]\]$"),
    (list(range(15)), r"must have 4 x 4 finite numbers, not \(15,\)$"),
    (np.zeros((4, 4)), "has no inverse$"),
]


@pytest.mark.parametrize(
    ("view", "projection", "sentence"),
    [
        (GOOD * 1e30, GOOD * 1e30, "^the product of the view and projection matrices overflows"),
        (GOOD * 1e-25, GOOD * 1e-25, "^the product of the view and projection matrices overflows"),
        (Mat4.perspective_projection(1.0, 0.1, 100.0), GOOD, "^the view matrix has perspective: give the view first"),
        (
            GOOD + np.eye(4, k=-3) * 9.0,
            GOOD,
            "^the view matrix has perspective: .* a last row of 0 0 0 1",
        ),  # transposed
        (GOOD + np.eye(4, k=3) * 1e30, GOOD, r"^the view matrix has its eye beyond 1e\+09 m$"),
    ],
)
def test_matrices_that_lead_out_of_the_world_are_refused_in_a_sentence(
    prairie: Prairie, view: NDArray[np.float64] | Mat4, projection: NDArray[np.float64], sentence: str
) -> None:
    with pytest.raises(ValueError, match=sentence):
        prairie.draw(view, projection)


@pytest.mark.parametrize(("matrix", "sentence"), BAD)
def test_a_bad_matrix_is_refused_in_a_sentence_that_names_it(prairie: Prairie, matrix: object, sentence: str) -> None:
    with pytest.raises(ValueError, match=f"^the view matrix {sentence}"):
        prairie.draw(matrix, GOOD)
    with pytest.raises(ValueError, match=f"^the projection matrix {sentence}"):
        prairie.draw(GOOD, matrix)
    assert prairie.painter is None


@pytest.mark.parametrize(
    ("places", "found"),
    [
        ([1.0, 2.0, 3.0], r"an array of shape \(3,\)"),
        ([[1.0, 2.0, 3.0]] * 4, r"an array of shape \(4, 3\)"),
        (7.0, r"an array of shape \(\)"),
        ([[np.nan, 0.0]], "NaN or infinity"),
        ([[1.0, 2.0], [3.0]], r"\[\[1.0, 2.0\], \[3.0\]\]"),
        ("here", "'here'"),
        (None, "None"),
        (np.ones((1, 2), complex), r"array\(\[\[1.\+0.j, 1.\+0.j\]\]\)"),
    ],
)
def test_places_that_are_no_pairs_are_refused_in_a_sentence(prairie: Prairie, places: object, found: str) -> None:
    for ask in (prairie.height_at, prairie.wind_at, prairie.patch_at):
        with pytest.raises(
            ValueError, match=rf"^ground positions are finite \(x, z\) pairs, one in each row, not {found}$"
        ):
            ask(places)  # type: ignore[arg-type]


@pytest.mark.parametrize("seed", [-1, 2**31, 1.0, "7", None])
def test_what_is_no_seed_is_refused_in_a_sentence(prairie: Prairie, seed: Any) -> None:
    with pytest.raises(ValueError, match=r"^a seed is a whole number from 0 to 2147483647, not "):
        prairie.reseeded(seed)


def test_no_places_have_no_heights_no_winds_and_no_patches(prairie: Prairie) -> None:
    asked = (prairie.height_at, prairie.wind_at, prairie.bent_at, prairie.patch_at)
    assert [ask([]).shape for ask in asked] == [ask(np.zeros((0, 2))).shape for ask in asked]
    assert [ask([]).shape for ask in asked] == [(0,), (0, 2), (0, 2), (0,)]


@pytest.mark.parametrize("far", [1e9, 1e30, -3e38])
def test_a_place_far_beyond_any_prairie_is_answered_without_a_warning(prairie: Prairie, far: float) -> None:
    for ask in (prairie.height_at, prairie.wind_at, prairie.bent_at, prairie.patch_at):
        assert np.isfinite(ask([(far, 0.0), (0.0, far)])).all()
    with pytest.raises(ValueError, match=r"not numbers as large as 1e\+39"):
        prairie.height_at([(1e39, 0.0)])


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"pos": [0, 0]}, "Gust: unknown key 'pos', did you mean 'position'?"),
        ({"strength": 3}, "Gust: strength must be between 0 and 1, found 3"),
        ({"position": [0, "x"]}, "Gust: item 2 of position must be a number, found the text 'x'"),
        ({"start": 4.0, "stop": 3.0}, "Gust: stop must be later than start, which is 4 s"),
        (
            {"hold": "long", "reech": 9},
            "Gust: hold must be a number, found the text 'long'; unknown key 'reech', did you mean 'reach'?",
        ),
    ],
)
def test_a_wind_of_bad_values_is_refused_in_the_sentences_that_a_scene_gets(values: dict[str, Any], said: str) -> None:
    with pytest.raises(ValueError, match=r"^Gust: ") as caught:
        Gust(**values)
    assert str(caught.value) == said


@pytest.mark.parametrize(
    ("wind", "said"),
    [
        ("gust", "its name 'gust'"),
        (Gust, "the class Gust"),
        (3, "3"),
        (None, "None"),
    ],
)
def test_what_is_no_wind_is_refused_in_a_sentence(prairie: Prairie, wind: object, said: str) -> None:
    with pytest.raises(TypeError, match=rf"^add takes a wind such as Gust\(\), not {said}$"):
        prairie.add(wind)  # type: ignore[arg-type]
    assert len(prairie.winds.sources()) == 2


def test_a_name_that_is_no_text_is_refused_in_a_sentence(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"^a wind's name is a text such as 'north', not 3$"):
        prairie.add(Gust(), name=3)  # type: ignore[arg-type]


NOWHERE: list[tuple[object, type[Exception], str]] = [
    ((1, 2), TypeError, r"a wind is put at a Pose such as Pose\(x=3.0, z=-5.0\), not at \(1, 2\)"),
    (None, TypeError, r"a wind is put at a Pose such as Pose\(x=3.0, z=-5.0\), not at None"),
    (
        Pose(np.nan, 0.0),
        ValueError,
        r"a wind is put where x, y, z \[m\] and yaw \[rad\] are finite numbers, .* either way, not at Pose.*nan.*",
    ),
    (Pose(2e6, 0.0), ValueError, r"a wind is put where .* at most 1e\+06 either way, not at Pose\(x=2000000.0.*"),
    (Pose(0.0, 0.0, np.inf), ValueError, r"a wind is put where .* finite numbers, .* not at Pose.*inf.*"),
    (Pose("left", 0.0), ValueError, r"a wind is put where .* finite numbers, .* not at Pose.*'left'.*"),  # type: ignore[arg-type]
]


@pytest.mark.parametrize(("pose", "error", "sentence"), NOWHERE)
def test_a_place_that_is_nowhere_is_refused_and_the_wind_stays(
    prairie: Prairie, pose: object, error: type[Exception], sentence: str
) -> None:
    handle = prairie.add(Gust(), pose=Pose(2.0, 3.0))
    with pytest.raises(error, match=f"^{sentence}$"):
        prairie.move(handle, pose)  # type: ignore[arg-type]
    assert esper.component_for_entity(handle, Pose) == Pose(2.0, 3.0)
    if pose is not None:
        with pytest.raises(error, match=f"^{sentence}$"):
            prairie.add(Gust(), pose=pose)  # type: ignore[arg-type]


@pytest.mark.parametrize("change", ["move", "remove"])
def test_a_handle_of_no_wind_is_refused_in_a_sentence(prairie: Prairie, change: str) -> None:
    handle = prairie.add(Gust())
    prairie.remove(handle)
    theirs = esper.create_entity("a game's own")
    more = (Pose(),) if change == "move" else ()
    for number in (handle, theirs, np.int64(3663)):
        with pytest.raises(ValueError, match=f"^no wind has the handle {number}: it was removed before, or add never "):
            getattr(prairie, change)(number, *more)
    with pytest.raises(
        TypeError, match=r"^winds are moved and removed by the handle that add returned, not by 'gust'$"
    ):
        getattr(prairie, change)("gust", *more)
    assert esper.components_for_entity(theirs) == ("a game's own",)


@pytest.mark.parametrize("how", ["at once", "later", "its wind alone", "the whole world"])
def test_a_wind_that_the_game_has_deleted_cannot_be_moved_and_may_be_removed(prairie: Prairie, how: str) -> None:
    handle = prairie.add(Gust())
    if how == "its wind alone":
        esper.remove_component(handle, WindSource)
    elif how == "the whole world":
        esper.clear_database()
    else:
        esper.delete_entity(handle, immediate=how == "at once")
    again = f"^wind {handle} is over, or the game has deleted its entity: add it again to move it$"
    with pytest.raises(ValueError, match=again):
        prairie.move(handle, Pose())
    prairie.remove(handle)
    with pytest.raises(ValueError, match="no wind has the handle"):
        prairie.remove(handle)


@pytest.mark.parametrize(
    ("loaded", "sentence"),
    [
        ("meadow", r"load one by Prairie\.load\('meadow'\)$"),
        (Path("a.yaml"), r"load one by Prairie\.load\('a\.yaml'\)$"),
        (3, r"not 3; use Prairie\.load$"),
    ],
)
def test_a_prairie_made_of_no_scene_says_what_loads_one(world: World, loaded: object, sentence: str) -> None:
    with pytest.raises(TypeError, match=f"^Prairie takes a scene that has been read.*{sentence}"):
        Prairie(loaded)  # type: ignore[arg-type]
    assert len(world) == 0


def test_a_viewer_is_called_by_a_text(prairie: Prairie) -> None:
    view = np.eye(4)
    for ask in (
        lambda: prairie.draw(view, view, viewer=3),  # type: ignore[arg-type]
        lambda: prairie.follow(view, view, viewer=3),  # type: ignore[arg-type]
        lambda: prairie.patch_at([[0, 0]], viewer=3),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match=r"^a viewer's name is a text such as 'main', not 3$"):
            ask()
    assert not prairie.viewers.values()


def test_a_group_has_a_function_for_its_camera(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"^the camera of a group is a function that returns two matrices, not None$"):
        prairie.group(object(), None)  # type: ignore[arg-type]


def test_a_released_prairie_says_so_when_it_is_asked_for_more(prairie: Prairie) -> None:
    handle = prairie.add(Gust())
    prairie.release()
    asked: list[tuple[str, Callable[[], object]]] = [
        ("draw it", lambda: prairie.draw(GOOD, GOOD)),
        ("put it into a batch", lambda: prairie.group(object(), lambda: (GOOD, GOOD))),  # type: ignore[arg-type]
        ("add a wind", lambda: prairie.add(Gust())),
        ("move a wind", lambda: prairie.move(handle, Pose())),
        ("add a system", lambda: prairie.systems.add("input", "late", print)),
        ("move its time on", lambda: prairie.advance(0.1)),
        ("set its time", lambda: setattr(prairie, "time", 1.0)),
        ("choose another preset", lambda: setattr(prairie, "preset", "low")),
        *(
            ("ask about it", partial(ask, [(0.0, 0.0)]))
            for ask in (
                prairie.height_at,
                prairie.normal_at,
                prairie.grass_at,
                prairie.wind_at,
                prairie.bent_at,
                prairie.patch_at,
            )
        ),
        ("ask about it", lambda: prairie.pick((0.0, 9.0, 0.0), (0.0, -1.0, 0.0))),
    ]
    for purpose, ask in asked:
        with pytest.raises(RuntimeError, match=f"^this prairie has been released: load it again to {purpose}$"):
            ask()
    prairie.remove(handle)
    assert list(esper.get_entities()) == []


@pytest.mark.parametrize("how", [copy, deepcopy, pickle.dumps])
def test_a_prairie_that_is_copied_says_what_to_keep(prairie: Prairie, how: Callable[[object], object]) -> None:
    with pytest.raises(TypeError, match=r"^a prairie cannot be pickled or copied: keep state\(\), and restore it"):
        how(prairie)


def test_a_system_that_leaves_another_esper_world_current_is_named_and_the_frame_goes_on(
    prairie: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    home, ran = esper.current_world, list[str]()
    prairie.systems.add("INPUT", "level", partial(esper.switch_world, "next level"))
    prairie.systems.add("SEE", "after", lambda: ran.append(esper.current_world))
    try:
        for _ in range(2):
            prairie.follow(np.eye(4), Mat4.perspective_projection(1.5, 0.1, 100.0))
        assert esper.current_world == home
    finally:
        esper.switch_world(home)
        esper.delete_world("next level")
    assert ran == [home] * 2
    assert [message.partition(" of ")[0] for message in caplog.messages] == ["system 'level'"]
    assert f"run left esper world 'next level' current in place of '{home}'" in prairie.systems.failures["level"]


@pytest.mark.parametrize("flag", ["live", "linear"])
def test_what_is_neither_true_nor_false_is_refused(flag: str) -> None:
    with pytest.raises(TypeError, match=rf"^{flag} is True or False, not 'no'$"):
        Prairie.load("plain", **{flag: "no"})  # type: ignore[arg-type]


def test_entities_that_are_no_mapping_are_refused(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"^entities are a mapping, of those in the state to yours, unlike 3$"):
        prairie.restore(prairie.state(), 3)  # type: ignore[arg-type]


def test_a_state_is_restored_partly_or_not(prairie: Prairie) -> None:
    with pytest.raises(TypeError, match=r"^partly is True or False, not 'yes'$"):
        prairie.restore(prairie.state(), partly="yes")  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("hold", r"'hold' of a Prairie cannot be set, as it has none, did you mean 'governor.hold'\?"),
        ("presett", r"'presett' of a Prairie cannot be set, as it has none, did you mean 'preset'\?"),
        ("xylophone", "'xylophone' of a Prairie cannot be set, as it has none"),
    ],
)
def test_an_attribute_that_there_is_not_is_refused_and_told(prairie: Prairie, name: str, told: str) -> None:
    with pytest.raises(AttributeError, match=f"^{told}$"):
        setattr(prairie, name, 0.02)
    with pytest.raises(AttributeError, match=r"^'holds' of a Governor cannot be set.*did you mean 'hold'\?$"):
        prairie.governor.holds = 0.02  # type: ignore[attr-defined]


def test_a_double_replaces_what_there_is_and_a_games_own_class_has_attributes_of_its_own(
    prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    class Land(Prairie):
        def __init__(self, loaded: LoadedScene) -> None:
            super().__init__(loaded)
            self.owner = "me"

    monkeypatch.setattr(prairie, "draw", print)
    land = Land(prairie.loaded)
    land.rent = 3  # type: ignore[attr-defined]
    land.release()


def test_heights_too_large_for_single_precision_are_told_as_what_they_are(prairie: Prairie) -> None:
    with pytest.raises(ValueError, match=r"not numbers as large as 1e\+300$"):
        prairie.set_heights((0.0, 0.0), np.full((2, 2), 1e300))
