"""Masks and actions as kernels (W5, N5): extents, patches, and independence of other receivers."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, WindPrimitive, WindSource
from tallgrass.engine.scene import SceneError, parse_scene
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.blow import ReceiverArrays, blowing, hear
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.flutter import flutter
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.quarantine import Quarantine
from tallgrass.systems.wind.whirlwind import Whirlwind

Answer = Callable[..., Grass]
Feel = Callable[..., Floats]

shapes = st.one_of(
    st.builds(Shape, disc=st.sampled_from([0.5, 3.0, 9.0])),
    st.builds(Shape, ellipse=st.sampled_from([[1.0, 6.0], [5.0, 2.0]])),
    st.builds(
        Shape, polygon=st.sampled_from([[[0.0, 0.0], [6.0, 0.0], [0.0, 4.0]], [[-3.0, -3.0], [8.0, 1.0], [-2.0, 2.0]]])
    ),
)
ordinary: dict[str, Any] = {
    "position": st.lists(st.floats(-20, 20), min_size=2, max_size=2),
    "soft": st.floats(0, 12),
    "strength": st.floats(0, 1),
    "swing": st.floats(0, 0.5),
}
gusts = st.builds(
    Gust,
    direction=st.floats(-360, 360),
    width=st.floats(1, 60),
    speed=st.floats(0.5, 20),
    reach=st.floats(1, 60),
    hold=st.floats(0, 3),
    tail=st.floats(0.1, 5),
    ragged=st.floats(0, 4),
    **ordinary,
)
whirlwinds = st.builds(Whirlwind, yaw=st.floats(-360, 360), radius=st.floats(0.2, 20), **ordinary)
blasts = st.builds(Blast, yaw=st.floats(-360, 360), outline=shapes, **ordinary)
ended = st.one_of(gusts, whirlwinds, blasts)
winds = st.one_of(ended, st.builds(Breeze, strength=st.floats(0, 1), gustiness=st.floats(0, 1), speed=st.floats(0, 9)))
times = st.floats(0.0, 40.0)
seeds = st.integers(0, 2**31 - 1)

OWN = np.random.default_rng(0).uniform(-40.0, 40.0, (3000, 2)).astype(np.float32)


def around(box: Extent) -> Floats:
    """Return places on both sides of a rectangle's border, and everywhere else."""
    rng = np.random.default_rng(1)
    x, z = sorted((box.left, box.right)), sorted((box.ahead, box.behind))
    edge = rng.uniform([x[0] - 1, z[0] - 1], [x[1] + 1, z[1] + 1], (1500, 2))
    return np.concatenate([OWN, edge.astype(np.float32)])


@given(ended, times)
def test_w5_a_mask_is_0_outside_of_its_extent(wind: WindPrimitive, time: float) -> None:
    box = wind.extent(time=time)
    assert box is not None
    place = around(box)
    mask = wind.mask(place, time=time)
    out = (place[:, 0] < box.left) | (place[:, 0] > box.right) | (place[:, 1] < box.ahead) | (place[:, 1] > box.behind)
    assert out.any()
    assert (mask[out] == 0.0).all()


@given(winds, times)
def test_w5_masks_are_weights_from_0_to_1(wind: WindPrimitive, time: float) -> None:
    mask = wind.mask(OWN, time=time)
    assert mask.shape == (len(OWN),)
    assert mask.dtype == np.float32
    assert mask.min() >= 0.0
    assert mask.max() <= 1.0


@given(winds, times, seeds)
def test_w2_every_wind_answers_with_vectors_whose_norm_is_an_index(
    answer: Answer, wind: WindPrimitive, time: float, seed: int
) -> None:
    message = wind.action(OWN[:500], time=time, seed=seed, grass=answer(500))
    assert message.shape == (500, 2)
    assert message.dtype == np.float32
    assert np.isfinite(message).all()
    assert np.linalg.norm(message, axis=1).max() <= 1.0 + 1e-5


