"""Trees grow as the habit says, from their seed alone (F3)."""

from typing import get_args

import numpy as np
import pytest

from tallgrass.engine.declared.tree import HabitName
from tallgrass.systems.trees.crown import leaf_area, shading
from tallgrass.systems.trees.grow import MOST_TWIGS, PIPE, Tree, grown
from tallgrass.systems.trees.habit import HABITS
from tallgrass.systems.trees.motion import (
    LIMB_ACROSS,
    LIMB_HERTZ,
    TONES,
    TRUNK_ACROSS,
    TRUNK_HERTZ,
    limb_hertz,
    trunk_hertz,
)

EVERY = pytest.mark.parametrize("name", get_args(HabitName))


def tree_of(name: HabitName, seed: int = 3) -> Tree:
    habit = HABITS[name]
    return grown(habit, sum(habit.height) / 2.0, seed=seed)


@EVERY
def test_a_tree_is_as_high_as_asked_and_the_same_from_the_same_seed(name: HabitName) -> None:
    tree, again, other = tree_of(name), tree_of(name), tree_of(name, seed=4)
    tips = tree.twigs.foot + tree.twigs.length[:, None] * tree.twigs.along
    assert float(tips[:, 1].max()) == pytest.approx(tree.height, rel=0.1)
    assert np.array_equal(tree.twigs.foot, again.twigs.foot)
    assert not np.array_equal(tree.twigs.foot[:9], other.twigs.foot[:9])


@EVERY
def test_no_stem_is_thicker_than_what_bears_it_and_none_grows_thicker_on_its_way(name: HabitName) -> None:
    tree = tree_of(name)
    trunk, limbs, branches = tree.levels
    assert trunk.radius[0, 0] == pytest.approx(HABITS[name].slender * tree.height / 2.0, rel=1e-6)
    for stems in tree.levels:
        assert (np.diff(stems.radius, axis=1) <= 1e-12).all()
    assert (limbs.radius[:, 0] <= trunk.radius[0, 0]).all()
    assert (branches.radius[:, 0] <= limbs.radius[branches.parent, 0] + 1e-9).all()
    # Where the trunk bears its limbs, the sum of their radii's power goes through it.
    borne = float((limbs.radius[:, 0] ** PIPE).sum())
    assert borne == pytest.approx(float(trunk.radius[0, 0] ** PIPE), rel=0.3)


@EVERY
def test_the_first_twigs_stand_for_all(name: HabitName) -> None:
    foot = tree_of(name).twigs.foot
    assert 1000 < len(foot) <= MOST_TWIGS
    few = foot[: len(foot) // 4]
    assert np.abs(few.mean(axis=0) - foot.mean(axis=0)).max() < 0.06 * float(np.ptp(foot, axis=0).max())


@EVERY
def test_it_has_the_leaves_of_a_tree_and_they_shade_those_below(name: HabitName) -> None:
    tree, habit = tree_of(name), HABITS[name]
    area = leaf_area(tree.twigs, habit.leaf, habit.twigs.length)
    tips = tree.twigs.foot + tree.twigs.length[:, None] * tree.twigs.along
    crown = np.pi * float(np.hypot(tips[:, 0], tips[:, 2]).max()) ** 2
    # Of the ground under a tree that stands free, so many times its area: 2 to 8 (Breda, 2003), columns more.
    assert 1.5 < float(area.sum()) / crown < (14.0 if name == "poplar" else 8.0)
    low, high = (np.array([[0.0, part * tree.height, 0.0]]) for part in (0.05, 1.0))
    below, above = (shading(tree, area, place)[0] for place in (low, high))
    up = np.array([0.0, 1.0, 0.0, 1.0])
    assert below @ up > 4.0 * max(float(above @ up), 0.02)


def test_trunks_and_limbs_swing_within_their_ranges_and_the_longer_the_slower() -> None:
    """Each in two tones, and faster across the wind: all of them within 0.2 to 0.5 Hz, and 1 to 3 Hz."""
    for habit in HABITS.values():
        for height in (2.0, *habit.height):
            sways = trunk_hertz(height, habit.slender * height)
            assert TRUNK_HERTZ[0] <= TONES[0] * sways < TONES[1] * TRUNK_ACROSS * sways <= TRUNK_HERTZ[1]
        low, high = (trunk_hertz(height, habit.slender * height) for height in habit.height)
        assert high < low
    lengths = [0.3, 1.0, 2.0, 4.0, 9.0]
    found = [limb_hertz(length) for length in lengths]
    assert found == sorted(found, reverse=True)
    assert LIMB_HERTZ[0] <= TONES[0] * found[-1] + 1e-9
    assert found[-1] < found[0] <= LIMB_HERTZ[1] / (TONES[1] * LIMB_ACROSS)
