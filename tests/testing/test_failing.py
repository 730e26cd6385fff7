"""Winds that fail in odd ways: the check reports each in a sentence, as the engine does, and never fails itself."""

from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.testing import wind_problems
from tallgrass.testing.trial import places_to_try


class UnspeakableError(Exception):
    def __str__(self) -> str:
        raise RuntimeError("there is nothing to say")


class Even(WindPrimitive):
    """A wind with one message everywhere."""

    kind: str = "even"
    """Its name."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, [0.3, 0.0])


class Unspeakable(Even):
    """The text of its error cannot be read."""

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        raise UnspeakableError


class Exhausted(Even):
    """Its error has no text."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        raise MemoryError


class Masked(Even):
    """Its mask is a masked array of numpy."""

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ma.masked_array(np.ones(len(place), np.float32), mask=True)


class Unmade(Even):
    """Its constructor raises an error whose text cannot be read."""

    def model_post_init(self, context: Any, /) -> None:
        raise UnspeakableError


@pytest.mark.parametrize(
    ("wind", "problem"),
    [
        (Unspeakable, "action raised UnspeakableError (at 0 s, {} receivers)"),
        (Exhausted, "mask raised MemoryError (at 0 s, {} receivers)"),
        (Masked, "mask returned MaskedArray where an array of shape ({},) is due (at 0 s)"),
        (Unmade, "Unmade cannot be made from its defaults alone: UnspeakableError"),
    ],
)
def test_d5_a_wind_that_fails_in_an_odd_way_is_one_sentence(wind: type[WindPrimitive], problem: str) -> None:
    (told,) = wind_problems(wind)
    assert told == problem.format(len(places_to_try(None)))
