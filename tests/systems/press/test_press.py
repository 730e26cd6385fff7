"""Pressing: trails cut into stretches, and grass that lies down and stands up again (F4)."""

import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.presser import Presser
from tallgrass.systems.press import marks
from tallgrass.systems.press.footprint import discs_of
from tallgrass.systems.press.lie import combined_message, pressed, touches
from tallgrass.systems.press.marks import MOST_MARKS, UNTRODDEN, Marks, Memory, Trodden
from tallgrass.systems.press.trail import REACH_RADII, Discs, Trail
from tallgrass.testing.trial import grass_at

Way = Callable[[float], tuple[float, float]]

RADIUS, RECOVERY = 0.4, np.full(4, 20.0, np.float32)


GRASS = grass_at(np.zeros((1, 2), np.float32))


def discs_at(*place: tuple[float, float], radius: float = RADIUS, strength: float = 1.0) -> Discs:
    count = len(place)
    facing = np.tile([0.0, -1.0], (count, 1))
    return Discs(np.array(place, np.float64), facing, np.full(count, radius), np.full(count, strength))


def walked(*ways: Way, until: float, steps: int, lasts: float = 60.0) -> Trodden:
    """Return the trails of moving discs at a time, noted in a number of steps."""
    trail = Trail()
    memory, none, found = Memory([trail], lasts), np.zeros(0, np.intp), UNTRODDEN
    for number in range(steps + 1):
        time = until * number / steps
        discs = discs_at(*(way(time) for way in ways))
        if number == 0:
            trail.keep(none, none, discs, time)
        trail.tread(discs, time)
        found = memory.at(time)
    return found


def read(marks: Marks) -> tuple[NDArray[np.float32], NDArray[np.int32], NDArray[np.int32]]:
    """Return the tables that a receiver reads: marks, their number on each square, and their indices."""
    lists = [marks.listed[first : first + count] for first, count in zip(marks.first, marks.count, strict=True)]
    return marks.marks, marks.count, np.concatenate(lists)


def felt(trodden: Trodden, place: object) -> Floats:
    at = np.array(place, np.float32).reshape(-1, 2)
    return pressed(trodden, at, grass_at(at), RECOVERY)


def east(time: float) -> tuple[float, float]:
    """Return the place at a time [s] of a walk to the right along z = 0, through the origin at 2 s."""
    return 1.5 * (time - 2.0), 0.0


def east_for(seconds: float) -> Way:
    """Return the way of a walk to the right that stops after a time [s]."""
    return lambda time: east(min(time, seconds))


def test_f4_under_a_presser_grass_lies_down_and_beside_it_it_bends_aside() -> None:
    trodden = walked(east, until=2.0, steps=120)
    ahead, under, left, right, beyond = felt(trodden, [(0.3, 0.0), (0.0, 0.0), (0.0, -0.45), (0.0, 0.45), (0.0, 0.7)])
    assert np.linalg.norm(under) > 0.99
    assert ahead[0] > 0.9
    assert abs(ahead[1]) < 1e-6
    assert left[1] < -0.25 < 0.25 < right[1]
    assert np.abs(beyond).max() == 0.0


def test_r3_many_who_walk_in_step_take_as_many_steps_of_the_program_as_two() -> None:
    def calls(count: int) -> int:
        trail, none, called = Trail(), np.zeros(0, np.intp), list[str]()
        trail.keep(none, none, discs_at(*[(0.0, float(number)) for number in range(count)]), 0.0)
        sys.setprofile(lambda _, event, __: called.append(event))
        try:
            trail.tread(discs_at(*[(1.0, float(number)) for number in range(count)]), 0.5)
        finally:
            sys.setprofile(None)
        assert sum(map(len, trail.closed)) == 3 * count
        return len(called)

    assert calls(200) == calls(2)


def test_f4_beside_a_way_grass_swings_past_rest_as_its_kind_answers_and_comes_to_rest() -> None:
    place, walk = (0.0, 0.55), walked(east_for(4.0), until=4.0, steps=240)
    pressed_at_first = float(felt(walked(east, until=2.0, steps=120), place)[0, 1])
    since = 2.0 + float(np.sqrt((REACH_RADII * RADIUS) ** 2 - 0.55**2)) / 1.5
    course = [float(felt(replace(walk, time=time), place)[0, 1]) for time in np.linspace(since + 0.01, 12.0, 300)]
    assert pressed_at_first > 0.25
    assert course[0] > 0.9 * pressed_at_first
    # It goes as far past rest as the response does, less what stays trodden.
    lowest = float(GRASS.fall[GRASS.kind[0]].min())
    assert lowest * pressed_at_first <= min(course) < 0.7 * lowest * pressed_at_first < 0.0
    assert abs(course[-1]) < 0.01


