"""Soft edges of trees among the grass hide grass and wood behind them (N3)."""

from collections.abc import Iterator
from functools import partial
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Pose, Prairie, Tree
from tallgrass.engine.camera import Camera
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.show.strips.painter import StripsPainter
from tallgrass.systems.space.cone import distance_in_order
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
Array = NDArray[Any]
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


@pytest.mark.parametrize("yaw", [30.0, 45.0])
def test_n3_no_edges_of_trees_change_as_the_viewer_enters_another_patch(
    ctx: moderngl.Context, prairie: Prairie, yaw: float
) -> None:
    stage, border = Stage(ctx, SIZE), -6.0 * prairie.site.ground.patch
    away, seen = -border / np.sin(np.radians(yaw)), []
    for x in (border - 0.002, border + 0.002):
        stage.begin()
        prairie.draw(*stage.matrices(looking(x, 6.0, away * np.cos(np.radians(yaw)), yaw=yaw, pitch=-10.0, view=12.0)))
        drawn = stage.read().astype(int)
        seen.append(float(np.maximum(drawn[..., 0] - drawn[..., 1:].max(axis=-1), 0).sum()))
    assert seen[1] == pytest.approx(seen[0], rel=0.005)  # by distances along the ground, 0.015 or more


def test_n3_before_edges_of_a_tree_come_the_strips_of_its_own_patch_and_of_all_that_the_order_has_beyond(
    ctx: moderngl.Context, prairie: Prairie, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage = Stage(ctx, SIZE)
    prairie.draw(*stage.matrices(FAR_OFF))
    assert prairie.painter is not None
    painter = prairie.painter.painters["strips"]
    assert isinstance(painter, StripsPainter)
    drawn = list[int]()
    prairie.draw(*stage.matrices(looking(-14.7, 6.0, 15.3, yaw=44.0, pitch=-10.0, view=14.0)))
    assert painter.now is not None
    cell = painter.now.placements["cell"][painter.now.strips // painter.uploaded.stride].astype(np.int32)
    away = distance_in_order(cell, prairie.viewers["main"].viewer.centre) * painter.patch
    assert len(np.unique(away)) > 20
    monkeypatch.setattr(painter, "draw_strips", partial(_draw_numbers, drawn))
    painter.draw_beyond(middle := float(np.median(away)))
    assert drawn == np.flatnonzero(away >= middle).tolist()


def _draw_numbers(drawn: list[int], first: int, count: int, **_: object) -> int:
    drawn.extend(range(first, first + count))
    return 1


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
