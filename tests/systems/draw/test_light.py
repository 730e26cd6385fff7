"""Colours in the scene's light (F5)."""

from math import radians

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.camera import forward
from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.light import Light
from tallgrass.systems.frame.light import daylight, display, grain, linear, lit_kind, to_sun

colors = st.tuples(*[st.integers(0, 255)] * 3)
lights = st.builds(
    Light, azimuth=st.floats(-360, 360), elevation=st.floats(0, 90), strength=st.floats(0, 10), sun=st.just("#fff1d6")
)


@given(colors)
def test_a_dim_colour_comes_out_of_the_door_as_it_went_in(color: tuple[int, int, int]) -> None:
    text = "#{:02x}{:02x}{:02x}".format(*color)
    light = linear(text)
    shown = display(light) * 255.0
    dim = light <= 0.5
    np.testing.assert_allclose(shown[dim], np.array(color)[dim], atol=0.01)
    assert (shown <= np.array(color) + 0.01).all()


@given(st.lists(st.floats(0.0, 50.0), min_size=2, max_size=9))
def test_brighter_light_never_looks_darker_and_never_overflows(levels: list[float]) -> None:
    shown = display(np.array(sorted(levels)))
    assert (np.diff(shown) >= 0.0).all()
    assert shown.min() >= 0.0
    assert shown.max() <= 1.0


@given(lights)
def test_the_sun_stands_where_the_scene_says(light: Light) -> None:
    sun = to_sun(light)
    np.testing.assert_allclose(sun, forward(radians(light.azimuth), radians(light.elevation)), atol=1e-9)
    assert np.linalg.norm(sun) == pytest.approx(1.0)


@given(lights, st.floats(1.0, 20.0))
def test_f5_a_higher_sun_gives_more_light(light: Light, more: float) -> None:
    higher = light.model_copy(update={"elevation": min(light.elevation + more, 90.0)})
    assert (daylight(higher) >= daylight(light) - 1e-12).all()


def test_f5_a_kind_is_lit_brighter_by_a_stronger_sun_and_keeps_its_hue() -> None:
    kind = GrassKind(root="#304010", tip="#608030")
    dim, bright = (lit_kind(kind, Light(strength=strength)) for strength in (0.4, 1.0))
    for before, after in zip(dim, bright, strict=True):
        assert (after > before).all()
        assert np.argmax(after) == np.argmax(before) == 1


@given(lights, st.floats(0.0, 0.6))
def test_blades_that_face_all_ways_have_the_light_of_their_mean(light: Light, variety: float) -> None:
    x, z = grain(GrassKind(variety=variety), light)
    angle = np.linspace(-np.pi, np.pi, 360, endpoint=False)
    factor = 1.0 + np.cos(angle)[:, None] * x + np.sin(angle)[:, None] * z
    np.testing.assert_allclose(factor.mean(axis=0), 1.0, atol=1e-9)