def test_f4_a_way_stays_trodden_until_its_recovery_is_over() -> None:
    walk, index = walked(east_for(4.0), until=4.0, steps=240), dict[float, float]()
    for after in (6.0, 10.0, 13.0, 20.0):
        index[after] = float(np.linalg.norm(felt(replace(walk, time=2.0 + after), (0.0, 0.0))))
    assert index[6.0] > 0.5
    assert index[6.0] > index[10.0] > index[13.0]
    assert index[20.0] < 0.01


def test_f4_where_many_walk_grass_lies_flatter_and_for_longer() -> None:
    once = walked(east_for(9.0), until=12.0, steps=300)
    ways = [lambda time, late=late: east(min(max(time - late, 0.0), 9.0 - late)) for late in (0.0, 1.0, 2.0)]
    thrice = walked(*ways, until=12.0, steps=300)
    assert np.linalg.norm(felt(thrice, (0.0, 0.0))) > np.linalg.norm(felt(once, (0.0, 0.0))) + 0.1


@settings(deadline=None, max_examples=25)
@given(
    speed=st.floats(0.3, 9.0),
    yaw=st.floats(0.0, 6.28),
    until=st.floats(0.5, 6.0),
    few=st.integers(7, 40),
    many=st.integers(41, 200),
)
def test_f4_what_is_trodden_depends_on_the_way_and_not_on_the_steps(
    speed: float, yaw: float, until: float, few: int, many: int
) -> None:
    def way(time: float) -> tuple[float, float]:
        return speed * time * float(np.sin(yaw)), -speed * time * float(np.cos(yaw))

    along = np.random.default_rng(3).uniform(-0.5, speed * until + 0.5, 300)
    aside = np.random.default_rng(4).uniform(-0.8, 0.8, 300)
    heading = np.array([np.sin(yaw), -np.cos(yaw)])
    place = along[:, None] * heading + aside[:, None] * np.array([-heading[1], heading[0]])
    one, other = (felt(walked(way, until=until, steps=steps), place) for steps in (few, many))
    assert np.abs(one).max() > 0.3
    # Where two stretches meet, rounding may say which of both is nearest: that turns a message by very little.
    assert np.abs(one - other).max() < 2e-3
    assert np.abs(one - other).mean() < 1e-5


def test_f4_grass_is_held_down_for_as_long_as_somebody_stands_there() -> None:
    def way(time: float) -> tuple[float, float]:
        return (1.5 * time, 0.0) if time < 1.0 else (1.5, 0.0) if time < 6.0 else (1.5 + 1.5 * (time - 6.0), 0.0)

    held, left = (walked(way, until=time, steps=round(60 * time)) for time in (6.0, 7.6))
    assert np.linalg.norm(felt(held, (1.3, 0.3))) > 0.5
    assert np.linalg.norm(felt(left, (1.3, 0.45))) < 0.4 * np.linalg.norm(felt(held, (1.3, 0.45)))


def test_f4_who_jumps_treads_on_nothing_between() -> None:
    trodden = walked(lambda time: (0.0, 0.0) if time < 1.0 else (20.0, 0.0), until=1.5, steps=45)
    here, between, there = np.linalg.norm(felt(trodden, [(0.0, 0.0), (10.0, 0.0), (20.0, 0.0)]), axis=1)
    assert min(here, there) > 0.5
    assert between == 0.0


def test_f4_of_more_who_walk_over_a_place_than_are_kept_the_latest_count() -> None:
    def around(time: float) -> tuple[float, float]:
        return 0.5 * float(np.cos(9.0 * time)), 0.5 * float(np.sin(9.0 * time))

    trodden = walked(around, until=16.0, steps=400)
    assert trodden.settled.count.max() == MOST_MARKS
    assert np.linalg.norm(felt(trodden, around(16.0))) > 0.9


def test_f4_what_counts_in_no_square_any_more_is_forgotten() -> None:
    def around(time: float) -> tuple[float, float]:
        return 0.5 * float(np.cos(9.0 * time)), 0.5 * float(np.sin(9.0 * time))

    shorter, longer = (walked(around, until=until, steps=round(20 * until), lasts=600.0) for until in (12.0, 24.0))
    assert len(longer.settled.marks) < 1.2 * len(shorter.settled.marks)
    assert len(longer.settled.listed) < 1.2 * len(shorter.settled.listed)


def test_f4_nobody_is_remembered_for_longer_than_is_asked() -> None:
    trodden = walked(east_for(4.0), until=30.0, steps=300, lasts=8.0)
    assert len(trodden.settled.marks) == 0
    assert not touches(trodden.settled, np.zeros((1, 2), np.float32))


