"""Mowing: cutting and growing on the map of the grass's height (F4)."""

import logging
from math import inf, nan, pi
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.footprint import Footprint
from tallgrass.components.pose import HERE, Pose
from tallgrass.engine.terrain.plots import CELL, CELLS, SIDE, ends_of
from tallgrass.engine.terrain.record import Density, Terrain
from tallgrass.engine.world import World
from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.mow.area import LEAST_RADIUS, Area, signed_distances
from tallgrass.systems.mow.card import WIDTH, PlotsPart
from tallgrass.systems.mow.mown import Mown
from tallgrass.testing import LITTLE, little_prairie, watch

LONG = Footprint(radius=1.0, length=6.0)
ELL = Footprint(corners=((-3.0, -3.0), (3.0, -3.0), (3.0, 0.0), (0.0, 0.0), (0.0, 3.0), (-3.0, 3.0)))


def ground(width: float = 40.0, depth: float = 20.0) -> Terrain:
    return Terrain(np.zeros((int(depth) + 1, int(width) + 1), np.float32), 1.0)


def left(mown: Mown, x: float, z: float) -> float:
    """Return the height up to which grass stands at a place."""
    return float(mown.at(places((x, z)))[0])


def inside(area: Area, pose: Pose, at: Floats, *, least: float = 0.0) -> list[bool]:
    under: list[bool] = (signed_distances(area, pose, at, least=least) <= 0.0).tolist()
    return under


def places(*each: tuple[float, float]) -> Floats:
    return np.array(each, np.float32)


def test_f4_a_capsule_lies_along_its_heading_and_is_round_at_its_ends() -> None:
    at = places((0.0, -3.9), (0.0, -4.1), (0.9, 0.0), (1.1, 0.0), (0.8, -3.8))
    assert inside(LONG, HERE, at) == [True, False, True, False, False]
    turned = places((6.9, 2.0), (7.1, 2.0), (3.0, 2.9), (3.0, 3.1))
    assert inside(LONG, Pose(3.0, 2.0, pi / 2), turned) == [True, False, True, False]


def test_f4_a_polygon_may_be_hollow_and_is_turned_with_its_pose() -> None:
    at = places((-2.0, 2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, -2.0), (-3.1, 0.0))
    assert inside(ELL, HERE, at) == [True, True, False, True, False]
    assert inside(ELL, Pose(yaw=pi), at) == [True, True, True, False, False]


def test_f4_what_is_cut_stays_cut_and_what_stands_lower_stays_as_it_is() -> None:
    mown = Mown(ground())
    mown.cut(LONG, 0.1, Pose(2.0, 1.0))
    mown.cut(Footprint(radius=3.0), 0.25, Pose(2.0, 1.0))
    assert left(mown, 2.0, 1.0) == pytest.approx(0.1)
    assert left(mown, 4.5, 1.0) == pytest.approx(0.25)
    assert left(mown, 2.0, 6.0) == inf


def test_f4_what_is_grown_stands_as_high_as_it_may_and_never_lower_than_before() -> None:
    mown = Mown(ground())
    mown.cut(Footprint(radius=5.0), 0.1, HERE)
    mown.grow(Footprint(radius=2.0), 0.3, HERE)
    mown.grow(Footprint(radius=1.0), 0.2, HERE)
    assert [left(mown, x, 0.0) for x in (0.5, 1.5, 3.0)] == pytest.approx([0.3, 0.3, 0.1])
    mown.grow(Footprint(radius=1.0), inf, HERE)
    assert left(mown, 0.5, 0.0) == inf


@given(
    st.lists(st.tuples(st.booleans(), st.floats(0.0, 1.0), st.floats(-25.0, 25.0), st.floats(0.05, 6.0)), max_size=8)
)
def test_f4_the_map_says_at_each_place_what_the_strokes_over_it_say(
    strokes: list[tuple[bool, float, float, float]],
) -> None:
    mown, at = Mown(ground()), places((1.1, 0.3))
    due = np.float32(inf)
    for grows, height, x, radius in strokes:
        footprint, pose = Footprint(radius=radius), Pose(x, 0.3)
        (mown.grow if grows else mown.cut)(footprint, height, pose)
        if inside(footprint, pose, at, least=LEAST_RADIUS * CELL)[0]:
            due = (max if grows else min)(due, np.float32(height))
    assert left(mown, 1.1, 0.3) == due


