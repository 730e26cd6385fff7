"""Soft edges of trees among the grass hide grass and wood behind them (N3)."""

from collections.abc import Iterator

import esper
import moderngl
import numpy as np
import pytest

from tallgrass import Pose, Prairie, Tree
from tallgrass.engine.camera import Camera
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.trees.shells import SHELL, SHELLS, shells_of
from tallgrass.testing import Stage, little_prairie, looking, private_world

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [160, 160] }
grass: { turf: { height: [0.3, 0.5], width: 0.02 } }
trees: { thorn: { habit: hawthorn, height: [4, 4], leaf: "#a02020", bark: "#2020ff", positions: [[0, 0]] } }
light: { azimuth: 160, elevation: 40, haze: 1e6 }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 20, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 30
  carpet: 32
"""
SIZE = 72, 72
FAR_OFF = looking(0.0, 6.0, 22.0, pitch=-10.0, view=14.0)  # as pictures, and twig by twig
NEAR = looking(0.0, 6.0, 22.0, pitch=-11.0, view=4.0)


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        yield made


def red_and_blue(ctx: moderngl.Context, prairie: Prairie, eye: Camera) -> list[float]:
    """Return the visible amounts of a tree's red leaves and blue wood, relative to the reference."""
    stage = Stage(ctx, SIZE)
    stage.begin()
    prairie.draw(*stage.matrices(eye))
    drawn, true = (each.astype(int) for each in (stage.read(), draw_truth(prairie, *stage.matrices(eye), SIZE).picture))
    seen = [
        [np.maximum(each[..., own] - each[..., others].max(axis=-1), 0).sum() for each in (drawn, true)]
        for own, others in ((0, [1, 2]), (2, [0, 1]))
    ]
    return [one / other for one, other in seen]


@pytest.mark.slow
@pytest.mark.parametrize("eye", [FAR_OFF, NEAR])
def test_n3_neither_grass_nor_wood_behind_leaves_hides_their_soft_edges(
    ctx: moderngl.Context, prairie: Prairie, eye: Camera
) -> None:
    red, blue = red_and_blue(ctx, prairie, eye)
    assert red > 0.8  # drawn before the grass behind them, they are 0.6
    if eye is NEAR:
        assert blue == pytest.approx(1.0, abs=0.25)


@pytest.mark.slow
def test_n3_trees_behind_change_nothing_of_the_order_in_which_a_trees_edges_and_grass_are_drawn(
    ctx: moderngl.Context, prairie: Prairie
) -> None:
    stage = Stage(ctx, SIZE)

    def red() -> float:
        stage.begin()
        prairie.draw(*stage.matrices(FAR_OFF))
        seen = stage.read()[:, : SIZE[0] // 2].astype(int)
        return float(np.maximum(seen[..., 0] - seen[..., 1:].max(axis=-1), 0).sum())

    alone = red()
    behind = [esper.create_entity(Tree("thorn", 4.0), Pose(x, -8.5)) for x in (2.4, 2.8, 3.2, 3.6)]  # of all its models
    try:
        assert red() == pytest.approx(alone, rel=0.02)
    finally:
        for each in behind:
            esper.delete_entity(each, immediate=True)


def test_trees_stand_in_shells_of_grass_that_stay_where_they_are_while_it_ends_elsewhere() -> None:
    off = np.array([3.0, 20.0, 30.0, 47.9, 48.1, 59.0, 61.0, 90.0])
    shells = shells_of(off, 60.0)
    assert shells.tolist() == sorted(shells, reverse=True)
    assert shells[-2:].tolist() == [0, 0]
    for shell in range(1, SHELLS):
        assert off[shells == shell].min(initial=60.0) >= SHELL * off[shells == shell].max(initial=0.0)
    together = shells[:, None] == shells
    elsewhere = shells_of(off, 70.0)
    assert np.array_equal((elsewhere[:, None] == elsewhere)[:6, :6], together[:6, :6])
    assert not shells_of(off, 0.0).any()
