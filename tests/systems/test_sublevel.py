"""Sub-levels: rings of blades and strips, and orientations of strips (F1, F2, G3)."""

from collections.abc import Callable
from itertools import pairwise
from math import pi

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.camera import projection_matrix, view_matrix, view_of
from tallgrass.engine.declared.quality import BladeRing, Quality, StripRing
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.transitions import SLACK
from tallgrass.systems.lod import wanted_representation
from tallgrass.systems.see import strips_kept
from tallgrass.systems.show.blades.representation import blade_ring
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.systems.show.strips.representation import USUAL
from tallgrass.systems.show.strips.shown import StripsShown, show_strips
from tallgrass.systems.show.strips.sublevel import (
    APART,
    CROSSED,
    ENOUGH,
    SINKING,
    TIGHTER,
    axis_of,
    effective_slope,
    packed,
    remaining,
    ring_of,
    shows_rows,
    strip_ring,
    strips_along,
    viewing_slope,
)
from tallgrass.systems.site import Site
from tallgrass.systems.transition import FADE
from tallgrass.testing import looking

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
NONE = np.full(1, -1, np.int8)
HOME = np.zeros(2, np.int32)


LIMITS, SPACING = np.array([4, 8], np.float32), np.array([0.4, 0.8, 1.25], np.float32)


@given(st.integers(0, 30), st.floats(-2.0, 3.0), st.floats(0.2, 3.0))
def test_f1_strips_are_coarser_with_distance_and_finer_seen_from_above(
    distance: int, slope: float, height: float
) -> None:
    def ring(distance: int, slope: float) -> int:
        at = np.array([distance], np.int32), np.array([slope], np.float32)
        return int(strip_ring(*at, NONE, LIMITS, SPACING, height=height, slack=SLACK)[0])

    assert ring(distance, -1.0) == (0 if distance <= 4 else 1 if distance <= 8 else 2)
    assert ring(distance, slope) <= ring(distance, slope - 0.5)
    assert ring(distance, slope) <= ring(distance + 3, slope)
    if ring(distance, slope) > 0 and slope > 0.0:
        assert float(SPACING[ring(distance, slope)]) * slope <= height / ENOUGH * 1.0001


@given(st.floats(-1.0, 3.0), st.floats(0.05, 3.0), st.booleans())
@example(steep=1.07, height=0.5, has=True)  # strips that are there already stay here, and others do not come
def test_g3_strips_show_as_rows_where_a_line_of_sight_crosses_too_few(steep: float, height: float, has: bool) -> None:  # noqa: FBT001
    slope = steep * height / (0.3 * CROSSED)
    at = np.array([slope], np.float32), np.array([2], np.int32), np.array([has])
    crossed = height / (0.3 * slope) if slope > 0.0 else np.inf
    slow = shows_rows(*at, height=height, spacing=0.3, slack=SLACK)[0]
    assert shows_rows(*at, height=height, spacing=0.3, slack=0)[0] == (crossed < CROSSED) or crossed == pytest.approx(
        CROSSED
    )
    kept = crossed * (TIGHTER if has else 1.0)
    assert slow == (kept < CROSSED) or kept == pytest.approx(CROSSED)


@given(st.floats(0.05, 20.0), st.integers(0, 40), st.floats(0.05, 3.0))
def test_g3_strips_have_sunk_before_they_show_as_rows(slope: float, distance: int, height: float) -> None:
    def at(distance: int) -> tuple[bool, float]:
        where = np.array([slope], np.float32), np.array([distance], np.int32)
        rows = shows_rows(*where, np.array([False]), height=height, spacing=0.3, slack=0)
        return bool(rows[0]), float(remaining(where[0], where[1].astype(np.float32), height=height, spacing=0.3)[0])

    shows, left = at(distance)
    assert left == 0.0 if shows else left > -1e-6
    assert at(distance + 5)[0] >= shows
    assert at(distance + 5)[1] <= left
    assert left == 1.0 or slope * 0.3 * CROSSED * max(distance / APART, 1.0) > 0.99 * SINKING * height


