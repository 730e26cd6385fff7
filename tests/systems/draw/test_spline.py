"""The wind on far carpet, which `lit.glsl` reads between texels (F6)."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.frame.block import FRAME

Probe = Callable[..., NDArray[np.float32]]

ASK = """#define SPLINES
#include "lib/light.glsl"
#include "systems/show/carpet/lit.glsl"
in vec4 row;  // place in texels
out vec3 told;
void main() { told = vec3(spline_at(air, row.xy), 0.0); }"""
SIDE = 16


@pytest.mark.parametrize("axis", [0, 1])
def test_f6_a_front_of_four_texels_keeps_its_height_between_them(
    ctx: moderngl.Context, probe: Probe, axis: int
) -> None:
    wave = np.broadcast_to(np.sin(np.pi / 4.0 * (np.arange(SIDE) + 0.5)), (SIDE, SIDE))
    texels = np.stack([wave if axis == 0 else wave.T, np.full((SIDE, SIDE), 0.5)], -1).astype(np.float32)
    air = ctx.texture((SIDE, SIDE), 2, texels.tobytes(), dtype="f4")
    places = np.random.default_rng(3).uniform(4.0, 12.0, (200, 2))
    rows = np.column_stack([places, np.zeros((200, 2))]).astype(np.float32)
    told = probe(ASK, rows, np.zeros(1, FRAME), {"air": air}, 3)
    air.release()
    assert told[:, 0] == pytest.approx(np.sin(np.pi / 4.0 * places[:, axis]), abs=0.04)
    assert told[:, 1] == pytest.approx(0.5, abs=1e-3)
