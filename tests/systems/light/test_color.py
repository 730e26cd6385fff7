"""Colours: linear light inside, display colours at input and output."""

from collections.abc import Callable

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.light.color import WHITE, display, linear, luminance, shown_as, srgb

colors = st.tuples(*[st.integers(0, 250)] * 3)


@given(colors)
def test_what_is_to_be_shown_as_a_colour_is_shown_as_it(color: tuple[int, int, int]) -> None:
    text = "#{:02x}{:02x}{:02x}".format(*color)
    np.testing.assert_allclose(display(shown_as(srgb(text))) * 255.0, color, atol=0.2)


@given(st.lists(st.floats(0.0, 50.0), min_size=2, max_size=9))
def test_brighter_light_never_looks_darker_and_never_overflows(levels: list[float]) -> None:
    shown = display(np.array(sorted(levels)))
    assert (np.diff(shown) >= 0.0).all()
    assert shown.min() >= 0.0
    assert shown.max() <= 1.0


SHOWN = """#include "lib/tone.glsl"
in vec3 row;
out vec3 told;
void main() { told = tone_mapped(row); }"""


def test_the_graphics_card_shows_radiance_by_the_same_curve(probe: Callable[..., NDArray[np.float32]]) -> None:
    radiance, record = np.linspace(-0.5, 4.0, 300).reshape(-1, 3), np.zeros(1, FRAME)
    told = probe(SHOWN, radiance.astype(np.float32), record, {}, 3)
    np.testing.assert_allclose(told, display(radiance), atol=1e-6)


def test_the_curve_ends_level_in_white() -> None:
    end = WHITE**2
    assert 0.98 < display(np.array(end)) <= 1.0
    assert display(np.array(end)) - display(np.array(0.98 * end)) < 2e-4


def test_shadows_are_shown_darker_than_a_plain_root_has_them() -> None:
    dark = np.linspace(1e-4, 0.05, 20)
    assert (display(dark) < np.sqrt(dark)).all()


@given(colors)
def test_a_colours_luminance_lies_between_its_channels(color: tuple[int, int, int]) -> None:
    light = linear("#{:02x}{:02x}{:02x}".format(*color))
    assert light.min() - 1e-12 <= luminance(light) <= light.max() + 1e-12