def test_f4_where_grass_is_pressed_the_wind_is_covered_as_much() -> None:
    wind = np.array([[0.0, 0.5], [0.0, 0.5], [0.0, 0.5]], np.float32)
    pressing = np.array([[0.0, 0.0], [0.5, 0.0], [1.0, 0.0]], np.float32)
    np.testing.assert_allclose(combined_message(wind, pressing), [[0.0, 0.5], [0.5, 0.25], [1.0, 0.0]], atol=1e-6)


@pytest.mark.parametrize(
    ("presser", "inside", "outside"),
    [
        (Presser(radius=0.5), [(0.3, 0.3)], [(0.8, 0.0)]),
        (Presser(radius=0.3, length=2.0), [(0.0, 1.1), (0.0, -1.1), (0.2, 0.4)], [(0.6, 0.0), (0.0, 1.6)]),
        (
            Presser(corners=((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))),
            [(0.0, 0.0), (0.7, 0.7), (-0.7, 0.6)],
            [(1.6, 0.0), (0.0, -1.6)],
        ),
        (
            Presser(corners=((-0.05, -0.9), (0.05, -0.9), (0.05, 0.9), (-0.05, 0.9))),
            [(0.0, 0.05 * step) for step in range(-16, 17)],
            [(0.2, 0.0), (0.0, 1.2)],
        ),
        (
            Presser(corners=((0.0, 0.0), (4.0, 4.0), (3.99, 4.01))),
            [(0.04, 0.04), (3.87, 3.88)],
            [(1.0, 0.5), (-0.2, -0.2)],
        ),
    ],
    ids=["disc", "capsule", "polygon", "thin polygon", "sliver"],
)
def test_f4_a_footprint_is_made_of_discs_that_fill_it(
    presser: Presser, inside: list[tuple[float, float]], outside: list[tuple[float, float]]
) -> None:
    discs = discs_of(presser)

    def covered(place: tuple[float, float], part: float) -> bool:
        return bool((np.hypot(*(discs[:, :2] - place).T) < part * discs[:, 2]).any())

    assert all(covered(place, 1.0) for place in inside)
    assert not any(covered(place, REACH_RADII) for place in outside)


@pytest.mark.parametrize(
    "values",
    [
        {"radius": 0.0}, {"radius": "0.3"}, {"length": -1.0}, {"length": None}, {"strength": 1.5}, {"strength": "all"},
        {"corners": ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0))}, {"corners": np.zeros((3, 3))}, {"corners": None},
    ],
)  # fmt: skip
def test_f4_what_is_no_footprint_is_refused(values: dict[str, object]) -> None:
    with pytest.raises(ValueError, match=r"footprint|strength"):
        Presser(**values)  # type: ignore[arg-type]


def test_f4_corners_may_stand_in_lists_and_in_arrays() -> None:
    square = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    for corners in ([*map(list, square)], np.array(square), np.array(square, np.float32)):
        presser = Presser(corners=corners)
        assert hash(presser) == hash(Presser(corners=square))
        np.testing.assert_array_equal(discs_of(presser), discs_of(Presser(corners=square)))


def test_what_settles_is_told_a_little_in_each_frame_and_comes_to_what_it_is_told_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    converted: list[int] = []

    def counted(stretches: NDArray[np.float64], since: float) -> NDArray[np.float32]:
        converted[-1] += len(stretches)
        return convert(stretches, since)

    convert = marks.as_marks
    monkeypatch.setattr(marks, "as_marks", counted)
    random, trail = np.random.default_rng(4), Trail()
    middle, none, count = random.uniform(-30.0, 30.0, (300, 2)), np.zeros(0, np.intp), 0
    memory, radius = Memory([trail], 12.0), np.full(300, 0.2)
    for frame in range(20 * 60):
        time = frame / 60.0
        converted.append(0)
        place = middle + 5.0 * np.stack([np.cos(middle[:, 0] + 0.6 * time), np.sin(middle[:, 0] + 0.6 * time)], axis=1)
        discs = Discs(place, np.tile([1.0, 0.0], (300, 1)), radius, np.ones(300))
        if not frame:
            trail.keep(none, none, discs, time)
        trail.tread(discs, time)
        trodden = memory.at(time)
        if frame % 60 in (0, 7):
            converted.append(0)
            at_once = marks.Listing(memory.kept, *marks.touched_squares(memory.kept)).marks(since=memory.since)
            converted.pop()
            if len(memory.kept):
                for one, other in zip(read(trodden.settled), read(at_once), strict=True):
                    np.testing.assert_array_equal(one, other)
                count += 1
    assert count > 25
    kept = len(memory.kept)
    assert kept > 20_000
    assert max(converted[-240:]) < 0.25 * kept