def test_f4_even_the_narrowest_footprint_cuts_the_cell_that_it_is_on() -> None:
    for x in np.linspace(3.0, 3.0 + CELL, 7).tolist():
        mown = Mown(ground())
        mown.cut(Footprint(radius=0.02), 0.1, Pose(x, 0.07))
        assert left(mown, x, 0.07) == pytest.approx(0.1)


def test_f4_only_what_a_stroke_has_changed_is_new() -> None:
    mown = Mown(ground())
    assert mown.strokes == 0
    mown.cut(Footprint(radius=1.0), 0.1, Pose(0.0, 5.0))
    first = mown.strokes
    mown.cut(Footprint(radius=0.5), 0.1, Pose(0.0, 5.0))
    assert mown.strokes == first, "nothing is lower than before"
    mown.cut(Footprint(radius=1.0), 0.1, Pose(0.0, -5.0))
    changed = mown.plots.since(first)
    assert changed is not None
    low, high = (np.array([ends_of(part)[end] for part in changed]) for end in (0, 1))
    assert (low.min(axis=0) > (-1.4, -6.4)).all()
    assert (high.max(axis=0) < (1.4, -3.6)).all()


def test_f4_no_map_is_made_before_something_is_cut_on_the_terrain() -> None:
    mown = Mown(ground())
    mown.grow(Footprint(radius=5.0), 0.2, HERE)
    mown.cut(Footprint(radius=5.0), 0.2, Pose(500.0, 0.0))
    assert not mown.plots.any
    assert mown.strokes == 0


def test_f4_cells_are_as_small_on_a_large_terrain_and_only_what_is_cut_takes_room() -> None:
    mown = Mown(Terrain(np.zeros((3, 3), np.float32), 5000.0))
    mown.cut(Footprint(radius=0.3), 0.1, Pose(3000.1, -4000.1))
    assert [left(mown, x, -4000.1) for x in (3000.1, 3000.3, 3000.5)] == pytest.approx([0.1, 0.1, inf])
    assert len(mown.plots.written) == 1


def test_f4_on_another_terrain_what_was_cut_stays_cut_at_its_place() -> None:
    mown = Mown(ground())
    mown.cut(Footprint(radius=1.0), 0.1, Pose(15.0, -3.0))
    mown.cut(Footprint(radius=1.0), 0.2, Pose(-2.0, 8.0))
    before = mown.strokes
    mown.change(ground(100.0, 12.0))
    assert [left(mown, 15.0, -3.0), left(mown, -40.0, 0.0)] == pytest.approx([0.1, inf])
    assert mown.strokes > before
    mown.change(ground(20.0, 20.0))
    assert [left(mown, 15.0, -3.0), left(mown, -2.0, 8.0)] == pytest.approx([inf, 0.2])


@pytest.mark.parametrize(
    ("arguments", "error", "told"),
    [
        ((Footprint(), -0.1, HERE), ValueError, "grass is cut to 0 m or more, not to -0.1"),
        ((Footprint(), nan, HERE), ValueError, "grass is cut to 0 m or more, not to nan"),
        ((Footprint(), "low", HERE), TypeError, "grass is cut to a height in metres, not to 'low'"),
        ((0.5, 0.1, HERE), TypeError, "grass is cut under a Footprint or a Road, not under 0.5"),
        ((Footprint(), 0.1, (1.0, 2.0)), TypeError, r"a footprint lies at a Pose, not at \(1.0, 2.0\)"),
        ((Footprint(), 0.1, Pose(nan)), ValueError, "a footprint lies where x, .* finite numbers, at most"),
    ],
)
def test_f4_what_cannot_be_cut_is_told_in_a_sentence(arguments: tuple[object, ...], error: type, told: str) -> None:
    mown = Mown(ground())
    with pytest.raises(error, match=told):
        mown.cut(*arguments)  # type: ignore[arg-type]
    assert not mown.plots.any