def test_n2_what_is_left_of_strips_does_not_jump_where_the_eye_crosses_a_border(laid: Laid, look: Look) -> None:
    bowl = 0.008 * (40.0 - np.arange(81.0)[:, None]) ** 2
    site = laid(terrain=Terrain(np.tile(bowl, 81).astype(np.float32), 1.0))
    patch, kept, centres = site.ground.patch, [], []
    for before in (0.5, -0.5):
        look(site, 0.6, before)
        outlook = look(site, 0.6, -1e-4)
        outlook.lens.reach = 2, 40, 50
        centres.append(outlook.viewer.centre.tolist())
        rows = np.array([np.flatnonzero((outlook.patches.cell == (0, -d)).all(axis=1))[0] for d in range(5, 9)])
        kept.append(strips_kept(outlook, rows, site.representations, patch=patch))
    assert centres[0] != centres[1]
    assert 0.1 < kept[0].mean() < 0.9
    np.testing.assert_array_equal(kept[0], kept[1])


def test_strips_that_replace_all_other_grass_are_shown_from_above_too(laid: Laid, look: Look) -> None:
    kept = []
    for lod in ("auto", "strips"):
        site = laid(lod=lod)
        outlook = look(site, 0.6, 0.6, up=6.0)
        near = np.flatnonzero(outlook.patches.alive & (outlook.patches.distance <= 1))
        kept.append(strips_kept(outlook, near, site.representations, patch=site.ground.patch))
    assert kept[0].max() < 0.5
    assert kept[1].min() == 1.0


def test_g3_a_long_lens_shows_rows_of_strips_only_where_blades_look_as_thin(laid: Laid, look: Look) -> None:
    bowl = 0.012 * (40.0 - np.arange(81.0)[:, None]) ** 2
    site = laid(terrain=Terrain(np.tile(bowl, 81).astype(np.float32), 1.0))
    outlook, strips = look(site, 0.6, 0.6), site.representations[1]
    rows = np.flatnonzero(outlook.patches.alive & (outlook.patches.distance > APART))
    away, none = outlook.patches.away[rows].astype(np.float32), np.zeros(len(rows), np.bool_)
    usual, rowed = strips.remaining(outlook, rows, away), strips.unfit(outlook, rows, none, slack=0)
    outlook.lens.zoom = 3.0
    np.testing.assert_array_equal(strips.remaining(outlook, rows, 3.0 * away), usual)
    assert strips.remaining(outlook, rows, away).mean() > usual.mean() + 0.1
    assert strips.unfit(outlook, rows, none, slack=0).sum() < 0.5 * rowed.sum()


def test_g3_on_a_hillside_strips_are_finer_where_a_strong_wind_bends_the_grass(laid: Laid, look: Look) -> None:
    bowl = 0.004 * (40.0 - np.arange(81.0)[:, None]) ** 2
    site = laid(terrain=Terrain(np.tile(bowl, 81).astype(np.float32), 1.0))
    outlook = look(site, 0.6, 0.6)
    strips = site.representations[1]
    ahead = np.flatnonzero(outlook.patches.alive & (outlook.patches.distance > 3))

    def rings(bent: float) -> NDArray[np.int64]:
        outlook.mean_index = bent
        none = np.full(len(ahead), -1, np.int8)
        return ring_of(strips.sublevels(outlook, ahead, none, slack=0))

    calm, usual, strong = rings(0.0), rings(USUAL), rings(0.95)
    np.testing.assert_array_equal(calm, usual)
    assert (strong <= calm).all()
    assert (strong < calm).mean() > 0.2


def test_the_viewing_slope_is_the_grounds_own_slope_and_the_drop_to_it(laid: Laid, look: Look) -> None:
    z = np.arange(81.0)[:, None] - 40.0
    hillside = Terrain(np.tile(-0.5 * z, 81).astype(np.float32), 1.0)
    site = laid(terrain=hillside)
    outlook = look(site, 0.6, 0.6)
    row = np.flatnonzero((outlook.patches.cell == (0, -6)).all(axis=1))
    eye, away = outlook.viewer.eye, 0.6 + 5.5 * 2.5
    expected = (eye[1] - 0.5 * 5.5 * 2.5) / away
    slope, drop = viewing_slope(outlook.patches, row, eye=eye, patch=site.ground.patch)
    assert float(slope[0]) == pytest.approx(0.5 + expected, rel=0.01)
    assert float(drop[0]) == pytest.approx(expected, rel=0.01)


