"""Drift and ghosting of patches in transition (N2, N3)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.app.bench import stroll
from tallgrass.app.bench.drift import ENOUGH, Change, ghosted, grouped, mean_drift, mean_ghosting, sampled_frames
from tallgrass.components.arrays import Doubles


def grass(seed: int) -> Doubles:
    return np.random.default_rng(seed).normal(100.0, 20.0, (40, 40))


def change(bright: list[list[float]], time: list[float], ghosts: list[float] | None = None) -> Change:
    """Return a change with a patch for each column."""
    patches = len(bright[0])
    return Change(
        "ahead", "strips to blades", np.array(time), np.array(bright), np.array(ghosts or [0.0] * len(time)),
        np.zeros(patches, np.int32), np.zeros((patches, 2), np.int64),
    )  # fmt: skip


def test_n3_the_samples_of_a_leg_hold_whole_changes() -> None:
    frames = sampled_frames()
    assert frames[0] < stroll.LEAD * stroll.RATE
    assert frames[-1] > (stroll.LEAD + 1.2) * stroll.RATE
    assert frames[-1] <= round(stroll.SECONDS * stroll.RATE)


def test_n3_drift_is_the_largest_change_of_a_patch_and_its_mean_that_of_all_together() -> None:
    made = change([[1.0, 1.0], [1.1, 0.95], [0.99, 1.1]], [0.0, 0.5, 1.0])
    np.testing.assert_allclose(made.drift, [1 - 0.99 / 1.1, 1.1 / 0.95 - 1], atol=1e-9)
    assert mean_drift([made]) == pytest.approx(0.0451, abs=1e-3)


def test_n3_legs_on_which_few_patches_change_are_taken_together() -> None:
    time = [0.0, 0.5, 1.0]
    brighter = change([[1.0], [1.06], [1.0]], time, [0.0, 0.6, 0.0])
    darker = change([[1.0] * 2, [0.97] * 2, [1.0] * 2], time, [0.0, 0.3, 0.0])
    many = change([[1.0] * ENOUGH, [1.02] * ENOUGH, [1.0] * ENOUGH], time)
    groups = grouped([brighter, many, darker])
    assert list(map(mean_drift, groups)) == pytest.approx([0.02, 0.0], abs=1e-9)
    assert list(map(mean_ghosting, groups)) == pytest.approx([0.0, 0.4])


def test_n3_what_changes_in_more_than_a_second_and_a_half_is_no_drift() -> None:
    made = change([[1.0], [1.05], [1.1]], [0.0, 1.0, 2.0])
    assert made.drift[0] == pytest.approx(0.05, abs=1e-6)


def test_n3_ghosting_counts_on_the_way_and_not_at_its_ends() -> None:
    assert change([[1.0]] * 4, [0.0, 0.4, 0.8, 1.2], [1.0, 0.5, 0.3, 1.0]).ghosting == pytest.approx(0.4)


def test_n2_the_mean_of_two_pictures_is_a_ghost_and_neither_of_them_is() -> None:
    before, after = grass(1), grass(2)
    assert ghosted((before + after) / 2.0, before, after) == pytest.approx(1.0)
    assert ghosted(before, before, after) == pytest.approx(0.0, abs=1e-9)
    assert ghosted(after, before, after) == 0.0


def test_n2_what_is_on_its_way_from_place_to_place_is_no_ghost() -> None:
    assert ghosted(grass(3), grass(1), grass(2)) == 0.0
    place = np.linspace(0.0, 60.0, 400)
    before, between, after = (100.0 + 20.0 * np.sin(place + shift) for shift in (0.0, 1.5, 3.0))
    assert ghosted(between, before, after) < 0.15


@given(st.floats(0.0, 1.0))
def test_n2_a_picture_over_another_is_the_more_a_ghost_the_more_even_they_are(share: float) -> None:
    before, after = grass(1), grass(2)
    assert ghosted(share * before + (1.0 - share) * after, before, after) == pytest.approx(
        4.0 * share * (1.0 - share), abs=1e-6
    )


def test_n2_two_pictures_that_nobody_tells_apart_make_no_ghost() -> None:
    before = grass(1)
    assert ghosted(before + 0.2, before, before + 0.4) == 0.0
