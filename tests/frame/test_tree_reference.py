"""Trees of a reference: every leaf, each hidden by what is nearer, in any part of the picture (N3)."""

from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Prairie
from tallgrass.systems.reference import cropped, draw_truth
from tallgrass.systems.trees.draw import TreePart
from tallgrass.systems.trees.standing import PICTURE_BELOW
from tallgrass.systems.trees.stream import FAR, LEAVES
from tallgrass.testing import Stage, little_prairie, looking, private_world

SCENE = """\
tallgrass: 2
seed: 5
terrain: { noise: flat, size: [120, 120] }
grass: { turf: { height: [0.05, 0.1], width: 0.02, blades: 20 } }
trees:
  thorn: { habit: hawthorn, height: [4, 4], positions: [[0, 0]] }
  screen: { habit: birch, height: [12, 12], leaf: "#a02020", rows: [[[-20, -30], [20, -30]]], spacing: 4 }
light: { azimuth: 90, elevation: 40, haze: 1e6 }
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 30
  carpet: 32
"""
SIZE = 72, 48
EYE = looking(0.0, 1.7, 20.0, pitch=3.0, view=30.0)


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, SIZE)


@pytest.fixture(scope="module")
def prairie(ctx: moderngl.Context, stage: Stage) -> Iterator[Prairie]:
    with private_world(), little_prairie(scene=SCENE, ctx=ctx) as made:
        stage.begin()
        made.draw(*stage.matrices(EYE))
        yield made


def reference(stage: Stage, prairie: Prairie, **keys: Any) -> NDArray[np.float64]:
    return draw_truth(prairie, *stage.matrices(EYE), SIZE, **keys).picture.astype(np.float64)


def streams(prairie: Prairie) -> dict[str, list[int]]:
    """Return how many trees, or twigs of them, were drawn in each way, by kind."""
    assert prairie.painter is not None
    kinds = vars(prairie.painter.part(TreePart))["_kinds"]
    return {name: [sum(each.streams[name].count for each in kind.models) for kind in kinds] for name in (LEAVES, FAR)}


def test_n3_in_a_reference_leaves_hide_trees_behind_them_however_small_they_are(stage: Stage, prairie: Prairie) -> None:
    seen = reference(stage, prairie)
    red = seen[..., 0] - seen[..., 1]
    crown = red[21:28, 32:41]  # before their crowns
    assert red[10:20, 10:62].max() > 30.0  # trees behind are red
    assert np.median(crown) < 0.0
    assert (crown > 20.0).mean() < 0.1


@pytest.mark.slow
def test_n3_a_tile_of_a_reference_shows_what_the_whole_does_whichever_was_drawn_before(
    stage: Stage, prairie: Prairie
) -> None:
    whole = reference(stage, prairie)
    view, projection = stage.matrices(EYE)
    stage.begin()
    prairie.draw(view, projection)  # so that trees are chosen anew
    for left, top in ((2, 8), (48, 8), (28, 24)):
        tile = draw_truth(prairie, view, cropped(projection, (left, top), (20, 20), SIZE), (20, 20)).picture
        apart = np.abs(tile - whole[top : top + 20, left : left + 20]).mean()
        assert apart < 3.0, (left, top)


def test_n3_within_a_reach_trees_that_nowhere_come_near_are_drawn_as_they_are_far_off(
    stage: Stage, prairie: Prairie
) -> None:
    reference(stage, prairie)
    assert streams(prairie)[FAR] == [0, 0]
    assert min(streams(prairie)[LEAVES]) > 0
    assert SIZE[1] < PICTURE_BELOW  # higher than any tree in this picture
    far = reference(stage, prairie, reach=99)
    assert streams(prairie)[LEAVES] == [0, 0]
    assert min(streams(prairie)[FAR]) > 0
    assert (far[10:20, :, 0] - far[10:20, :, 1]).max() > 30.0
    reference(stage, prairie, reach=99, seen_at=((0.0, 1.7, 20.0), (0.0, 6.0, -30.0)))  # the second is among birches
    thorn, screen = zip(*(streams(prairie)[name] for name in (LEAVES, FAR)), strict=True)
    assert min(screen) > 0  # of a row, some come near, and some do not
    assert thorn == (0, 1)