@given(st.integers(-100, 500), st.integers(-100, 500), st.integers(0, 40))
def test_f2_what_is_looked_down_on_counts_the_steeper_the_farther_it_is(
    percent: int, below: int, distance: int
) -> None:
    slope, drop = percent / 100.0, below / 100.0

    def at(distance: int) -> float:
        one = np.array([slope], np.float32), np.array([drop], np.float32), np.array([distance], np.int32)
        return float(effective_slope(*one)[0])

    assert at(distance + 5) >= at(distance) >= np.float32(slope)
    if drop <= 0.0 or slope <= 0.0 or distance <= APART:
        assert at(distance) == np.float32(slope), "a hillside before the eye, or one that falls away"
    else:
        assert at(distance + 5) > min(slope, drop)


@given(st.lists(st.tuples(st.integers(0, 15), st.integers(0, 1)), max_size=20))
def test_g3_ring_and_axis_are_found_again_in_the_sub_level_that_they_make(pairs: list[tuple[int, int]]) -> None:
    ring, axis = np.array(pairs, np.int8).reshape(-1, 2).T
    sublevel = packed(ring, axis)
    assert (sublevel >= 0).all()
    np.testing.assert_array_equal(ring_of(sublevel), ring)
    np.testing.assert_array_equal(axis_of(sublevel), axis)
    assert (ring_of(NONE) == -1).all()


@given(st.integers(-50, 50), st.integers(-50, 50), st.floats(0.05, 0.95), st.floats(0.05, 0.95))
def test_g3_no_strip_is_shown_edge_on(i: int, j: int, x: float, z: float) -> None:
    along = int(strips_along(np.array([[i, j]], np.int32), HOME, NONE)[0])
    sight = np.array([i + 0.5 - x, j + 0.5 - z])
    if max(abs(i), abs(j)) >= 3:
        across = abs(sight[1 - along]) / np.linalg.norm(sight)
        assert across > np.sin(np.radians(30.0))


def test_g3_turning_the_view_by_ninety_degrees_swaps_the_strips_orientation() -> None:
    ahead = np.array([(i, -j) for j in range(3, 9) for i in range(-j + 1, j)], np.int32)
    to_the_right = np.stack([-ahead[:, 1], ahead[:, 0]], -1)
    none = np.full(len(ahead), -1, np.int8)
    assert (strips_along(ahead, HOME, none) == 0).all()
    assert (strips_along(to_the_right, HOME, none) == 1).all()


@given(st.integers(0, 30), st.integers(-1, 2), st.sampled_from(["blades", "strips"]))
def test_f1_a_finer_ring_is_kept_for_one_patch_more(distance: int, current: int, level: str) -> None:
    def ring(distance: int, current: int) -> int:
        at, has = np.array([distance], np.int32), np.array([current], np.int8)
        if level == "blades":
            return int(blade_ring(at, has, LIMITS, slack=SLACK)[0])
        return int(strip_ring(at, np.zeros(1, np.float32), has, LIMITS, SPACING, height=1.0, slack=SLACK)[0])

    due, nearer = ring(distance, -1), ring(max(distance - SLACK, 0), -1)
    assert nearer <= ring(distance, current) <= due
    assert ring(distance, current) in (due, nearer, current)


@given(st.integers(-40, 40), st.integers(-40, 40), st.sampled_from([(1, 0), (-1, 0), (0, 1), (0, -1)]))
def test_g3_pacing_over_a_border_turns_no_strips_twice(i: int, j: int, step: tuple[int, int]) -> None:
    cell, there = np.array([[i, j]], np.int32), np.array(step, np.int32)
    along, turns = strips_along(cell, HOME, NONE), 0
    for number in range(12):
        now = strips_along(cell, there if number % 2 else HOME, along)
        turns += int(now[0] != along[0])
        along = now
    assert turns <= 1


def sublevels(outlook: Outlook, level: int) -> NDArray[np.bool_]:
    """Return the mask of visible patches that change a representation's sub-level."""
    patches = outlook.patches
    return np.asarray(patches.shown & (patches.sublevel_progress[level] < 1.0))


@pytest.mark.parametrize("level", [0, 1])
def test_f1_what_is_seen_goes_to_another_sub_level_by_and_by(laid: Laid, look: Look, level: int) -> None:
    site = laid(terrain=FLAT)
    assert not sublevels(look(site, 1.25, 1.2), level).any()
    assert not sublevels(look(site, 1.25, 1.25, dt=0.0), level).any()
    assert sublevels(look(site, 1.25, 5.1, dt=0.0), level).any()
    assert not sublevels(look(site, 1.25, 5.1, dt=FADE * 1.01), level).any()