@given(winds, times, seeds, st.randoms(use_true_random=False))
def test_n5_what_a_receiver_hears_has_the_same_bits_in_any_company_and_order(
    answer: Answer, wind: WindPrimitive, time: float, seed: int, random: Any
) -> None:
    """Vectorised sines might round differently for the last few elements of an array."""
    count = 333
    grass, place = answer(count), np.ascontiguousarray(OWN[:count])
    together = wind.action(place, time=time, seed=seed, grass=grass), wind.mask(place, time=time)
    for size in (1, 2, 3, 5, 8, 15, 16, 17, 31, 100):
        rows = np.array(random.sample(range(count), size), np.intp)
        alone = np.ascontiguousarray(place[rows])
        message = wind.action(alone, time=time, seed=seed, grass=grass.at(rows))
        np.testing.assert_array_equal(message.view(np.uint32), together[0][rows].view(np.uint32))
        np.testing.assert_array_equal(wind.mask(alone, time=time).view(np.uint32), together[1][rows].view(np.uint32))


@given(times, seeds, st.lists(st.integers(0, len(OWN) - 1), min_size=1, max_size=70))
def test_n5_oscillations_have_the_same_bits_in_any_company(time: float, seed: int, rows: list[int]) -> None:
    alone = flutter(OWN[rows], time=time, seed=seed)
    np.testing.assert_array_equal(alone.view(np.uint32), flutter(OWN, time=time, seed=seed)[rows].view(np.uint32))


SIDE = 2.5
CELLS = np.stack(np.meshgrid(np.arange(-8, 8), np.arange(-8, 8)), -1).reshape(-1, 2)


def receivers(answer: Answer, each: int = 9) -> ReceiverArrays:
    """Return receivers on 16 by 16 patches."""
    middle = ((CELLS + 0.5) * SIDE).astype(np.float32)
    off = np.random.default_rng(6).uniform(-SIDE / 2, SIDE / 2, (len(CELLS), each, 2))
    place = (middle[:, None] + off).reshape(-1, 2).astype(np.float32)
    patch = np.repeat(np.arange(len(CELLS)), each)
    return ReceiverArrays(place, answer(len(place)), patch, middle, 0.7072 * SIDE)


