"""Fixtures of tests of winds: responses of two kinds of grass, and the messages of winds."""

from collections.abc import Callable

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Grass, Mixing, WindPrimitive, WindSource
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.record import Response
from tallgrass.systems.grow.response import grow_response
from tallgrass.systems.wind.blow import blowing, hear, lone_receivers
from tallgrass.systems.wind.quarantine import Quarantine

Answer = Callable[..., Grass]
Feel = Callable[..., Floats]


@pytest.fixture(scope="session")
def responses() -> list[Response]:
    """Responses of a tall soft kind and of a short stiff one."""
    return [grow_response(GrassKind(height=[0.7, 0.9], stiffness=0.6)), grow_response(GrassKind(stiffness=3.0))]


@pytest.fixture(scope="session")
def answer(responses: list[Response]) -> Answer:
    """Return the function that makes `Grass` of one of the two kinds at a number of receivers: `answer(40, kind=1)`."""

    def of(count: int, *, kind: int = 0) -> Grass:
        return Grass(
            np.full(count, kind, np.intp),
            np.array([response.step for response in responses], np.float32),
            np.stack([response.rise for response in responses]),
            np.stack([response.fall for response in responses]),
        )

    return of


@pytest.fixture(scope="session")
def feel(answer: Answer) -> Feel:
    """Return the function that computes messages of winds, shape (n, 2): `feel(Gust(), place=place, time=2.0)`."""

    def at(
        *winds: WindPrimitive,
        place: Floats,
        time: float,
        seed: int = 7,
        kind: int = 0,
        mixing: Mixing = "priority",
        names: list[str] | None = None,
        poses: list[Pose | None] | None = None,
    ) -> Floats:
        called = names or [f"wind[{number}] {wind.kind}" for number, wind in enumerate(winds)]
        sources = [WindSource(wind, name) for wind, name in zip(winds, called, strict=True)]
        quarantine = Quarantine()
        now = blowing(sources, quarantine, time=time, seed=seed, poses=poses or [])
        receivers = lone_receivers(place, answer(len(place), kind=kind))
        message = hear(now, receivers, quarantine, time=time, seed=seed, mixing=mixing)
        assert not quarantine.reasons
        return message

    return at