def test_patches_that_change_their_sub_level_alone_count_as_no_transition(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2)
    outlook = look(site, 1.25, 5.1, dt=0.0)
    changing = outlook.patches.shown & (outlook.patches.progress < 1.0)
    assert ((sublevels(outlook, 0) | sublevels(outlook, 1)) & ~changing).sum() > 5
    assert outlook.changing == changing.sum() > 5
    assert not sublevels(outlook, 2).any(), "the coarsest has one alone"
    assert len(set(outlook.patches.sublevel[2].tolist())) == 1


def test_f1_what_is_not_seen_takes_its_sub_level_at_once(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2, yaw=0.0)
    outlook = look(site, 1.25, 5.1, yaw=pi, dt=0.0)
    assert not sublevels(outlook, 0).any()
    assert not sublevels(outlook, 1).any()


def test_f1_who_looks_away_and_back_finds_the_sub_levels_of_who_has_never_looked(laid: Laid, look: Look) -> None:
    there, fresh = laid(terrain=FLAT), laid(terrain=FLAT)
    look(there, 1.25, 1.2, yaw=0.0)
    look(there, 1.25, 5.1, yaw=0.0, dt=0.0)
    away = look(there, 1.25, 5.1, yaw=pi, dt=0.0)
    assert (away.patches.sublevel_progress == 1.0).all()
    back, new = look(there, 1.25, 5.1, yaw=0.0, dt=0.0).patches, look(fresh, 1.25, 5.1, yaw=0.0).patches
    for level in (0, 1):
        has = back.shown & (back.representation == level)
        assert has.sum() > 5
        np.testing.assert_array_equal(back.sublevel[level, has], new.sublevel[level, has])


def test_f1_a_patch_whose_strips_change_shows_every_blade_once(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2)
    look(site, 1.25, 8.8, dt=0.0)
    rings = look(site, 1.25, 8.8, dt=0.3 * FADE).shows(StripsShown).rings
    rows = np.concatenate([ring.rows for ring in rings])
    least, most = (np.concatenate([getattr(ring, name) for ring in rings]) for name in ("least", "most"))
    twice = np.flatnonzero(np.bincount(rows) == 2)
    assert len(twice) > 5
    for row in twice.tolist():
        ends = sorted(zip(least[rows == row].tolist(), most[rows == row].tolist(), strict=True))
        assert ends[0][0] == 0.0
        assert ends[0][1] == ends[1][0]
        assert min(ends[0][1], 1.0 - ends[0][1]) == pytest.approx(0.3, abs=1e-5)
        assert ends[1][1] == 1.0
    once = np.flatnonzero(np.bincount(rows) == 1)
    assert all((least[rows == row] == 0.0).all() and (most[rows == row] == 1.0).all() for row in once)


def painted(outlook: Outlook, row: int) -> set[tuple[int, int, float, float]]:
    """Return the strips that show a patch: ring, axis, and the range of ranks of their painted blades."""
    rings = outlook.shows(StripsShown).rings
    return {
        (number, int(ring.along[at]), round(float(ring.least[at]), 3), round(float(ring.most[at]), 3))
        for number, ring in enumerate(rings)
        for at in np.flatnonzero(ring.rows == row)
    }


def test_f1_where_strips_turn_back_half_way_no_blade_jumps(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2)
    look(site, 1.25, 8.8, dt=0.0)
    outlook = look(site, 1.25, 8.8, dt=0.3 * FADE)
    patches, cover = outlook.patches, outlook.appearance.cover[1]
    rows = [row for row in patches.shown.nonzero()[0].tolist() if len(painted(outlook, row)) == 2]
    there = [painted(outlook, row) for row in rows]
    now, before, progress = (
        column[1] for column in (patches.sublevel, patches.sublevel_before, patches.sublevel_progress)
    )
    now[rows], before[rows], progress[rows] = before[rows], now[rows], 1.0 - progress[rows]
    outlook.shown["strips"] = show_strips(outlook, cover, level=1, side=patches.side, rings=3)
    assert len(rows) > 5
    assert [painted(outlook, row) for row in rows] == there


