"""`check_wind`: correct winds pass, and each wrong answer of a wind gives one sentence."""

import random
from time import sleep, thread_time
from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Extent, Grass, WindPrimitive
from tallgrass.engine.installed import OURS
from tallgrass.engine.plugins import wind_kinds
from tallgrass.systems.wind.gust import Gust
from tallgrass.testing import check_wind, wind_problems

HALF = 2.0


class Square(WindPrimitive):
    """A correct wind, which blows along +x in a square of 4 m."""

    kind: str = "square"
    """A square of wind."""

    def extent(self, *, time: float) -> Any:
        return Extent(-HALF, HALF, -HALF, HALF)

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return (np.abs(place) <= HALF).all(axis=1).astype(np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.stack([np.full(len(place), 0.5), np.zeros(len(place))], 1)


BUILT_IN = [row.name for row in wind_kinds().provided() if row.distribution == OURS]


@pytest.mark.parametrize("kind", BUILT_IN)
def test_d5_every_built_in_wind_passes_as_a_plugin(kind: str) -> None:
    check_wind(wind_kinds().find(kind))


def test_d5_all_four_winds_of_the_paper_are_among_them() -> None:
    assert {"breeze", "gust", "whirlwind", "blast"} <= set(BUILT_IN)


@pytest.mark.parametrize("wind", [Gust(every=[1.0, 2.0], wander=5.0), Gust(start=3.0, stop=3.5), Square(start=7.0)])
def test_a_wind_with_other_values_than_its_defaults_can_be_checked(wind: WindPrimitive) -> None:
    assert wind_problems(wind, seed=12) == []


def test_a_right_wind_has_no_problems() -> None:
    assert wind_problems(Square) == []


CALLS: list[float] = []
"""Memory of the impure winds below."""


@pytest.fixture(autouse=True)
def _nothing_is_remembered() -> None:
    CALLS.clear()


def _keep_busy(seconds: float) -> None:
    end = thread_time() + seconds
    while thread_time() < end:
        pass


class Outside(Square):
    """Its extent is too small."""

    def extent(self, *, time: float) -> Any:
        return Extent(-1.0, 1.0, -1.0, 1.0)


class Overweight(Square):
    """Its weights are too large."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return super().mask(place, time=time) * 1.5


class Overstrong(Square):
    """Its messages are longer than 1."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full_like(place, 0.9)


class Undefined(Square):
    """It divides by a distance that may be 0."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return place / np.linalg.norm(place, axis=1, keepdims=True)


class Hidden(Square):
    """It returns NaN."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.where(place == 0.0, np.nan, 0.5)


class Listed(Square):
    """It returns no array."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return [1.0] * len(place)


class Column(Square):
    """It returns a column."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return super().mask(place, time=time)[:, None]


class Worded(Square):
    """It returns words."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full(place.shape, "strong")


class Tossed(Square):
    """Its answers are random."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return super().mask(place, time=time) * random.random()  # noqa: S311 - that is what is wrong with it


class Averaged(Square):
    """Its answer for a receiver depends on the other receivers."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return 0.1 * (place - place.mean(axis=0)) if len(place) else place


class Ordered(Square):
    """Its answer depends on the position in the array."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.linspace(0.0, 0.5, place.size).reshape(place.shape)


class Remembering(Square):
    """Its answer depends on the latest time asked for."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        CALLS.append(time)
        return super().mask(place, time=time) / (1.0 + max(CALLS))


class Writing(Square):
    """It writes to the given places."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        weight = super().mask(place, time=time)
        place += 1.0
        return weight


class Crowded(Square):
    """It fails for no receivers."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full_like(place, 0.3 + 0.0 * place[0, 0])


class Brief(Square):
    """It ends in an error after a minute."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full_like(place, [0.5, 0.4][int(time > 60.0) * 2])


class Slow(Square):
    """It is slow for many receivers."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        _keep_busy(0.025 if len(place) > 5000 else 0.0)
        return np.full_like(place, 0.5)


class Slower(Square):
    """It is slow for any number of receivers."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        CALLS.append(time)
        _keep_busy(0.025)
        return super().mask(place, time=time)


class Imported(Square):
    """It is slow at first."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        CALLS.append(time)
        _keep_busy(0.1 if len(CALLS) == 1 else 0.0)
        return super().mask(place, time=time)


class Waiting(Square):
    """It waits for something that keeps the processor free."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        sleep(0.025 if len(place) > 5000 else 0.0)
        return np.full_like(place, 0.5)


class Narrow(Square):
    """It fails for some seeds."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        np.array([seed], np.uint32).astype(np.int32)
        return np.full_like(place, 0.1 if seed < 2**31 else 1.1)


@pytest.mark.parametrize(
    ("wind", "problem"),
    [
        (Outside, r"mask is not 0 at \(.*\), outside the extent \(at 0 s\)"),
        (Overweight, r"mask returned weights from 0 to 1\.5, not within 0 and 1 \(at 0 s\)"),
        (Overstrong, r"action returned a posture index of 1\.27279, which is over 1 \(at 0 s\)"),
        (Undefined, r"action raised FloatingPointError: invalid value .* \(at 0 s, \d+ receivers\)"),
        (Hidden, r"action returned what is not finite for \(.*\) \(at 0 s\)"),
        (Listed, r"mask returned list where an array of shape \(\d+,\) is due \(at 0 s\)"),
        (Column, r"mask returned an array of shape \(\d+, 1\) where an array of shape \(\d+,\) is due \(at 0 s\)"),
        (Worded, r"action returned <U6, which is no number \(at 0 s\)"),
        (
            Averaged,
            r"action answers differently for the same receivers when they are asked without some of the others .*",
        ),
        (Ordered, r"action answers differently for the same receivers when they are asked in another order \(at 0 s\)"),
        (Remembering, r"it keeps something between calls: at .* s it answers differently after other times"),
        (Writing, r"mask changes the places it is given \(at 0 s\)"),
        (Crowded, r"action raised IndexError: .* \(at 0 s, 0 receivers\)"),
        (Brief, r"action raised IndexError: .* \(at 61\.7 s, \d+ receivers\)"),
        (Slow, r"it takes \d+ ms of processor time for 10,000 receivers \(at .* s\), over 20 ms"),
        (Slower, r"mask takes \d+ ms of processor time \(at 0 s, \d+ receivers\), over 20 ms"),
        (Narrow, r"action returned a posture index of 1\.55563, which is over 1 \(at 0 s\)"),
    ],
)
def test_d5_what_is_wrong_with_a_winds_answers_is_one_sentence(wind: type[WindPrimitive], problem: str) -> None:
    with pytest.raises(AssertionError, match=f"^{problem}$"):
        check_wind(wind)


def test_the_check_stops_at_the_first_slow_answer() -> None:
    assert len(wind_problems(Slower)) == 1
    assert len(CALLS) == 2


def test_a_first_call_may_be_slow_and_waiting_costs_nothing() -> None:
    assert wind_problems(Imported) == wind_problems(Waiting) == []


def test_what_is_thrown_by_dice_is_told_first() -> None:
    told = wind_problems(Tossed)
    assert told[0] == "mask answers differently when it is asked again (at 0 s)"
