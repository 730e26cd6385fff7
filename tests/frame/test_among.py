"""Soft edges among the grass: those of a tree are before the grass behind it, and behind the grass in front of it (N3)."""

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest

from tallgrass import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.show.among import SHELL, far_end
from tallgrass.testing import Stage, little_prairie, looking, private_world

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [160, 160] }
grass: { turf: { height: [0.3, 0.5], width: 0.02 } }
trees: { thorn: { habit: hawthorn, height: [4, 4], leaf: "#a02020", bark: "#a02020", positions: [[0, 0]] } }
light: { azimuth: 160, elevation: 40, haze: 1e6 }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 20, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 30
  carpet: 32
"""
SIZE = 72, 72
EYE = looking(0.0, 6.0, 22.0, pitch=-10.0, view=14.0)


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        yield made


def test_n3_grass_behind_a_tree_does_not_hide_its_soft_edges(ctx: moderngl.Context, prairie: Prairie) -> None:
    stage = Stage(ctx, SIZE)
    stage.begin()
    prairie.draw(*stage.matrices(EYE))
    drawn, true = stage.read(), draw_truth(prairie, *stage.matrices(EYE), SIZE).picture
    red = [np.maximum(each[..., 0].astype(int) - each[..., 1], 0).sum() for each in (drawn, true)]
    assert red[0] / red[1] > 0.85


def test_shells_of_grass_begin_at_its_end_and_go_down_to_where_edges_are() -> None:
    assert [far_end(off, 60.0) for off in (90.0, 60.0, 59.0, 0.0)] == [60.0] * 4
    for off in (3.0, 20.0, 47.9, 48.1):
        assert SHELL * far_end(off, 60.0) <= off * (1.0 + 1e-9) <= far_end(off, 60.0) * (1.0 + 2e-9)