def test_f1_blades_slide_from_one_ring_to_the_next_in_the_finer_one(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2)
    slides = []
    for step in range(6):
        outlook = look(site, 1.25, -1.3, dt=0.24 * FADE if step else 0.0)
        patches, (fine, coarse) = outlook.patches, outlook.shows(BladesShown).rings
        nearer = patches.sublevel[0][fine.rows] < patches.sublevel_before[0][fine.rows]
        slides.append(sorted(set(fine.slide[nearer].tolist())))
        assert (coarse.slide == 0.0).all()
    assert slides[0] == [1.0]
    assert all(len(values) == 1 for values in slides[:5])
    assert all(before[0] > after[0] for before, after in pairwise(slides[:4]))
    assert slides[5] == []


@pytest.mark.parametrize(("view", "zoom"), [(90.0, 1.0), (45.0, 1.0), (8.0, 5.924)])
def test_g3_a_narrow_lens_brings_finer_rings_as_far_as_it_brings_things_near(
    laid: Laid, look: Look, view: float, zoom: float
) -> None:
    outlook = look(laid(), 0.6, 0.6)
    camera = looking(0.6, 1.7, 0.6, view=view)
    outlook.look(view_of(view_matrix(camera), projection_matrix(camera.view, 16 / 9)), time=0.0, leap=5.0)
    assert outlook.lens.zoom == pytest.approx(zoom, rel=1e-3)
    assert outlook.lens.rings_in((3, 7)) == pytest.approx((3.0 * zoom, 7.0 * zoom), rel=1e-3)


def test_a_ring_of_strips_may_serve_no_distance_but_only_what_is_seen_from_above() -> None:
    blades = [BladeRing(to=2, segments=2)]
    strips = [StripRing(to=to, strips=count) for to, count in ((2, 8), (2, 5), (6, 3))]
    assert Quality(blade_rings=blades, strip_rings=strips, carpet_to=9).strip_rings == strips
    with pytest.raises(ValueError, match="to must be at least 2, where the ring before it ends"):
        Quality(blade_rings=blades, strip_rings=[StripRing(to=1, strips=8), *strips], carpet_to=9)
    with pytest.raises(ValueError, match="to must exceed 2"):
        Quality(blade_rings=[*blades, *blades], strip_rings=strips, carpet_to=9)


@pytest.mark.parametrize("begun", [0.3, 0.7])
def test_x3_a_patch_ends_the_change_of_its_sublevel_before_it_goes_to_blades(
    laid: Laid, look: Look, begun: float
) -> None:
    """The change goes on to its nearer end, and jumps to neither."""
    site = laid(terrain=FLAT)
    look(site, 1.25, 1.2)
    look(site, 1.25, 1.25, dt=0.0)
    patches = look(site, 1.25, 5.1, dt=0.0).patches
    standing = patches.shown & (patches.representation == 1) & (patches.progress >= 1.0)
    row = int(np.flatnonzero(standing & (patches.sublevel_progress[1] < 1.0))[0])
    look(site, 1.25, 5.1, dt=begun * FADE)
    before = patches.sublevel_progress[1, row]
    patches.hold[row] = 0
    ways: list[float] = []
    while patches.representation[row] == 1 and len(ways) < 30:
        look(site, 1.25, 5.1, dt=0.05 * FADE)
        ways.append(float(patches.sublevel_progress[1, row]))
    assert before == pytest.approx(begun)
    assert 6 <= len(ways) <= 11  # half of the change, and a step to begin with
    np.testing.assert_allclose(np.diff(ways[1:-1]), 0.05, atol=1e-5)
    assert (ways[-1], patches.progress[row]) == (1.0, 0.0)


def test_f2_of_patches_within_reach_of_strips_those_that_are_looked_down_on_are_carpet(laid: Laid, look: Look) -> None:
    site, passed = laid(terrain=FLAT), {}
    for up in (0.8, 5.0):
        patches = look(site, 0.6, 0.6, up=up).patches
        near = wanted_representation(patches.away, np.full(len(patches.away), -1, np.int8), reach=site.reach)
        strips = patches.visible & (near == 1)
        passed[up] = (strips & (patches.wanted == 2)).sum()
        assert (strips & (patches.wanted == 1)).sum() > 50
    assert passed[0.8] == 0
    assert passed[5.0] > 8
