"""Small oscillations of random direction and strength on every wind (W10)."""

from collections.abc import Callable
from math import radians, sin

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.pose import Pose
from tallgrass.components.wind import WindPrimitive
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.flutter import flutter
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.whirlwind import Whirlwind

Floats = NDArray[np.float32]
Feel = Callable[..., Floats]

FIELD = np.random.default_rng(4).uniform(-6.0, 6.0, (3000, 2)).astype(np.float32)
WINDS: list[WindPrimitive] = [
    Breeze(gustiness=0.0),
    Gust(position=[-10.0, 0.0], hold=3.0, ragged=0.0, strength=0.5),
    Whirlwind(radius=20.0, strength=0.5),
    Blast(outline=Shape(disc=20.0), strength=0.5),
]
kinds = pytest.mark.parametrize("wind", WINDS, ids=lambda wind: wind.kind)


def added(feel: Feel, wind: WindPrimitive, *, time: float = 2.5, place: Floats = FIELD, seed: int = 7) -> Floats:
    """What the small oscillations add to a wind's messages, per swing."""
    still = feel(wind.model_copy(update={"swing": 0.0}), place=place, time=time, seed=seed)
    moving = feel(wind.model_copy(update={"swing": 0.1}), place=place, time=time, seed=seed)
    return np.asarray((moving - still) / np.float32(0.1))


@kinds
def test_w10_every_wind_swings_in_random_directions_and_strengths(feel: Feel, wind: WindPrimitive) -> None:
    extra = added(feel, wind)
    strength, angle = np.linalg.norm(extra, axis=1), np.arctan2(extra[:, 1], extra[:, 0])
    assert np.std(strength) > 0.15
    counted, _ = np.histogram(angle, bins=8, range=(-np.pi, np.pi))
    assert counted.min() > 0.04 * len(FIELD)


def test_w10_a_field_does_not_sway_in_step() -> None:
    wide = np.random.default_rng(8).uniform(-30.0, 30.0, (8000, 2)).astype(np.float32)
    means = np.stack([flutter(wide, time=0.1 * step, seed=7).mean(axis=0) for step in range(60)])
    own = flutter(wide, time=2.5, seed=7)
    assert np.sqrt((means**2).sum(axis=1).mean()) < 0.1 * np.sqrt((own**2).sum(axis=1).mean())


@kinds
def test_w10_nothing_is_uniform_under_any_wind(feel: Feel, wind: WindPrimitive) -> None:
    message = feel(wind, place=FIELD, time=2.5)
    assert len(np.unique(message, axis=0)) > 0.99 * len(FIELD)
    apart = np.linalg.norm(message[1:] - message[:-1], axis=1)
    assert np.quantile(apart, 0.05) > 0.01


@kinds
def test_w10_the_oscillations_go_on_in_time(feel: Feel, wind: WindPrimitive) -> None:
    story = np.stack([added(feel, wind, time=2.0 + 0.1 * step, place=FIELD[:50]) for step in range(20)])
    assert story.std(axis=0).min() > 0.03
    beats = (np.diff(np.sign(story[:, :, 0]), axis=0) != 0).sum(axis=0)
    assert np.median(beats) >= 2


@kinds
def test_w10_a_swing_of_0_is_the_prescribed_motion_exactly(feel: Feel, wind: WindPrimitive) -> None:
    """What the wind's own action says, and nothing else."""
    still = wind.model_copy(update={"swing": 0.0, "weight": 1.0})
    np.testing.assert_array_equal(feel(still, place=FIELD, time=2.5), feel(still, place=FIELD, time=2.5))
    assert (added(feel, wind) != 0.0).any(axis=1).mean() > 0.99
    steady = Breeze(gustiness=0.0, swing=0.0, strength=0.25, direction=30.0)
    message = feel(steady, place=FIELD, time=2.5)
    assert len(np.unique(message, axis=0)) == 1
    np.testing.assert_allclose(message[0, 0], 0.25 * sin(radians(30.0)), atol=1e-7)


@kinds
def test_w10_their_noise_stands_on_the_ground_while_the_wind_moves(feel: Feel, wind: WindPrimitive) -> None:
    here = added(feel, wind)
    if isinstance(wind, Breeze):
        np.testing.assert_allclose(here, flutter(FIELD, time=2.5, seed=7), atol=2e-5)
        return
    pose = wind.pose(time=2.5)
    moved = Pose(pose.x + 0.7, pose.z - 0.4, pose.yaw + 0.5)
    still, moving = (
        feel(wind.model_copy(update={"swing": swing}), place=FIELD, time=2.5, poses=[moved]) for swing in (0.0, 0.1)
    )
    both = (here != 0.0).any(axis=1) & (moving != still).any(axis=1)
    assert both.mean() > 0.8
    np.testing.assert_allclose(((moving - still) / np.float32(0.1))[both], here[both], atol=2e-5)


@kinds
def test_w10_swings_are_as_large_as_they_are_declared(feel: Feel, wind: WindPrimitive) -> None:
    extra = np.concatenate([added(feel, wind, time=2.0 + 0.31 * step) for step in range(5)])
    assert 0.3 < np.linalg.norm(extra, axis=1).mean() < 1.0
    assert np.abs(extra).max() <= 1.5 + 1e-4


def test_w10_another_seed_swings_otherwise(feel: Feel) -> None:
    one, other = (added(feel, WINDS[2], seed=seed) for seed in (1, 2))
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.2
