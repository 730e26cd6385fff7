"""Sowing and clearing: densities that a game changes, in cells of 0.2 m on a terrain of any size (F4)."""

from collections.abc import Callable
from math import inf, pi

import moderngl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.footprint import Footprint, Road
from tallgrass.components.pose import HERE, Pose
from tallgrass.engine.terrain.plots import CELL, CELLS, SIDE, Plots, middles
from tallgrass.engine.terrain.record import Density
from tallgrass.engine.terrain.rectangle import Rectangle
from tallgrass.engine.terrain.sample import density_at, density_on_lines, own_density_at, painted_at
from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.mow.area import Area, signed_distances, stroke
from tallgrass.systems.mow.card import ROOM, WIDTH
from tallgrass.systems.mow.sown import carry_over, clear, sow

Probe = Callable[..., NDArray[np.float32]]

ON_PAGE = """\
#include "lib/plots.glsl"
in vec3 row;
out vec4 told;
void main() {
    told = page_texel(int(row.x), row.yz, 0.0);
}
"""

PAINTED = np.random.default_rng(4).random((3, 6, 8)).astype(np.float32)
PAINTED[:2] /= PAINTED[:2].sum(axis=0)
AMONG = False, False, True
"""Two kinds of grass that fill the ground between them, and flowers among both."""

BOX = Footprint(corners=((-4.0, -3.0), (4.0, -3.0), (4.0, 3.0), (-4.0, 3.0)))
KITE = Footprint(corners=((0.0, -9.0), (4.0, 0.0), (0.0, 3.0), (-4.0, 0.0)))
HOLLOW = Footprint(corners=((-5.0, -5.0), (5.0, -5.0), (5.0, 5.0), (0.0, -2.0), (-5.0, 5.0)))
STAR = Footprint(corners=((0.0, -4.0), (2.4, 3.2), (-3.8, -1.2), (3.8, -1.2), (-2.4, 3.2)))
BEND = Road(((-20.0, 0.0), (0.0, 0.0), (12.0, 16.0)), 3.0)
AREAS = st.sampled_from([BOX, BEND, Footprint(radius=2.5), Footprint(radius=1.0, length=9.0)])
POSES = st.builds(Pose, st.floats(-15.0, 15.0), st.floats(-15.0, 15.0), st.floats(-pi, pi))
PLACES = np.random.default_rng(2).uniform(-40.0, 40.0, (4000, 2)).astype(np.float32)
STEP = 1.0 / 255.0


def nothing(part: Rectangle) -> Floats:
    return np.full((part.rows, part.columns), inf, np.float32)


def meadow(size: float = 100.0) -> Density:
    return Density(PAINTED, (size, size))


def by_hand(area: Area, pose: Pose, place: Floats) -> Floats:
    """Return the distances of places outside of an area, by points along its outline."""
    own = pose.inside(place)
    if isinstance(area, Road):
        line = np.concatenate([np.linspace(a, b, 400) for a, b in zip(area.line[:-1], area.line[1:], strict=True)])
        away = np.hypot(*(own[:, None] - line[None]).transpose(2, 0, 1)).min(axis=1) - area.width / 2.0
        return np.asarray(away, np.float32)
    off = np.abs(own) - (4.0, 3.0)
    return np.asarray(np.hypot(*np.maximum(off, 0.0).T) + np.minimum(off.max(axis=1), 0.0), np.float32)


@pytest.mark.parametrize("area", [BOX, BEND])
def test_f4_how_far_off_an_area_is_a_road_bends_and_a_house_has_corners(area: Area) -> None:
    pose = Pose(2.0, -3.0, 0.7)
    np.testing.assert_allclose(signed_distances(area, pose, PLACES), by_hand(area, pose, PLACES), atol=0.04)


