"""Swings of trees in the wind, on numbers alone."""

import pytest

from tallgrass.systems.trees.motion import PERIOD, TONES, tones


@pytest.mark.parametrize("hertz", [0.13, 0.5, 2.0])
def test_a_swings_two_tones_go_round_as_often_as_its_frequency_says_and_repeat_after_a_period(hertz: float) -> None:
    before, after = tones(hertz, 40.0), tones(hertz, 40.5)
    for tone, one, other in zip(TONES, before, after, strict=True):
        assert 0.0 <= one < 1.0
        assert (other - one) % 1.0 == pytest.approx(0.5 * hertz * tone % 1.0, abs=0.5 / PERIOD)
    assert tones(hertz, 40.0 + PERIOD) == pytest.approx(before, abs=1e-6)
