"""Winds that a game changes while they blow: their phases stay continuous (W5, W7, D6)."""

from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Doubles, Floats
from tallgrass.components.course import MOST_CHANGES, Course
from tallgrass.components.wind import Grass, WindPrimitive, WindSource
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.blow import hear
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind
from tallgrass.systems.winds import KEPT
from tallgrass.testing import little_prairie
from tallgrass.testing.twins import CLOSE_TWIN, CardEar

HOUR, FRAME = 3600.0, 1.0 / 30.0
FIELD = np.random.default_rng(1).uniform(-4.0, 4.0, (300, 2)).astype(np.float32)


class Swirl(WindPrimitive):
    """A plugin's wind that beats at a rate."""

    kind: str = "swirl"
    swing: float = 0.0
    beat: float = 0.5

    def rates(self) -> tuple[float]:
        return (self.beat,)

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        turn = 2.0 * np.pi * self.phases(time=time)[0]
        return np.full_like(place, [0.4 * np.cos(turn), 0.4 * np.sin(turn)])


RAMPS: dict[str, Callable[[float], WindPrimitive]] = {
    "a breeze's speed": lambda part: Breeze(swing=0.0, direction=60.0, speed=4.0 + part),
    "a breeze's direction": lambda part: Breeze(swing=0.0, direction=60.0 + 10.0 * part),
    "a turbulence's speed": lambda part: Turbulence(swing=0.0, direction=60.0, speed=4.0 + part),
    "a turbulence's direction": lambda part: Turbulence(swing=0.0, direction=60.0 + 10.0 * part),
    "how fast a whirlwind turns": lambda part: Whirlwind(swing=0.0, turning=0.35 + 0.1 * part, ease=0.0),
    "how fast gusts go": lambda part: Gust(
        swing=0.0, speed=8.0 + part, every=[3.0, 4.0], reach=120.0, position=[-60.0, 0.0]
    ),
    "how fast a plugin's wind beats": lambda part: Swirl(beat=0.5 + 0.1 * part),
}


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world
    with little_prairie() as made:
        yield made


def blow(prairie: Prairie, ramp: Callable[[float], WindPrimitive], *, to: float, entity: int) -> Doubles:
    """Return the messages in 10 s in which a game changes a wind a little in every frame, shape (frames, n, 2)."""
    felt = []
    for frame in range(300):
        esper.add_component(entity, WindSource(ramp(to * frame / 300.0), "wind"))
        felt.append(prairie.wind_at(FIELD))
        prairie.advance(FRAME)
    return np.asarray(felt, np.float64)


@pytest.mark.parametrize("what", RAMPS)
def test_w7_a_wind_that_a_game_changes_goes_on_from_where_it_is_an_hour_into_the_game(
    prairie: Prairie, what: str
) -> None:
    """Messages change no faster than in a constant wind with the mean values of this one."""
    prairie.advance(HOUR)
    ways: list[Callable[[float], WindPrimitive]] = [lambda _: RAMPS[what](0.5), RAMPS[what]]
    changes = []
    for way in ways:
        entity = esper.create_entity(WindSource(way(0.0), "wind"))
        felt = blow(prairie, way, to=1.0, entity=entity)
        changes.append(float(np.linalg.norm(np.diff(felt, axis=0), axis=2).mean()))
        esper.delete_entity(entity, immediate=True)
    assert changes[0] > 1e-4
    assert changes[1] < (1.05 if "turbulence" in what else 1.25) * changes[0]  # few of its waves come in 10 s


@pytest.mark.parametrize("what", RAMPS)
def test_n4_the_card_hears_a_wind_that_was_changed_as_numpy_does(
    prairie: Prairie, ctx: moderngl.Context, what: str
) -> None:
    prairie.advance(HOUR)
    entity = esper.create_entity()
    for part in (0.0, 0.3, 1.0):
        esper.add_component(entity, WindSource(RAMPS[what](part), "wind"))
        prairie.wind_at(FIELD)
        prairie.advance(3.0)
    now, receivers = prairie.winds.acting(prairie.time), prairie.winds.receivers_at(FIELD, kind=None)
    assert [wind.primitive.course is not None for wind in now] == [True] * len(now) != []
    ear = CardEar(ctx, receivers.grass)
    found = ear.hear(now, receivers, prairie.winds.quarantine, time=prairie.time, seed=1, mixing="weight")
    due = hear(now, receivers, prairie.winds.quarantine, time=prairie.time, seed=1, mixing="weight")
    ear.release()
    assert np.abs(found - due).max() <= CLOSE_TWIN


@pytest.mark.parametrize("steps", [1, 7])
def test_d6_a_wind_that_nobody_changes_is_the_same_to_the_bit_however_time_is_cut(prairie: Prairie, steps: int) -> None:
    entity = esper.create_entity(WindSource(Breeze(speed=4.0), "wind"))
    alone = prairie.winds.messages_at(FIELD, time=20.0)
    for _ in range(10 * steps):
        prairie.advance(1.0 / steps)
        prairie.wind_at(FIELD[:1])
    esper.add_component(entity, WindSource(Breeze(speed=4.0), "wind"))
    for _ in range(10 * steps):
        prairie.advance(1.0 / steps)
        prairie.wind_at(FIELD[:1])
    np.testing.assert_array_equal(prairie.wind_at(FIELD), alone)