@settings(deadline=None, max_examples=15)
@given(
    st.sampled_from([BOX, KITE, HOLLOW, STAR, Footprint(corners=tuple(reversed(KITE.corners)))]),
    POSES,
    st.floats(0.1, 4.0),
)
def test_f4_a_stroke_is_told_of_each_cell_how_far_off_it_is(area: Footprint, pose: Pose, beyond: float) -> None:
    plots = Plots((100.0, 100.0), np.dtype(np.float32))
    stroke(plots, area, pose, lambda before, away: np.where(away <= beyond, away, before), nothing, beyond=beyond)
    for part in plots.parts(np.full(2, -35.0, np.float32), np.full(2, 35.0, np.float32)):
        away = signed_distances(area, pose, middles(part).reshape(-1, 2)).reshape(part.rows, part.columns)
        held = plots.held(part)
        told, away = (np.maximum(each, -CELL) for each in (nothing(part) if held is None else held, away))
        np.testing.assert_allclose(told[away < beyond - 1e-4], away[away < beyond - 1e-4], atol=1e-4)
        assert (told[away > beyond + 1e-4] == inf).all()


@settings(deadline=None, max_examples=25)
@given(AREAS, POSES, st.floats(0.0, 4.0))
def test_f4_what_is_cleared_is_bare_and_thins_out_over_its_verge(area: Area, pose: Pose, soft: float) -> None:
    density = meadow()
    before = density_at(density, PLACES)
    clear(density, area, pose, soft=soft)
    after, away = density_at(density, PLACES), signed_distances(area, pose, PLACES)
    due = np.clip(away / max(soft, 1e-3), 0.0, 1.0) * before
    assert (after[:, away < -1.5 * CELL] == 0.0).all()
    np.testing.assert_allclose(after[:, away > soft + 1.5 * CELL], before[:, away > soft + 1.5 * CELL], atol=0.02)
    assert np.abs(after - due).max() < 2.0 * STEP + 1.5 * CELL / max(soft, 1.5 * CELL)


@settings(deadline=None, max_examples=25)
@given(
    st.lists(
        st.tuples(st.sampled_from([-1, 0, 1, 2]), AREAS, POSES, st.floats(0.0, 1.0), st.floats(0.0, 2.0)), max_size=5
    )
)
def test_f4_kinds_of_grass_never_come_to_more_than_all_of_the_ground(
    strokes: list[tuple[int, Area, Pose, float, float]],
) -> None:
    density = meadow()
    for kind, area, pose, dense, soft in strokes:
        if kind < 0:
            clear(density, area, pose, soft=soft)
        else:
            sow(density, kind, AMONG, area, dense, pose, soft=soft)
    found = density_at(density, PLACES)
    assert found.min() >= 0.0
    assert found[:2].sum(axis=0).max() <= 1.0 + 3.0 * STEP
    kinds = np.arange(len(PLACES)) % 3
    np.testing.assert_array_equal(own_density_at(density, kinds, PLACES), found[kinds, np.arange(len(PLACES))])


def test_f4_what_is_sown_makes_others_give_way_and_flowers_take_no_ground() -> None:
    density, inside = meadow(), np.abs(PLACES).max(axis=1) < 2.5
    before = density_at(density, PLACES[inside])
    sow(density, 0, AMONG, BOX, 0.75, HERE, soft=0.0)
    found = density_at(density, PLACES[inside])
    np.testing.assert_allclose(found[0], 0.75, atol=STEP)
    np.testing.assert_allclose(found[1], np.minimum(before[1], 0.25), atol=2 * STEP)
    np.testing.assert_allclose(found[2], before[2], atol=STEP)
    sow(density, 2, AMONG, BOX, 1.0, HERE, soft=0.0)
    np.testing.assert_allclose(density_at(density, PLACES[inside])[:2], found[:2], atol=STEP)


