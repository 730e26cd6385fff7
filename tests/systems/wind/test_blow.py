"""Blowing: winds and the receivers that hear them (W5, W11, D6)."""

from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from pydantic import Field

from tallgrass.components.arrays import Floats
from tallgrass.components.declaration import Pair
from tallgrass.components.wind import Grass, Mixing, WindPrimitive, WindSource
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers
from tallgrass.systems.wind.quarantine import Quarantine

PLACES = np.stack(np.meshgrid(np.linspace(-5, 5, 41), np.linspace(-5, 5, 41)), -1).reshape(-1, 2).astype(np.float32)


class Disc(WindPrimitive):
    """A wind with one message inside a circle."""

    kind: Literal["disc"] = "disc"
    centre: Pair = Field(default=[0.0, 0.0])
    radius: float = 2.0
    message: Pair = Field(default=[0.5, 0.0])
    swing: float = 0.0

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        away = np.linalg.norm(place - np.array(self.centre, np.float32), axis=1)
        return np.asarray(away <= self.radius + 0.0 * time, np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        assert (self.mask(place, time=time) > 0.0).all(), f"{self.kind} asked beyond its mask, seed {seed}"
        assert len(grass.kind) == len(place)
        return np.tile(np.array(self.message, np.float32), (len(place), 1))


class Silent(Disc):
    """A wind whose methods must never be called."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        raise AssertionError(f"asked at {time} s for {len(place)} places with seed {seed}, {grass}")


STILL = Grass(np.zeros(len(PLACES), np.intp), *np.ones((3, 1, 2), np.float32))


def told(
    sources: list[WindSource], rows: list[int] | None = None, *, time: float, mixing: Mixing = "priority"
) -> Floats:
    quarantine = Quarantine()
    winds = blowing(sources, quarantine, time=time, seed=0)
    at = np.arange(len(PLACES)) if rows is None else np.array(rows, np.intp)
    message = hear(winds, lone_receivers(PLACES[at], STILL.at(at)), quarantine, time=time, seed=0, mixing=mixing)
    assert not quarantine.reasons
    return message


def heard(*winds: WindPrimitive, time: float = 1.0, mixing: Mixing = "priority") -> Floats:
    sources = [WindSource(wind, f"wind[{number}] {wind.kind}") for number, wind in enumerate(winds)]
    return told(sources, time=time, mixing=mixing)


def inside(disc: Disc) -> NDArray[np.bool_]:
    return np.asarray(disc.mask(PLACES, time=0.0) > 0.0)


NORTH = Disc(centre=[-0.8, 0.0], message=[0.0, -0.7], priority=1)
EAST = Disc(centre=[0.8, 0.0], message=[0.4, 0.0], priority=2)


def test_w5_a_primitive_is_heard_inside_its_mask_and_nowhere_else() -> None:
    message = heard(EAST)
    assert (message[inside(EAST)] == np.array([0.4, 0.0], np.float32)).all()
    assert (message[~inside(EAST)] == 0.0).all()


@pytest.mark.parametrize("winds", [(NORTH, EAST), (EAST, NORTH)])
def test_w11_the_higher_priority_cancels_the_lower_and_leaves_no_trace_outside(winds: tuple[Disc, ...]) -> None:
    message, both = heard(*winds), inside(EAST) & inside(NORTH)
    assert both.any()
    np.testing.assert_array_equal(message[inside(EAST)], heard(EAST)[inside(EAST)])
    np.testing.assert_array_equal(message[~inside(EAST)], heard(NORTH)[~inside(EAST)])


def test_w11_what_is_cancelled_everywhere_is_as_if_it_were_not_there() -> None:
    everywhere = Disc(radius=100.0, message=[0.1, 0.2], priority=5)
    np.testing.assert_array_equal(heard(NORTH, everywhere, EAST), heard(everywhere))


def test_w11_a_primitive_whose_mask_holds_no_receiver_is_not_asked() -> None:
    np.testing.assert_array_equal(heard(NORTH, Silent(centre=[90.0, 0.0], priority=9)), heard(NORTH))


@given(st.permutations([0, 1, 2, 3]), st.lists(st.integers(-2, 2), min_size=4, max_size=4))
def test_w11_the_outcome_does_not_depend_on_the_order_in_which_winds_are_found(
    order: list[int], priorities: list[int]
) -> None:
    winds = [
        Disc(centre=[0.3 * number, 0.0], message=[0.1 * number, 0.3], priority=priority)
        for number, priority in enumerate(priorities)
    ]
    sources = [WindSource(wind, f"wind[{number}]") for number, wind in enumerate(winds)]
    first = told(sources, time=0.0)
    mixed = told([sources[number] for number in order], time=0.0)
    np.testing.assert_array_equal(first, mixed)


@pytest.mark.parametrize(("time", "blows"), [(0.0, False), (1.999, False), (2.0, True), (4.9, True), (5.0, False)])
def test_a_wind_blows_from_its_start_until_its_stop(time: float, *, blows: bool) -> None:
    message = heard(Disc(start=2.0, stop=5.0), time=time)
    assert (message != 0.0).any() == blows


def test_a_wind_without_a_stop_never_ends() -> None:
    assert (heard(Disc(), time=36000.0) != 0.0).any()


def test_without_any_wind_grass_is_at_rest() -> None:
    message = heard()
    assert message.shape == PLACES.shape
    assert (message == 0.0).all()


@given(st.lists(st.integers(0, len(PLACES) - 1), min_size=1, max_size=60))
def test_w1_each_receiver_hears_the_same_alone_as_among_others(rows: list[int]) -> None:
    alone = told([WindSource(NORTH, "a"), WindSource(EAST, "b")], rows, time=0.0)
    np.testing.assert_array_equal(alone, heard(NORTH, EAST)[rows])