def test_what_was_felt_before_a_change_is_what_is_asked_of_the_past(prairie: Prairie) -> None:
    entity = esper.create_entity(WindSource(Breeze(speed=4.0), "wind"))
    before = [prairie.wind_at(FIELD, time) for time in (0.0, 3.0, 9.0)]
    prairie.advance(10.0)
    here = prairie.wind_at(FIELD)
    esper.add_component(entity, WindSource(Breeze(speed=9.0), "wind"))
    np.testing.assert_array_equal([prairie.wind_at(FIELD, time) for time in (0.0, 3.0, 9.0)], before)
    np.testing.assert_allclose(prairie.wind_at(FIELD), here, atol=1e-5)
    later = prairie.wind_at(FIELD, 14.0)
    prairie.advance(4.0)
    np.testing.assert_array_equal(prairie.wind_at(FIELD), later)


def test_w7_a_gust_keeps_its_place_when_its_speed_changes_and_stays_until_its_grass_is_at_rest(
    prairie: Prairie,
) -> None:
    entity = esper.create_entity(WindSource(Gust(speed=4.0, reach=100.0), "wind"))
    prairie.advance(15.0)
    (before,) = prairie.winds.acting(15.0)
    esper.add_component(entity, WindSource(Gust(speed=8.0, reach=100.0), "wind"))
    (after,) = prairie.winds.acting(15.0)
    assert (after.pose.x, after.pose.z) == pytest.approx((before.pose.x, before.pose.z))
    assert before.pose.x == pytest.approx(60.0)
    (later,) = prairie.winds.acting(19.0)
    assert later.pose.x == pytest.approx(60.0 + 4.0 * 8.0)
    assert [len(prairie.winds.acting(time)) for time in (15.0 + 5.0 + 4.0, 15.0 + 5.3 + 4.0)] == [1, 0]


def test_gusts_that_a_game_added_are_gone_when_they_have_been_over_for_a_while(prairie: Prairie) -> None:
    """So a game may set one off every half a second for days."""
    handles = []
    for _ in range(200):
        handles.append(prairie.add(Gust(start=prairie.time, reach=10.0)))
        prairie.advance(1.0)
        prairie.wind_at(FIELD[:1])
    life = Gust(reach=10.0).life
    assert len(prairie.winds.sources()) == pytest.approx(KEPT + life, abs=2.0)
    assert len(prairie.winds.acting(prairie.time)) == pytest.approx(life, abs=1.0)
    for handle in handles:
        prairie.remove(handle)
    assert not prairie.winds.sources()


@pytest.mark.parametrize(
    ("rates", "why"),
    [
        (lambda: [1.0 / 0.0], "rates raised ZeroDivisionError: float division by zero"),
        (lambda: None, "rates returned NoneType, not Sequence"),
        (lambda: [float("nan")], "rates returned numbers that are not finite"),
    ],
    ids=["raised", "none", "not finite"],
)
def test_n8_a_wind_without_rates_is_left_out_for_its_rates_and_not_for_what_needs_them(
    prairie: Prairie, rates: Callable[[], Any], why: str
) -> None:
    class Odd(Swirl):
        def rates(self) -> Any:
            return rates()

    esper.create_entity(WindSource(Odd(), "odd"))
    esper.create_entity(WindSource(Breeze(), "breeze"))
    assert prairie.wind_at(FIELD).any()
    assert prairie.wind_failures == {"odd": f"odd: {why}"}


@given(
    st.lists(st.tuples(st.floats(0.0, 50.0), st.floats(-9.0, 9.0)), min_size=1, max_size=9),
    st.floats(0.0, 100.0),
    st.floats(0.0, 100.0),
)
def test_phases_are_the_integral_of_their_rates(changes: list[tuple[float, float]], since: float, until: float) -> None:
    course, changes = Course.of([2.0]), sorted(changes)
    for time, rate in changes:
        course = course.changed([rate], time=time)
    knots = [0.0, *(time for time, _ in changes), 1000.0]
    rates = [2.0, *(rate for _, rate in changes)]
    clipped = [np.clip(knots, None, end) for end in (until, since)]
    due = float(np.dot(np.diff(clipped[0]) - np.diff(clipped[1]), rates))
    assert course.phases(until, since=since) == pytest.approx((due,), abs=1e-9)


def test_a_course_remembers_the_latest_changes_and_forgets_what_was_to_come() -> None:
    course = Course.of([1.0])
    for number in range(MOST_CHANGES + 50):
        course = course.changed([1.0 + number % 2], time=float(number))
    assert len(course.times) == MOST_CHANGES
    again = course.changed([5.0], time=900.5)
    assert again.phases(901.5, since=900.5) == (5.0,)
    assert again.phases(899.0) == course.phases(899.0)
    assert again.times[-1] == 900.5