def test_f4_on_10_km_only_plots_that_are_touched_take_room_and_those_all_alike_share_one_page() -> None:
    density, there = meadow(10_000.0), Pose(-3000.0, 4100.0)
    clear(density, Footprint(radius=300.0), there, soft=0.0)
    plots = density.sown
    touched = (plots.index >= 0).sum()
    assert touched * SIDE**2 == pytest.approx(pi * 300.0**2, rel=0.1)
    assert len(plots.written) < 0.25 * touched
    place = np.array([(-3000.0, 4100.0), (-3299.0, 4100.0), (-3301.0, 4100.0)], np.float32)
    assert (density_at(density, place).sum(axis=0) > 0.0).tolist() == [False, False, True]
    pages = len(plots.written)
    sow(density, 1, AMONG, Footprint(radius=1.0), 0.5, there, soft=0.0)
    assert len(plots.written) == pages + len(plots.since(plots.count - 1) or ()), (
        "a page that many have is not written on"
    )


def test_f4_a_stroke_tells_only_what_it_has_changed() -> None:
    density = meadow()
    clear(density, BOX, HERE, soft=0.0)
    count = density.sown.count
    clear(density, Footprint(radius=2.0), HERE, soft=0.0)
    assert density.sown.count == count, "nothing grows there"
    sow(density, 0, AMONG, Footprint(radius=1.0), 1.0, Pose(1.5, 1.5), soft=0.0)
    (part,) = density.sown.since(count) or []
    assert max(part.rows, part.columns) * CELL < 2.9


def test_f4_beyond_the_terrain_nothing_is_cleared() -> None:
    density = meadow()
    clear(density, Footprint(radius=80.0), HERE, soft=0.0)
    inside, outside = (
        np.array([(50.0, 0.0), (0.0, -50.0)], np.float32),
        np.array([(50.2, 0.0), (0.0, -50.2)], np.float32),
    )
    assert (density_at(density, inside) == 0.0).all()
    np.testing.assert_array_equal(density_at(density, outside), painted_at(density, outside))
    lines = np.array([[49.0, 51.0]], np.float32)
    found = density_on_lines(density, lines, np.zeros_like(lines))[:, 0, 0]
    assert (found[:, 0] == 0.0).all()
    np.testing.assert_array_equal(found[:, 1:], painted_at(density, np.array([(51.0, 0.0)], np.float32)))


def test_f4_what_was_sown_stays_where_all_else_is_painted_anew() -> None:
    density = meadow()
    clear(density, BEND, HERE, soft=1.0)
    other = Density(PAINTED[[1, 0, 2]], (60.0, 40.0))
    painted = painted_at(other, PLACES)
    carry_over(density, other, [1, 0, 2])
    on = (np.abs(PLACES) < (29.0, 19.0)).all(axis=1)
    away = signed_distances(BEND, HERE, PLACES)
    found = density_at(other, PLACES)
    assert (found[:, on & (away < -1.5 * CELL)] == 0.0).all()
    free = on & (away > 1.0 + 1.5 * CELL)
    np.testing.assert_allclose(
        found[:, free], painted[:, free], atol=0.02
    )  # a plot's outermost cells go on to its edge


def test_f4_what_was_sown_stays_of_its_kind_where_kinds_come_go_and_change_places() -> None:
    density, now = meadow(), np.full((3, 2, 2), 0.25, np.float32)
    sow(density, 1, AMONG, Footprint(radius=6.0), 1.0, HERE, soft=0.0)
    other = Density(now, (100.0, 100.0))
    carry_over(density, other, [None, 1, 0])  # the flowers are gone, and another kind comes first
    found, away = density_at(other, PLACES), np.hypot(*PLACES.T)
    np.testing.assert_array_equal(found[:, away < 5.5], np.tile([[0.0], [1.0], [0.0]], (away < 5.5).sum()))
    np.testing.assert_allclose(found[:, away > 6.5], 0.25, atol=STEP)


