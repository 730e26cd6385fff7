"""The physics of a chain of links."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.simulate import (
    GRAVITY,
    LINKS,
    Chain,
    build_chain,
    lowest_swing,
    place_links,
    settle,
    simulate,
)

EVEN = np.ones((1, LINKS))


def still(steps: int, batch: int = 1) -> np.ndarray:
    return np.zeros((steps, batch))


def energy(chain: Chain, angle: NDArray[Any], rate: NDArray[Any]) -> float:
    """Return the mechanical energy of thin rods, from positions and speeds rather than from any matrix."""
    length = 1.0 / LINKS
    turn = np.stack([np.cos(angle), -np.sin(angle)], axis=-1) * rate[:, None] * length
    speed = np.cumsum(turn, axis=0) - 0.5 * turn
    height = place_links(angle)[:-1, 1] + 0.5 * length * np.cos(angle)
    spin = chain.mass * length**2 / 12.0 * rate**2
    bend = np.diff(angle, prepend=0.0)
    kinetic = 0.5 * (chain.mass * (speed**2).sum(axis=1) + spin).sum()
    return float(kinetic + (chain.mass * height).sum() + 0.5 * (chain.stiffness[0] * bend**2).sum())


def test_a_blade_without_drag_or_damping_keeps_its_energy() -> None:
    chain = build_chain(GrassKind(), EVEN)
    chain = replace(chain, damping=np.zeros((1, LINKS)), area=np.zeros(LINKS))
    angle, rate = np.linspace(0.05, 0.9, LINKS)[None], np.zeros((1, LINKS))
    start = energy(chain, angle[0], rate[0])
    swing = start - energy(chain, np.zeros(LINKS), np.zeros(LINKS))
    for _ in range(10):
        history, rate = simulate(chain, angle, rate, still(100), step=0.002)
        angle = history[-1]
        assert energy(chain, angle[0], rate[0]) == pytest.approx(start, abs=0.002 * swing)


def test_damping_and_drag_only_ever_take_energy_away() -> None:
    chain = build_chain(GrassKind(), EVEN)
    angle, rate = np.linspace(0.0, 1.2, LINKS)[None], np.zeros((1, LINKS))
    before = energy(chain, angle[0], rate[0])
    for _ in range(20):
        history, rate = simulate(chain, angle, rate, still(50), step=0.005)
        angle = history[-1]
        now = energy(chain, angle[0], rate[0])
        assert now < before
        before = now


def test_small_swings_have_the_period_of_the_lowest_mode() -> None:
    chain = build_chain(GrassKind(), EVEN)
    chain = replace(chain, damping=np.zeros((1, LINKS)), area=np.zeros(LINKS))
    step = 0.004
    period = 2.0 * np.pi / lowest_swing(chain)[0]
    along = np.linspace(0.0, 1.0, LINKS)
    history, _ = simulate(chain, 0.01 * along[None], np.zeros((1, LINKS)), still(int(6.2 * period / step)), step=step)
    tip = place_links(history)[:, 0, -1, 0]
    spectrum = np.abs(np.fft.rfft(tip * np.hanning(tip.size), 1 << 18))
    found = (1 << 18) * step / np.argmax(spectrum)
    assert found == pytest.approx(period, rel=0.03)


@settings(max_examples=12, deadline=None)
@given(st.floats(0.05, 2.5), st.floats(0.02, 1.0), st.floats(0.02, 20.0), st.floats(0.1, 10.0), st.floats(0.3, 3.0))
def test_every_kind_stands_upright_and_swings(
    tallest: float, shortest: float, stiffness: float, damping: float, taper: float
) -> None:
    kind = GrassKind(
        height=[tallest * max(shortest, 0.4), tallest], stiffness=stiffness, damping=damping, taper=taper, width=0.01
    )
    chain = build_chain(kind, EVEN)
    swing = lowest_swing(chain)[0]
    assert swing > 0.0
    rest, still_rate = np.zeros(LINKS), np.zeros((1, LINKS))
    bent = np.full((1, LINKS), 0.05)
    history, rate = simulate(chain, bent, still_rate, still(400), step=0.2 / swing)
    assert np.abs(history).max() < 0.2
    upright = energy(chain, rest, rest)
    assert upright <= energy(chain, history[-1, 0], rate[0]) < energy(chain, bent[0], rest)


def test_meadow_grass_swings_about_once_a_second() -> None:
    for kind in (GrassKind(), GrassKind(height=[0.1, 0.2], width=0.005), GrassKind(height=[1.0, 1.6], width=0.02)):
        chain = build_chain(kind, EVEN)
        assert 0.4 < lowest_swing(chain)[0] * chain.second / (2.0 * np.pi) < 3.0


def test_a_batch_is_the_same_as_one_blade_at_a_time() -> None:
    kind = GrassKind()
    factors = np.exp(np.random.default_rng(1).normal(0.0, 0.4, (3, LINKS)))
    wind = np.broadcast_to(np.array([0.3, 1.0, 2.0]), (60, 3))
    together, _ = simulate(build_chain(kind, factors), np.zeros((3, LINKS)), np.zeros((3, LINKS)), wind, step=0.02)
    for number in range(3):
        alone, _ = simulate(
            build_chain(kind, factors[number : number + 1]),
            np.zeros((1, LINKS)),
            np.zeros((1, LINKS)),
            wind[:, number : number + 1],
            step=0.02,
        )
        np.testing.assert_allclose(alone[:, 0], together[:, number], atol=1e-12)


def test_the_wind_pushes_the_blade_the_way_it_blows_and_mirrors() -> None:
    chain = build_chain(GrassKind(), np.ones((2, LINKS)))
    wind = np.broadcast_to(np.array([1.0, -1.0]), (100, 2))
    history, _ = simulate(chain, np.zeros((2, LINKS)), np.zeros((2, LINKS)), wind, step=0.01)
    assert (history[-1, 0] > 0.0).all()
    np.testing.assert_allclose(history[:, 0], -history[:, 1], atol=1e-12)


def test_time_runs_in_roots_of_length_over_gravity() -> None:
    chain = build_chain(GrassKind(height=[GRAVITY / 4, GRAVITY / 4]), EVEN)
    assert chain.second == pytest.approx(2.0)


@pytest.mark.parametrize("stiffness", [0.02, 0.2, 1.0, 100.0])
def test_a_blade_at_rest_in_a_wind_stays_there(stiffness: float) -> None:
    chain = build_chain(GrassKind(stiffness=stiffness), np.exp(np.linspace(-0.5, 0.5, 2 * LINKS)).reshape(2, LINKS))
    winds = np.geomspace(0.01, 2.0, 60) * np.sqrt(1.0 + stiffness)
    rest = settle(chain, winds)
    for number in (0, 30, 59):
        steady = np.full((200, 2), winds[number])
        history, _ = simulate(chain, rest[number], np.zeros((2, LINKS)), steady, step=0.01)
        np.testing.assert_allclose(history[-1], rest[number], atol=1e-6)
    assert (np.diff(rest[:, :, -1], axis=0) > 0.0).all()
