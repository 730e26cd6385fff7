"""Costs of winds grow with the ground that they cover (W5)."""

from collections.abc import Callable
from time import thread_time_ns

import numpy as np
from numpy.typing import NDArray

from tallgrass.components.wind import Grass, WindPrimitive, WindSource
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import ReceiverArrays, blowing, hear
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.turbulence import Turbulence
from tallgrass.systems.wind.whirlwind import Whirlwind

Answer = Callable[..., Grass]

OTHERS: list[WindPrimitive] = [
    Gust(position=[-3.0, -9.0], width=6.0, speed=3.0, hold=0.5, tail=1.0, start=1.5, ragged=0.5),
    Whirlwind(position=[3.0, -16.0], radius=2.5),
    Blast(position=[2.5, -5.0], outline=Shape(ellipse=[1.2, 2.0])),
]
TIME = 3.0


def in_front(answer: Answer) -> ReceiverArrays:
    """Return the receivers of a frame at preset high: some patches of blades, and strips behind them."""
    cells = np.stack(np.meshgrid(np.arange(-10, 10), np.arange(-19, 0)), -1).reshape(-1, 2)
    each = np.where((np.abs(cells[:, 0]) <= 3) & (cells[:, 1] >= -4), 500, 40)
    patch, middle = np.repeat(np.arange(len(cells)), each), ((cells + 0.5) * 2.5).astype(np.float32)
    off = np.random.default_rng(0).uniform(-1.25, 1.25, (len(patch), 2))
    return ReceiverArrays((middle[patch] + off).astype(np.float32), answer(len(patch)), patch, middle, 2.1)


def covered(place: NDArray[np.float32]) -> float:
    held = [wind.mask(wind.pose(time=TIME).inside(place), time=TIME) > 0.0 for wind in OTHERS]
    assert all(mask.any() for mask in held)
    return float(np.any(held, axis=0).mean())


def test_w5_three_more_winds_on_a_tenth_of_the_grass_cost_little_more_than_the_breeze(answer: Answer) -> None:
    """Measured as processor time, in turn; the bound is wider than the goal of 1.5, for busy machines."""
    receivers, quarantine = in_front(answer), Quarantine()
    assert 0.05 < covered(receivers.place) < 0.1

    def took(*winds: WindPrimitive) -> int:
        sources = [WindSource(wind, wind.kind) for wind in winds]
        start = thread_time_ns()
        now = blowing(sources, quarantine, time=TIME, seed=1)
        hear(now, receivers, quarantine, time=TIME, seed=1)
        return thread_time_ns() - start

    times = np.array([(took(Breeze()), took(Breeze(), *OTHERS)) for _ in range(30)])
    alone, together = np.median(times, axis=0)
    assert together / alone < 2.0


def test_f8_turbulence_costs_a_receiver_at_most_three_times_what_the_breeze_does(answer: Answer) -> None:
    receivers = in_front(answer)

    def took(wind: WindPrimitive) -> int:
        start = thread_time_ns()
        wind.action(receivers.place, time=TIME, seed=1, grass=receivers.grass)
        return thread_time_ns() - start

    breeze, turbulence = np.median([(took(Breeze()), took(Turbulence())) for _ in range(30)], axis=0)
    assert turbulence / breeze < 3.0