def test_f4_a_map_is_saved_and_brought_back_to_the_bit() -> None:
    one, other = meadow(), meadow()
    clear(one, Footprint(radius=30.0), HERE, soft=3.0)
    sow(one, 1, AMONG, BEND, 0.4, HERE, soft=0.0)
    clear(other, BOX, Pose(20.0, 20.0), soft=0.0)
    other.sown.resume(*one.sown.saved())
    np.testing.assert_array_equal(density_at(other, PLACES), density_at(one, PLACES))
    for each in (one, other):
        sow(each, 0, AMONG, Footprint(radius=9.0), 0.3, Pose(4.0, 4.0), soft=1.0)
    np.testing.assert_array_equal(density_at(other, PLACES), density_at(one, PLACES))
    small = meadow()
    clear(small, BOX, Pose(20.0, 20.0), soft=0.0)
    other.sown.resume(*small.sown.saved())
    assert other.sown.ends == small.sown.ends != one.sown.ends, "edges are looked for where any are now"
    other.sown.resume(*meadow().sown.saved())
    np.testing.assert_array_equal(density_at(other, PLACES), density_at(meadow(), PLACES))


@pytest.mark.parametrize(
    ("arguments", "error", "told"),
    [
        ((0.5, 0.5, HERE), TypeError, r"^grass is sown under a Footprint or a Road, not under 0\.5$"),
        ((BOX, 1.5, HERE), ValueError, r"^grass is sown with a density from 0 to 1, not 1\.5$"),
        ((BOX, "much", HERE), TypeError, r"^grass is sown with a density from 0 to 1, not 'much'$"),
        ((BOX, 0.5, (0, 0)), TypeError, r"^a footprint lies at a Pose, not at \(0, 0\)$"),
        ((BOX, 0.5, Pose(inf)), ValueError, "^a footprint lies where x, .* finite numbers, at most"),
    ],
)
def test_f4_what_cannot_be_sown_is_told_in_a_sentence(arguments: tuple[object, ...], error: type, told: str) -> None:
    density = meadow()
    with pytest.raises(error, match=told):
        sow(density, 0, AMONG, *arguments, soft=0.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"^a verge is from 0 to 1000 m wide, not -1\.0$"):
        clear(density, BOX, HERE, soft=-1.0)
    assert not density.sown.any


@pytest.mark.parametrize("line", [[(0.0, 0.0)], [], [(0.0, 0.0), (1.0, inf)], [(0.0, 0.0), (1e5, 0.0)]])
def test_f4_what_is_no_road_is_told_in_a_sentence(line: list[tuple[float, float]]) -> None:
    with pytest.raises(ValueError, match=r"^a road goes through 2 or more places \(x, z\) within 20000 m$"):
        Road(tuple(line))
    with pytest.raises(ValueError, match=r"^a road's width is from 0\.05 to 1000 m, not 0$"):
        Road(((0.0, 0.0), (1.0, 0.0)), 0)


def test_a_plot_ends_where_its_mip_maps_do() -> None:
    assert CELLS & (CELLS - 1) == 0


def test_n5_what_a_page_has_is_the_same_wherever_it_lies(ctx: moderngl.Context, probe: Probe) -> None:
    """A restored prairie has its pages in another order, and must still be the same byte for byte."""
    random, down, across = np.random.default_rng(5), ROOM + 1, WIDTH // CELLS
    page = random.integers(0, 256, (CELLS, CELLS, 4), np.uint8)
    texture = ctx.texture((WIDTH, CELLS * down), 4, np.tile(page, (down, across, 1)).tobytes())
    texture.filter = moderngl.LINEAR, moderngl.LINEAR
    rows = np.zeros((1000, 3), np.float32)
    rows[:, 1:] = random.uniform(0.0, CELLS, (1000, 2))
    told = []
    for number in (0, across - 1, across, down * across - 1):
        rows[:, 0] = number
        told.append(probe(ON_PAGE, rows, np.zeros(1, FRAME), {"plots": texture}, 4))
    texture.release()
    assert np.ptp(told[0]) > 0.9
    for each in told[1:]:
        np.testing.assert_array_equal(each, told[0])
