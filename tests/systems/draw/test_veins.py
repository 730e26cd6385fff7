"""Rib and veins of near blades, which keep the mean brightness."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.frame.block import FRAME

Probe = Callable[..., NDArray[np.float32]]

ASK = """#include "lib/frame.glsl"
#include "systems/show/blades/veins.glsl"
in vec4 row;  // how much of its rib and of its veins is seen; place across; half its width [pixel]
out float told;
void main() { told = vein_brightness(row.xy, row.z, row.w); }"""


def across(probe: Probe, wide: float, *, rib: float = 1.0, veins: float = 1.0) -> NDArray[np.float32]:
    rows = np.zeros((2001, 4), np.float32)
    rows[:, 0], rows[:, 1], rows[:, 2], rows[:, 3] = rib, veins, np.linspace(-1.0, 1.0, 2001), wide
    return probe(ASK, rows, np.zeros(1, FRAME), {}, 1)[:, 0]


def test_a_blade_that_is_thin_in_the_picture_has_no_rib(probe: Probe) -> None:
    np.testing.assert_array_equal(across(probe, 0.7), 1.0)
    np.testing.assert_array_equal(across(probe, 40.0, rib=0.0, veins=0.0), 1.0)


@pytest.mark.parametrize("wide", [0.8, 1.5, 3.0, 8.0, 40.0])
def test_its_rib_and_veins_leave_a_blade_as_bright_as_it_was(probe: Probe, wide: float) -> None:
    assert across(probe, wide).mean() == pytest.approx(1.0, abs=2e-3)


def test_a_rib_is_pale_in_the_middle_and_veins_come_in_nearer_by(probe: Probe) -> None:
    far, near = across(probe, 3.0), across(probe, 40.0)
    assert far[1000] == far.max() > 1.1
    beside = slice(0, 700)
    assert np.ptp(far[beside]) < 0.02
    assert np.ptp(near[beside]) > 0.1
    assert len(np.flatnonzero(np.diff(np.sign(near[beside] - near[beside].mean())))) >= 6
