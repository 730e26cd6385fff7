"""Levels of detail: ranges, hysteresis and transitions (T4, X1, X2)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.around.patches import PatchTable
from tallgrass.systems.around.transitions import SLACK
from tallgrass.systems.lod import farthest, wanted_representation
from tallgrass.systems.show.registry import NAMES, REPRESENTATIONS
from tallgrass.systems.transition import FADE, change_representations, due_representations, step_of_change, weights

REACH = (2, 5, 9)
BLADES, STRIPS, CARPET = range(3)
STEP = 0.05


class Walk:
    """A patch, and a viewer that approaches and leaves it."""

    def __init__(self, distance: int, *, alive: bool = True, reach: tuple[int, int, int] = REACH) -> None:
        self.reach = reach
        self.table = PatchTable.allocate(1, NAMES)
        self.table.alive[:] = alive
        self.was_visible = False
        self.go(distance, dt=1e9)

    def go(self, distance: int, *, dt: float = STEP, visible: bool = True, step: float | None = None) -> None:
        """Put the viewer at a distance for one frame, in which a change progresses by a step."""
        table = self.table
        table.distance[:] = distance
        table.visible[:] = visible
        table.wanted[:] = wanted_representation(table.distance, table.representation, reach=self.reach)
        settled = np.array([self.was_visible]) & table.visible
        due = due_representations(table, reach=self.reach)
        change_representations(table, due, settled, reach=self.reach, step=dt / FADE if step is None else step)
        self.was_visible = visible

    @property
    def shown(self) -> NDArray[np.float32]:
        return weights(self.table)[:, 0]

    def settled(self) -> bool:
        return float(self.table.progress[0]) >= 1.0


def due(distance: int, current: int = -1) -> int:
    return int(wanted_representation(np.array([distance], np.int32), np.array([current], np.int8), reach=REACH)[0])


def test_t4_each_representation_has_its_range_of_discrete_distance() -> None:
    assert [due(distance) for distance in range(12)] == [BLADES] * 3 + [STRIPS] * 3 + [CARPET] * 6


@given(st.integers(0, 200), st.integers(-1, 2), st.integers(0, 60), st.integers(1, 60))
def test_x1_a_patch_is_never_coarser_than_due_nor_finer_for_more_than_the_slack(
    distance: int, current: int, blades: int, more: int
) -> None:
    reach = (blades, blades + more, blades + more + 9)
    place, has = np.array([distance], np.int32), np.array([current], np.int8)
    wanted = int(wanted_representation(place, has, reach=reach)[0])
    plain = int(wanted_representation(place, np.array([-1], np.int8), reach=reach)[0])
    nearer = int(wanted_representation(place - SLACK, np.array([-1], np.int8), reach=reach)[0])
    assert nearer <= wanted <= plain
    assert wanted in (plain, nearer, current)


@pytest.mark.parametrize("preset", PRESETS)
@pytest.mark.parametrize("limit", [0, 1])
def test_x1_pacing_to_and_fro_over_a_limit_leaves_nothing_in_transition(preset: str, limit: int) -> None:
    reach = tuple(each.reach(PRESETS[preset]) for each in REPRESENTATIONS)
    table = PatchTable.allocate(1, NAMES)
    table.alive[:], table.visible[:] = True, True
    for frame in range(200):
        table.distance[:] = reach[limit] + (frame // 7) % 2
        wanted = wanted_representation(table.distance, table.representation, reach=reach)
        change_representations(table, wanted, table.visible, reach=reach, step=STEP / FADE)
        assert table.progress[0] == 1.0
    assert table.representation[0] == limit


def test_x1_a_visible_patch_whose_distance_crosses_a_limit_changes_slowly() -> None:
    walk = Walk(REACH[0] + SLACK)
    assert walk.shown.tolist() == [0, 1, 0]
    walk.go(REACH[0])
    assert not walk.settled()
    strips = []
    while not walk.settled():
        strips.append(walk.shown[STRIPS])
        walk.go(REACH[0])
    assert len(strips) >= 10
    assert strips[0] == 1.0
    assert (np.diff(strips) < 0.0).all()
    assert (np.diff(strips) > -0.1).all()
    assert walk.shown.tolist() == [1, 0, 0]


def test_x1_going_away_changes_one_patch_later_than_coming_back() -> None:
    walk = Walk(0)
    changed = {}
    for distance in (*range(10), *range(10, -1, -1)):
        before = int(walk.table.representation[0])
        for _ in range(30):
            walk.go(distance)
        if int(walk.table.representation[0]) != before:
            changed[(before, int(walk.table.representation[0]))] = distance
    assert changed == {
        (BLADES, STRIPS): REACH[0] + SLACK + 1,
        (STRIPS, CARPET): REACH[1] + SLACK + 1,
        (CARPET, STRIPS): REACH[1],
        (STRIPS, BLADES): REACH[0],
    }


@pytest.mark.parametrize("seen_again", [True, False])
def test_x1_a_patch_that_was_not_visible_takes_its_representation_at_once(*, seen_again: bool) -> None:
    walk = Walk(0)
    walk.go(0, visible=False)
    walk.go(farthest(REACH)[0], visible=seen_again)  # pools still have room here, so it could change slowly
    assert walk.settled()
    assert walk.shown.tolist() == [0, 1, 0]


def test_x1_a_change_that_turns_back_in_its_middle_goes_back_from_where_it_is() -> None:
    walk = Walk(REACH[0] + 1)
    for _ in range(8):
        walk.go(REACH[0])
    there = walk.shown
    assert 0.2 < there[BLADES] < 0.8
    walk.go(REACH[0] + SLACK + 1, dt=0.0)
    np.testing.assert_allclose(walk.shown, there, atol=1e-6)
    back = []
    while not walk.settled():
        back.append(walk.shown[BLADES])
        walk.go(REACH[0] + SLACK + 1)
    assert (np.diff(back) < 0.0).all()
    assert len(back) == pytest.approx(8, abs=1)
    assert walk.shown.tolist() == [0, 1, 0]


def test_x1_a_leap_over_two_limits_is_one_change() -> None:
    walk = Walk(0, reach=(2, 3, 9))
    walk.go(5)
    for _ in range(6):
        walk.go(5)
        assert walk.shown[STRIPS] == 0.0
        assert 0.0 < walk.shown[CARPET] < 1.0


def test_x1_a_third_representation_waits_until_the_change_is_over() -> None:
    walk = Walk(0, reach=(2, 3, 9))
    walk.go(4)
    walk.go(5)
    assert walk.shown[CARPET] == 0.0
    seen = []
    for _ in range(60):
        walk.go(5)
        seen.append(walk.shown)
    assert np.array(seen)[:, STRIPS].max() > 0.9
    assert walk.shown.tolist() == [0, 0, 1]


@given(st.lists(st.integers(0, 12), min_size=2, max_size=20))
def test_x1_a_viewer_who_is_too_fast_leaves_no_finer_grass_behind_than_there_is_room_for(story: list[int]) -> None:
    walk, (blades, strips) = Walk(0), farthest(REACH)
    for distance in story:
        walk.go(distance, dt=0.01)
        assert walk.shown[BLADES] == 0.0 or distance <= blades
        assert walk.shown[STRIPS] == 0.0 or distance <= strips


@given(st.floats(0.1, 30.0), st.floats(0.5, 20.0), st.floats(0.001, 0.2))
def test_x2_a_change_is_over_before_a_walker_has_crossed_a_patch(speed: float, patch: float, dt: float) -> None:
    frames = np.ceil(1.0 / step_of_change(dt, way=speed * dt, patch=patch))
    assert (frames - 1) * dt < patch / speed
    assert (frames - 1) * dt < FADE


def test_x2_at_the_papers_pace_a_change_takes_about_a_second() -> None:
    step = step_of_change(STEP, way=1.0 * STEP, patch=2.5)
    assert 16 <= np.ceil(1.0 / step) <= 24


@given(st.lists(st.floats(0.002, 0.3), min_size=1, max_size=12), st.floats(0.0, 12.0))
def test_x2_progress_does_not_depend_on_how_time_is_cut(cuts: list[float], speed: float) -> None:
    progress = []
    for steps in (cuts, [sum(cuts)]):
        walk = Walk(REACH[0] + 1)
        walk.go(REACH[0])
        for dt in steps:
            walk.go(REACH[0], step=step_of_change(dt, way=speed * dt, patch=2.5))
        progress.append(float(walk.table.progress[0]))
    assert progress[0] == pytest.approx(progress[1], abs=1e-5)


Edge = tuple[int, dict[str, Any], tuple[int, int, bool]]

EDGES: dict[str, Edge] = {
    "stays": (REACH[0], {}, (BLADES, BLADES, True)),
    "is due": (REACH[1], {}, (STRIPS, BLADES, False)),
    "is due unseen": (REACH[1], {"visible": False}, (STRIPS, STRIPS, True)),
    "is due out of reach": (farthest(REACH)[0] + 1, {}, (STRIPS, STRIPS, True)),
}
NARROW = (2, 3, 9)
HALFWAY: dict[str, tuple[int, dict[str, Any], tuple[int, int, bool], float]] = {
    "goes on": (4, {"step": 0.25}, (STRIPS, BLADES, False), 0.75),
    "is over": (4, {"step": 0.5}, (STRIPS, STRIPS, True), 1.0),
    "turns back": (0, {"step": 0.0}, (BLADES, STRIPS, False), 0.5),
    "turns back, having gone on": (0, {"step": 0.2}, (BLADES, STRIPS, False), 0.3),
    "a third is due": (5, {"step": 0.25}, (STRIPS, BLADES, False), 0.75),
    "a third is due when it is over": (5, {"step": 0.6}, (CARPET, STRIPS, False), 0.0),
    "is not seen": (4, {"step": 0.1, "visible": False}, (STRIPS, STRIPS, True), 1.0),
    "is not seen, and another is due": (0, {"step": 0.1, "visible": False}, (BLADES, BLADES, True), 1.0),
    "is left behind": (6, {"step": 0.1}, (CARPET, CARPET, True), 1.0),
}


def state(walk: Walk) -> tuple[int, int, bool]:
    return int(walk.table.representation[0]), int(walk.table.previous[0]), walk.settled()


@pytest.mark.parametrize("edge", EDGES)
def test_d3_every_edge_from_a_settled_state(edge: str) -> None:
    distance, how, expected = EDGES[edge]
    walk = Walk(0)
    walk.go(distance, **how)
    assert state(walk) == expected


@pytest.mark.parametrize("edge", HALFWAY)
def test_d3_every_edge_from_a_change_half_way(edge: str) -> None:
    distance, how, expected, progress = HALFWAY[edge]
    walk = Walk(0, reach=NARROW)
    walk.go(4, step=0.0)
    walk.go(4, step=0.5)
    walk.go(distance, **how)
    assert state(walk) == expected
    assert float(walk.table.progress[0]) == pytest.approx(progress)


frames = st.tuples(st.integers(0, 11), st.booleans(), st.floats(0.0, 2.0))


@given(st.lists(frames, min_size=1, max_size=40))
def test_x1_weights_always_sum_to_one_and_never_jump_while_a_patch_stays_visible(
    story: list[tuple[int, bool, float]],
) -> None:
    walk = Walk(0)
    before, was_visible = walk.shown, False
    for distance, visible, dt in story:
        walk.go(distance, dt=dt, visible=visible)
        assert walk.shown.sum() == pytest.approx(1.0, abs=1e-5)
        assert (walk.shown >= 0.0).all()
        if visible and was_visible and distance <= farthest(REACH)[BLADES]:
            assert np.abs(walk.shown - before).max() <= dt / FADE + 1e-5
        before, was_visible = walk.shown, visible


def test_a_row_without_a_patch_shows_nothing() -> None:
    walk = Walk(0, alive=False)
    walk.go(3)
    assert walk.shown.tolist() == [0, 0, 0]


def test_t4_a_forced_representation_has_all_the_range() -> None:
    reach = (-SLACK - 1, 6, 9)
    distance = np.arange(9, dtype=np.int32)
    wanted = wanted_representation(distance, np.full(9, BLADES, np.int8), reach=reach)
    assert (wanted >= STRIPS).all()


# ---- Holding -------------------------------------------------------------------------------------


@pytest.mark.parametrize("hold", [STRIPS, CARPET])
def test_a_held_patch_goes_there_by_and_by_and_comes_back_when_it_is_let_go(hold: int) -> None:
    walk = Walk(0)
    walk.go(0)
    for target, number in ((hold, hold), (BLADES, -1)):
        start = int(walk.table.representation[0])
        walk.table.hold[:] = number
        walk.go(0)
        assert state(walk) == (target, start, False)
        shown = []
        while not walk.settled():
            shown.append(walk.shown[target])
            walk.go(0)
        assert len(shown) >= 20
        assert (np.diff(shown) > 0.0).all()
        assert walk.shown[target] == 1.0
        for _ in range(50):
            walk.go(0)
        assert state(walk) == (target, target, True)


def test_a_patch_that_is_held_unseen_is_there_at_once() -> None:
    walk = Walk(0)
    walk.table.hold[:] = CARPET
    walk.go(0, visible=False)
    assert state(walk) == (CARPET, CARPET, True)


def test_a_held_patch_stays_what_it_is_whatever_its_distance_wants() -> None:
    walk = Walk(0)
    walk.table.hold[:] = STRIPS
    for distance in (*range(REACH[1] + SLACK + 2), *range(REACH[1] + SLACK + 1, -1, -1)):
        for _ in range(30):
            walk.go(distance)
        assert state(walk) == (STRIPS, STRIPS, True)


def room(hold: int, distance: int) -> int:
    """Return the representation of a patch after it was held for long."""
    walk = Walk(distance)
    walk.table.hold[:] = hold
    for _ in range(90):
        walk.go(distance)
    assert walk.settled()
    return int(walk.table.representation[0])


def test_held_finer_than_there_is_room_for_a_patch_is_the_finest_that_there_is_room_for() -> None:
    blades, strips = farthest(REACH)
    assert [room(BLADES, distance) for distance in range(12)] == [0] * blades + [1] * (strips - blades) + [2] * (
        12 - strips
    )
    assert [room(STRIPS, distance) for distance in range(12)] == [1] * strips + [2] * (12 - strips)
    assert [room(CARPET, distance) for distance in range(12)] == [2] * 12


@pytest.mark.parametrize(("hold", "limit"), [(BLADES, REACH[0]), (STRIPS, REACH[1])])
def test_x1_a_held_patch_that_a_walker_leaves_behind_gives_way_by_and_by(hold: int, limit: int) -> None:
    walk = Walk(limit)
    walk.table.hold[:] = hold
    for _ in range(30):
        walk.go(limit + SLACK + 1)
    assert state(walk) == (hold, hold, True)
    walk.go(limit + SLACK + 2)
    assert state(walk) == (hold + 1, hold, False)
    walk.go(limit + SLACK + 2)
    assert 0.0 < walk.shown[hold + 1] < 0.1


@given(st.lists(st.integers(0, 12), min_size=2, max_size=20), st.sampled_from([BLADES, STRIPS, CARPET]))
def test_x1_a_held_patch_too_is_never_finer_than_there_is_room_for(story: list[int], hold: int) -> None:
    walk, (blades, strips) = Walk(0), farthest(REACH)
    walk.table.hold[:] = hold
    for distance in story:
        walk.go(distance, dt=0.01)
        assert walk.shown[BLADES] == 0.0 or distance <= blades
        assert walk.shown[STRIPS] == 0.0 or distance <= strips


def test_where_nothing_is_wanted_a_patch_is_the_coarsest() -> None:
    table = PatchTable.allocate(1, NAMES)
    assert due_representations(table, reach=REACH).tolist() == [CARPET]
