"""The vortex street keeps the rules of winds, and its whirls turn and drift as behind a rock."""

import numpy as np
from vortex_street import VortexStreet

from tallgrass import Grass
from tallgrass.testing import check_wind, headless_context, twin_problems

STREET = VortexStreet(rock=2.0, speed=1.0, strength=1.0)
GRASS = Grass(np.zeros(2, np.intp), *np.ones((3, 1, 2), np.float32))


def test_it_keeps_the_rules_of_winds() -> None:
    """A failure lists each broken rule in one sentence."""
    check_wind(VortexStreet)


def test_its_twin_computes_the_same() -> None:
    """It needs OpenGL, but no graphics card: a software rasteriser will do."""
    with headless_context() as ctx:
        assert twin_problems(STREET, ctx) == []


def test_whirls_on_either_side_blow_ahead_outside_and_back_inside() -> None:
    """After 22.5 s the latest whirls of the two sides are 7.5 and 12.5 m behind the rock."""
    for side, along in ((1.0, 7.5), (-1.0, 12.5)):
        place = np.array([[side * 2.9, -along], [side * -0.1, -along]], np.float32)
        outside, inside = STREET.action(place, time=22.5, seed=0, grass=GRASS)
        assert outside[1] < -0.9
        assert inside[1] > 0.7


def test_whirls_drift() -> None:
    """Two seconds later everything is 2 m farther from the rock, and a little larger."""
    place = np.array([[2.9, -7.5], [2.9, -9.0]], np.float32)
    before = STREET.action(place, time=22.5, seed=0, grass=GRASS)
    after = STREET.action(place - np.array([0.0, 2.0], np.float32), time=24.5, seed=0, grass=GRASS)
    assert np.allclose(before, after, atol=0.1)