@settings(max_examples=20)
@given(st.lists(st.tuples(st.floats(-22.0, 22.0), st.floats(-12.0, 12.0), st.floats(0.5, 9.0)), max_size=6))
def test_f4_the_top_of_a_patch_is_the_highest_grass_that_is_left_on_it(
    strokes: list[tuple[float, float, float]],
) -> None:
    mown, patch = Mown(ground()), 3.0
    x, z = np.meshgrid(np.arange(-8, 8), np.arange(-5, 5))
    cells = np.stack([x, z], axis=-1).reshape(-1, 2).astype(np.int32)
    for number, (x_at, z_at, radius) in enumerate(strokes):
        (mown.grow if number % 3 == 2 else mown.cut)(Footprint(radius=radius), 0.1 * number, Pose(x_at, z_at))
        found = mown.tops(cells, patch=patch)
        middle = (np.stack(np.meshgrid(np.arange(-120, 120), np.arange(-75, 75)), axis=-1) + 0.5).reshape(-1, 2) * CELL
        column, row = np.floor(middle / patch).astype(int).T - [[-8], [-5]]
        highest = np.zeros(x.shape, np.float32)
        np.maximum.at(highest, (row, column), mown.at(middle.astype(np.float32)))
        np.testing.assert_array_equal(found, highest.ravel())


def test_f4_where_grass_is_mown_so_short_that_strips_would_show_as_rows_lies_the_carpet(world: World) -> None:
    del world  # it is made the current one
    with little_prairie(scene=LITTLE.replace("scale: 4", "scale: 0")) as prairie:
        watch(prairie)
        patches = prairie.viewers["main"].patches
        before = patches.wanted[patches.visible].copy()
        prairie.cut(Footprint(radius=90.0), 0.01)
        watch(prairie)
        assert (before == 1).sum() > 20
        assert not (patches.wanted[patches.visible] == 1).any()
        np.testing.assert_array_equal(patches.wanted[patches.visible] == 0, before == 0)
        prairie.grow(Footprint(radius=0.5), pose=Pose(*patches.middle[patches.visible][before == 1][0].tolist()))
        watch(prairie)
        assert (patches.wanted[patches.visible] == 1).sum() == 1


def test_f4_where_more_is_cut_than_a_texture_holds_the_rest_is_not_shown_which_is_logged_once(
    ctx: moderngl.Context, caplog: pytest.LogCaptureFixture
) -> None:
    terrain = Terrain(np.zeros((131, 131), np.float32), 1.0)
    density = Density(np.ones((1, 2, 2), np.float32), terrain.size, terrain)
    grown: Any = SimpleNamespace(ground=SimpleNamespace(density=density), tallest=1.0)
    record, mown = np.zeros(1, FRAME), Mown(terrain)
    part = PlotsPart(ctx, 0, mown)
    part._most_rows = 2  # noqa: SLF001 - one for the index, and one of pages
    row = WIDTH // CELLS
    with caplog.at_level(logging.WARNING, "tallgrass"):
        for number in range(row + 2):
            x, z = divmod(number, 9)
            mown.cut(Footprint(radius=0.5), 0.25, Pose(SIDE * (x - 3.5), SIDE * (z - 4.5)))
            if number >= row - 2:
                part.settle(grown, record)
            assert len(caplog.messages) == (number >= row)
    (said,) = caplog.messages
    assert said == "more has been cut and sown than a texture has room for: some of it is not shown"
    texels = np.frombuffer(part.texture.read(), np.uint8).reshape(2 * CELLS, WIDTH, 4).astype(int)
    index, pages = texels[0, :, 0] * 256 + texels[0, :, 1], texels[CELLS:].reshape(CELLS, row, CELLS, 4)[..., 0]
    assert sorted(index[index > 0].tolist()) == [*range(row, 2 * row)]
    assert (pages.min(axis=(0, 2)) == 64).all()
    part.release()
