"""The whirlwind (W8): messages along circles, stronger inside, and a pattern that turns slowly."""

from collections.abc import Callable
from typing import Literal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.engine.declared.way import Waypoint
from tallgrass.systems.wind.whirlwind import EYE, LOBES, Whirlwind

Feel = Callable[..., Floats]

WIND = Whirlwind(radius=5.0, swing=0.0, soft=0.0)


def ring(radius: float, count: int = 360, *, x: float = 0.0, z: float = 0.0) -> tuple[Floats, Floats]:
    """Return places on a circle, and the outward directions there."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    out = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return (out * radius + [x, z]).astype(np.float32), out.astype(np.float32)


@given(
    radius=st.floats(EYE + 0.05, 4.95),
    time=st.floats(0.0, 3600.0),
    spin=st.sampled_from(["left", "right"]),
    yaw=st.floats(-360.0, 360.0),
)
def test_w8_grass_lies_along_circles_around_the_middle(
    feel: Feel, radius: float, time: float, spin: Literal["left", "right"], yaw: float
) -> None:
    wind = Whirlwind(radius=5.0, swing=0.0, position=[3.0, -8.0], spin=spin, yaw=yaw)
    place, out = ring(radius, 50, x=3.0, z=-8.0)
    message = feel(wind, place=place, time=time)
    index = np.linalg.norm(message, axis=1)
    assert index.min() > 0.05
    np.testing.assert_allclose(np.einsum("ij,ij->i", message, out) / index, 0.0, atol=2e-5)
    turn = out[:, 0] * message[:, 1] - out[:, 1] * message[:, 0]
    assert (turn < 0.0 if spin == "left" else turn > 0.0).all()


def test_w8_seen_from_above_left_is_against_the_clock(feel: Feel) -> None:
    east = np.array([[2.0, 0.0]], np.float32)
    assert feel(WIND, place=east, time=1.0)[0, 1] < 0.0


@given(st.floats(EYE, 4.0), st.floats(0.2, 1.0), st.floats(0.0, 100.0))
def test_w8_it_is_stronger_near_its_middle_than_farther_out(feel: Feel, inner: float, more: float, time: float) -> None:
    near, far = (feel(WIND, place=ring(radius)[0], time=time) for radius in (inner, min(inner + more, 4.99)))
    assert (np.linalg.norm(near, axis=1) > np.linalg.norm(far, axis=1)).all()


def test_w8_its_eye_is_calm_and_has_no_direction_to_jump_in(feel: Feel) -> None:
    message = feel(WIND, place=np.zeros((1, 2), np.float32), time=1.0)
    assert (message == 0.0).all()
    line = np.stack([np.linspace(-1.0, 1.0, 401), np.full(401, 0.003)], axis=1).astype(np.float32)
    jumps = np.linalg.norm(np.diff(feel(WIND, place=line, time=1.0), axis=0), axis=1)
    assert jumps.max() < 0.05


@pytest.mark.parametrize("spin", ["left", "right"])
def test_w8_its_stronger_sides_go_round_with_it(feel: Feel, spin: Literal["left", "right"]) -> None:
    wind = WIND.model_copy(update={"spin": spin, "turning": 0.25})
    place, _ = ring(2.5)

    def strongest(time: float) -> NDArray[np.float64]:
        index = np.linalg.norm(feel(wind, place=place, time=time), axis=1)
        assert np.ptp(index) > 0.1
        wave = np.exp(-1j * LOBES * np.radians(np.arange(360))) @ index
        return np.asarray(-np.angle(wave) / LOBES)

    steps = np.array([strongest(time) for time in np.arange(0.0, 2.0, 0.1)])
    turned = np.unwrap(steps, period=2.0 * np.pi / LOBES)
    expected = (-1.0 if spin == "left" else 1.0) * 2.0 * np.pi * 0.25 * np.arange(0.0, 2.0, 0.1)
    np.testing.assert_allclose(turned - turned[0], expected, atol=0.02)


def test_w8_it_ends_at_its_radius_and_travels_along_its_path(feel: Feel) -> None:
    path = [Waypoint(at=0.0, position=[0.0, 0.0]), Waypoint(at=10.0, position=[20.0, 0.0])]
    wind = WIND.model_copy(update={"path": path})
    place = np.random.default_rng(1).uniform(-10.0, 30.0, (500, 2)).astype(np.float32)
    for time in (0.0, 5.0, 12.0):
        pose = wind.pose(time=time)
        away = np.hypot(place[:, 0] - pose.x, place[:, 1] - pose.z)
        blown = (feel(wind, place=place, time=time) != 0.0).any(axis=1)
        np.testing.assert_array_equal(blown, (away < 5.0) & (away > 1e-3))
    assert wind.pose(time=12.0).x == 20.0
