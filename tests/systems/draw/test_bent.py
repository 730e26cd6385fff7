"""What lines of sight meet in bent grass, as `bent.glsl` reads it from the carpet's table (F6)."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.show.carpet.grow import BENDS, BENT_SLOPES, FLATTEST, STEEPEST
from tallgrass.systems.show.carpet.textures import bent_texture

Probe = Callable[..., NDArray[np.float32]]

ASK = """#include "systems/show/carpet/bent.glsl"
in vec4 row;  // bending; slopes of the line of sight to the ground, and that at which it would meet as much at rest
out vec3 told;
void main() { told = bent_change(0, row.xy, vec2(0.6, -0.8), row.z, row.z, row.w); }"""


def test_f6_grass_is_met_as_it_is_bent_away_from_the_eye_or_towards_it_at_the_slope_of_the_line_of_sight(
    ctx: moderngl.Context, probe: Probe
) -> None:
    table = np.zeros((1, BENT_SLOPES, BENDS, 4), np.float16)
    table[0, ..., 1] = np.linspace(-1.0, 1.0, BENDS)
    table[0, ..., 2] = np.linspace(np.log(FLATTEST), np.log(STEEPEST), BENT_SLOPES)[:, None]
    bents = bent_texture(ctx, table)
    ways = np.array([(0.6, -0.8), (-0.6, 0.8), (0.8, 0.6)])  # away from the eye, towards it, aside
    for slope in (FLATTEST, 0.3, STEEPEST):
        rows = np.column_stack([0.5 * ways, np.full((3, 2), slope)])
        _, along, high = probe(ASK, rows.astype(np.float32), np.zeros(1, FRAME), {"bents": bents}, 3).T
        assert along.tolist() == pytest.approx([0.5, -0.5, 0.0], abs=0.01)
        assert high == pytest.approx(np.log(slope), abs=0.02)
    bents.release()


def test_f6_grass_that_bends_aside_is_met_otherwise_than_the_mean_of_both_ways_along_the_view(
    ctx: moderngl.Context, probe: Probe
) -> None:
    table = np.zeros((1, BENT_SLOPES, BENDS, 4), np.float16)
    table[..., 1:3], table[..., 3] = 1.0, np.linspace(-1.0, 1.0, BENDS)
    bents = bent_texture(ctx, table)
    ways = np.array([(0.6, -0.8), (-0.6, 0.8), (0.8, 0.6), (-0.8, -0.6)])  # along the view, and aside
    rows = np.column_stack([0.5 * ways, np.full((4, 2), 0.3)])
    told = probe(ASK, rows.astype(np.float32), np.zeros(1, FRAME), {"bents": bents}, 3)
    bents.release()
    assert told[:2] == pytest.approx(np.array([(0.0, 1.0, 1.0)] * 2), abs=0.01)
    assert told[2:] == pytest.approx(np.array([(0.5, 0.5, 0.5)] * 2), abs=0.01)