class Asked:
    """Counts the places that a wind is asked for, and returns the wind's own answers."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, kind: type[WindPrimitive]) -> None:
        self.masks: list[Floats] = []
        plain = kind.mask

        def mask(wind: WindPrimitive, place: Floats, /, *, time: float) -> Floats:
            self.masks.append(place)
            return plain(wind, place, time=time)

        monkeypatch.setattr(kind, "mask", mask)


@pytest.mark.parametrize(
    "wind", [Gust(position=[400, 0], hold=0.5), Whirlwind(position=[60, 0]), Blast(position=[0, -70])]
)
def test_w5_a_wind_whose_extent_meets_no_patch_is_not_asked_at_all(
    answer: Answer, monkeypatch: pytest.MonkeyPatch, wind: WindPrimitive
) -> None:
    asked, quarantine = Asked(monkeypatch, type(wind)), Quarantine()
    now = blowing([WindSource(wind, "far")], quarantine, time=1.0, seed=1)
    assert len(now) == 1
    message = hear(now, receivers(answer), quarantine, time=1.0, seed=1)
    assert not asked.masks
    assert (message == 0.0).all()


@pytest.mark.parametrize("wind", [Gust(hold=0.3, tail=0.3, width=8.0), Whirlwind(radius=3.0), Blast()])
def test_w5_a_wind_costs_what_it_covers(answer: Answer, monkeypatch: pytest.MonkeyPatch, wind: WindPrimitive) -> None:
    asked, quarantine, heard = Asked(monkeypatch, type(wind)), Quarantine(), receivers(answer)
    hear(blowing([WindSource(wind, "here")], quarantine, time=1.0, seed=1), heard, quarantine, time=1.0, seed=1)
    assert 0 < sum(len(place) for place in asked.masks) < 0.1 * len(heard.place)


@pytest.mark.parametrize(
    "wind", [Gust(hold=0.3, tail=0.3, width=8.0), Whirlwind(radius=3.0, position=[3, 2]), Blast(position=[3, 2])]
)
def test_w5_receivers_on_patches_that_a_wind_misses_are_not_looked_at(
    answer: Answer, monkeypatch: pytest.MonkeyPatch, wind: WindPrimitive
) -> None:
    looked, plain, quarantine, heard = list[int](), Pose.inside, Quarantine(), receivers(answer, each=100)

    def inside(pose: Pose, place: Floats, /) -> Floats:
        looked.append(len(place))
        return plain(pose, place)

    monkeypatch.setattr(Pose, "inside", inside)
    hear(blowing([WindSource(wind, "here")], quarantine, time=1.0, seed=1), heard, quarantine, time=1.0, seed=1)
    patches, places = looked
    assert patches == len(heard.middle)
    assert 0 < places < 0.2 * len(heard.place)


@given(ended, times, seeds)
def test_w5_that_masks_are_discretised_over_patches_changes_nothing(
    feel: Feel, answer: Answer, wind: WindPrimitive, time: float, seed: int
) -> None:
    heard, quarantine = receivers(answer), Quarantine()
    sources = [WindSource(wind, f"wind[0] {wind.kind}")]
    message = hear(blowing(sources, quarantine, time=time, seed=seed), heard, quarantine, time=time, seed=seed)
    alone = feel(wind, place=heard.place, time=time, seed=seed)
    np.testing.assert_array_equal(message.view(np.uint32), alone.view(np.uint32))


BAD = [
    ("gust", "speed: 0", "speed must be more than 0.1"),
    ("gust", "width: -3", "width must be"),
    ("gust", "hold: 61", "hold must be"),
    ("gust", "tail: 0", "tail must be"),
    ("gust", "reach: fast", "reach must be"),
    ("gust", "direction: 400", "direction must be"),
    ("gust", "strength: 1.1", "strength must be"),
    ("gust", "ragged: -1", "ragged must be"),
    ("gust", "soft: -1", "soft must be"),
    ("gust", "wander: -1", "wander must be"),
    ("gust", "every: [9, 3]", "every must be [shortest, longest]"),
    ("gust", "every: [0.1, 3]", "every must be [shortest, longest]"),
    ("gust", "every: 4", "every must be"),
    ("gust", "position: [1]", "position must be"),
    ("whirlwind", "radius: 0", "radius must be"),
    ("whirlwind", "spin: up", "spin must be one of left, right"),
    ("whirlwind", "turning: -1", "turning must be"),
    ("whirlwind", "yaw: 9999", "yaw must be"),
    ("whirlwind", "ease: -1", "ease must be"),
    ("whirlwind", "priority: 1001", "priority must be"),
    ("whirlwind", "weight: 1.01", "weight must be"),
    ("whirlwind", "swing: 0.6", "swing must be"),
    ("blast", "height: 0", "height must be"),
    ("blast", "body: teapot", "body must be"),
    ("blast", "start: -1", "start must be"),
    ("breeze", "gustiness: 2", "gustiness must be"),
    ("breeze", "speed: 41", "speed must be"),
    ("turbulence", "intensity: 1.1", "intensity must be"),
    ("turbulence", "scale: 1", "scale must be"),
]


@pytest.mark.parametrize(("kind", "field", "told"), BAD)
def test_d4_a_winds_bad_value_is_told_at_its_place(kind: str, field: str, told: str) -> None:
    text = f"tallgrass: 2\ngrass: {{ lawn: {{}} }}\nwind:\n  - kind: {kind}\n    {field}\n"
    with pytest.raises(SceneError) as error:
        parse_scene(text)
    (problem,) = error.value.problems
    assert problem.line == 5
    assert problem.column >= 5 + len(field.partition(":")[0]) + 2
    assert problem.message.startswith(told)


def test_d4_a_paths_times_rise_and_the_one_that_does_not_is_pointed_at() -> None:
    text = (
        "tallgrass: 2\ngrass: { lawn: {} }\nwind:\n  - kind: blast\n    path:\n"
        "      - { at: 3, position: [0, 0] }\n      - { at: 3, position: [1, 0] }\n"
    )
    with pytest.raises(SceneError) as error:
        parse_scene(text)
    (problem,) = error.value.problems
    assert (problem.line, problem.column) == (7, 15)
    assert problem.message == "at must be later than 3 s, the point before"
