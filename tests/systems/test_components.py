"""Components on a game's entities: shared winds, poses that are not finite, wrong types; and worlds (D2)."""

from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest

from tallgrass import Footprint, Gust, Hover, Lamp, Pose, Presser, Road, Shade, Tree, WindSource
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.blast import Blast
from tallgrass.testing import LITTLE, little_prairie, watch

NOWHERE: list[tuple[Any, ...]] = [("a", 0), (None, 0.0), (np.nan, 0.0), (0.0, np.inf), (0.0, 0.0, np.nan)]


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world  # it is made the current one
    with little_prairie() as made:
        yield made


def test_d2_one_source_on_two_entities_blows_at_both_places(prairie: Prairie) -> None:
    source, places = WindSource(Blast(), "twice"), [(-8.0, 3.0), (8.0, 3.0)]
    for x, z in places:
        esper.create_entity(source, Pose(x, z - 1.0))
    assert np.linalg.norm(prairie.wind_at(places), axis=1).min() > 0.1


@pytest.mark.parametrize("pose", [Pose(*place) for place in NOWHERE], ids=str)
def test_d2_a_pose_that_is_nowhere_leaves_out_its_entity_until_it_has_another_and_is_told_once(
    prairie: Prairie, caplog: pytest.LogCaptureFixture, pose: Pose
) -> None:
    where, calm = [(0.0, 0.5)], prairie.wind_at([(0.0, 0.5)])
    wind = esper.create_entity(WindSource(Blast(), "lost"), pose)
    presser, bare = esper.create_entity(Presser(radius=0.8), pose), esper.create_entity(Presser())
    tree = esper.create_entity(Tree("oak"))
    for _ in range(3):
        prairie.advance(0.1)
        watch(prairie)
        np.testing.assert_array_equal(prairie.wind_at(where), calm)
        np.testing.assert_array_equal(prairie.bent_at(where), calm)
    due = "x, y, z [m] and yaw [rad] are finite numbers, at most 1e+06 either way"
    pressers = (f"presser of entity {presser}", pose), (f"presser of entity {bare}", "no Pose")
    lost = (*pressers, (f"tree of entity {tree}", "no Pose"), (f"wind of entity {wind}", pose))
    assert sorted(caplog.messages) == [f"the {what} is left out while it has {have}: {due}" for what, have in lost]
    esper.add_component(wind, Pose())
    assert prairie.wind_at(where).any()
    esper.add_component(wind, Pose(50.0, 0.0))
    esper.add_component(presser, Pose())
    assert prairie.bent_at(where).any()


def test_d2_many_that_are_nowhere_are_told_of_in_one_sentence(
    prairie: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    first, *_ = [esper.create_entity(Presser()) for _ in range(20)]
    for _ in range(3):
        watch(prairie)
    assert [message.split(":")[0] for message in caplog.messages] == [
        f"the presser of entity {first} is left out while it has no Pose, and 19 more likewise"
    ]


@pytest.mark.parametrize(
    ("what", "said"),
    [
        (("gust", "n"), r"a WindSource carries a wind such as Gust\(\), not its name 'gust'"),
        ((Gust, "n"), r"a WindSource carries a wind such as Gust\(\), not the class Gust"),
        ((None, "n"), r"a WindSource carries a wind such as Gust\(\), not None"),
        ((Gust(), 5), "a wind's name is a text such as 'north', not 5"),
    ],
)
def test_d2_a_source_of_no_wind_is_refused_where_it_is_made(what: tuple[Any, Any], said: str) -> None:
    with pytest.raises(TypeError, match=f"^{said}$"):
        WindSource(*what)


def test_d2_a_prairie_says_that_its_world_was_deleted_and_nothing_else(caplog: pytest.LogCaptureFixture) -> None:
    host, scene = esper.current_world, f"{LITTLE}wind: [{{ kind: breeze }}]\npressers: [{{}}]\n"
    esper.switch_world("short-lived")
    try:
        with little_prairie(scene=scene) as prairie:
            watch(prairie)
            esper.switch_world(host)
            esper.delete_world("short-lived")
            for ask in (prairie.wind_at, prairie.bent_at, lambda _: watch(prairie)):
                with pytest.raises(RuntimeError, match=r"^esper world 'short-lived', .* was deleted: load it again$"):
                    ask([(0.0, 0.0)])
            assert not caplog.messages
            esper.switch_world("short-lived")
            assert prairie.bent_at([(0.0, 0.1)]).any(), "a world of the same name is one that was cleared"
    finally:
        esper.switch_world(host)
        if "short-lived" in esper.list_worlds():
            esper.delete_world("short-lived")
    assert len(caplog.messages) == 1


def test_of_a_whole_array_in_place_of_a_number_one_line_shows_how_it_begins(prairie: Prairie) -> None:
    many: Any = np.zeros((9, 9))
    kind = next(iter(prairie.scene.grass))
    for ask in (
        lambda: Footprint(radius=many),
        lambda: Footprint(length=many),
        lambda: Road([(0, 0), (1, 1)], many),
        lambda: Presser(wear=many),
        lambda: Shade((0.0, 0.0, 0.0), many),
        lambda: Hover(height=many),
        lambda: prairie.cut(Footprint(), many),
        lambda: prairie.sow(kind, Footprint(), many),
        lambda: prairie.clear(many),
        lambda: setattr(prairie.governor, "hold", many),
    ):
        with pytest.raises((TypeError, ValueError), match=r"^[^\n]* array\(\[\[0[^\n]{,60}$"):
            ask()


def test_numbers_too_large_for_a_float_are_refused_as_any_out_of_range(prairie: Prairie) -> None:
    huge, kind = 10**400, next(iter(prairie.scene.grass))
    for ask in (
        lambda: Footprint(radius=huge),
        lambda: Footprint(corners=[(0, 0), (0, 1), (huge, 0)]),
        lambda: Road([(0, 0), (1, huge)]),
        lambda: Presser(wear=huge),
        lambda: Lamp(candela=huge),
        lambda: Tree("oak", height=huge),
        lambda: Shade((0.0, 0.0, huge), 1.0),
        lambda: prairie.cut(Footprint(), -huge),
        lambda: prairie.sow(kind, Footprint(), huge),
        lambda: prairie.clear(Footprint(), soft=huge),
        lambda: prairie.change_kind(kind, tip="#ffffff", over=huge),
    ):
        with pytest.raises(ValueError, match=r" not \S"):
            ask()
    before = prairie.grass_at([(0.0, 0.0)]).height
    prairie.cut(Footprint(), huge)  # that high it is cut, and grows
    prairie.cut(Footprint(), 1e308)
    prairie.grow(Footprint(), huge)
    assert prairie.grass_at([(0.0, 0.0)]).height == before
