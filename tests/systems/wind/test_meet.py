"""Winds that meet: by priority (W11), by weight (F7), and by the rule for equal claims."""

from collections.abc import Callable, Sequence
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Mixing, WindPrimitive
from tallgrass.systems.wind.blast import Blast, Shape
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.whirlwind import Whirlwind

Feel = Callable[..., Floats]

FIELD = np.random.default_rng(9).uniform(-14.0, 14.0, (4000, 2)).astype(np.float32)
TIME = 3.0

BREEZE = Breeze(strength=0.3)
GUST = Gust(position=[-18.0, 0.0], speed=8.0, width=16.0)
WHIRL = Whirlwind(position=[3.0, 2.0], radius=5.0)
BLAST = Blast(position=[6.0, 0.0], outline=Shape(ellipse=[3.0, 5.0]), yaw=30.0)
ALL: list[WindPrimitive] = [BREEZE, GUST, WHIRL, BLAST]
NAMES = [wind.kind for wind in ALL]
mixings = pytest.mark.parametrize("mixing", ["priority", "weight"])


def named(feel: Feel, winds: Sequence[WindPrimitive], *, mixing: Mixing = "priority", place: Floats = FIELD) -> Floats:
    """Return the messages of several winds, each named by its kind, so that its seed is independent of the others."""
    return feel(*winds, place=place, time=TIME, mixing=mixing, names=[wind.kind for wind in winds])


def held(wind: WindPrimitive, place: Floats = FIELD) -> NDArray[np.bool_]:
    return np.asarray(wind.mask(wind.pose(time=TIME).inside(place), time=TIME) > 0.0)


def bits(message: Floats) -> NDArray[np.uint32]:
    return message.view(np.uint32)


def test_w11_blast_goes_over_whirlwind_over_gust_over_breeze_and_the_cancelled_leave_no_trace(feel: Feel) -> None:
    together = named(feel, ALL)
    left = np.ones(len(FIELD), np.bool_)
    for wind in reversed(ALL):
        rows = left & held(wind)
        assert rows.sum() > 50
        np.testing.assert_array_equal(bits(together)[rows], bits(named(feel, [wind]))[rows], err_msg=wind.kind)
        left &= ~rows
    assert not left.any()
    for over, under in ((BLAST, WHIRL), (WHIRL, GUST), (BLAST, GUST)):
        assert (held(over) & held(under)).sum() > 50


@given(st.permutations(range(4)), st.sampled_from(["priority", "weight"]))
def test_w11_the_order_in_which_winds_are_made_does_not_matter(feel: Feel, order: list[int], mixing: Mixing) -> None:
    shuffled = named(feel, [ALL[number] for number in order], mixing=mixing)
    np.testing.assert_array_equal(bits(shuffled), bits(named(feel, ALL, mixing=mixing)))


@mixings
@pytest.mark.parametrize("more", [{}, {"start": 1.0}, {"strength": 0.4}, {"priority": 3}])
def test_w11_equal_winds_are_settled_by_a_rule_in_any_order(feel: Feel, mixing: Mixing, more: dict[str, float]) -> None:
    """Three winds of one kind and priority, of which two have equal values: their names decide."""
    winds = [Breeze(), Breeze(), Breeze().model_copy(update=more)]
    stories = []
    for order in permutations(range(3)):
        names = [f"wind {number}" for number in order]
        chosen = [winds[number] for number in order]
        stories.append(bits(feel(*chosen, place=FIELD[:300], time=TIME, mixing=mixing, names=names)))
    for story in stories[1:]:
        np.testing.assert_array_equal(story, stories[0])


@mixings
def test_w11_equal_winds_of_one_name_are_settled_by_where_they_are(feel: Feel, mixing: Mixing) -> None:
    winds, poses = [Whirlwind(), Whirlwind(), Whirlwind()], [Pose(1.0, 0.0), Pose(-2.0, 1.0), Pose(0.0, 0.0, 0.7)]
    names = ["same"] * 3
    stories = [
        bits(feel(*winds, place=FIELD[:800], time=TIME, mixing=mixing, names=names, poses=[poses[k] for k in order]))
        for order in permutations(range(3))
    ]
    for story in stories[1:]:
        np.testing.assert_array_equal(story, stories[0])


def test_w11_of_equal_priorities_the_later_one_goes_first_then_the_kind_decides(feel: Feel) -> None:
    early = Breeze(direction=0.0, gustiness=0.0, swing=0.0, strength=0.5)
    late = early.model_copy(update={"direction": 90.0, "start": 1.0})
    np.testing.assert_allclose(named(feel, [late, early])[:9], [[0.5, 0.0]] * 9, atol=1e-6)
    whirl, blast = Whirlwind(radius=9.0, priority=5), Blast(outline=Shape(disc=9.0), priority=5)
    np.testing.assert_array_equal(named(feel, [blast, whirl])[held(whirl)], named(feel, [whirl])[held(whirl)])


@mixings
def test_a_wind_sets_in_and_dies_down_over_its_ease(feel: Feel, mixing: Mixing) -> None:
    whirl = Whirlwind(start=2.0, stop=8.0, ease=1.5, swing=0.0, turning=0.0)
    place = np.array([[2.0, 0.0]], np.float32)

    def strength(time: float) -> float:
        return float(np.linalg.norm(feel(whirl, place=place, time=time, mixing=mixing)))

    whole = strength(5.0)
    story = np.array([strength(time) for time in np.arange(1.95, 8.1, 0.05)]) / whole
    assert np.abs(np.diff(story)).max() < 0.06
    assert story[0] == story[-1] == 0.0
    assert strength(2.75) / whole == pytest.approx(0.5, abs=0.01)
    assert strength(7.25) / whole == pytest.approx(0.5, abs=0.01)
    from_the_beginning = whirl.model_copy(update={"start": 0.0})
    np.testing.assert_allclose(feel(from_the_beginning, place=place, time=0.0), feel(whirl, place=place, time=5.0))


def pairs(wind: WindPrimitive, apart: float, count: int = 3000) -> tuple[Floats, Floats]:
    """Return pairs of receivers at a distance [m] from each other, all over a wind's mask and across its edges."""
    pose, box = wind.pose(time=TIME), wind.extent(time=TIME)
    assert box is not None
    rng = np.random.default_rng(3)
    own = rng.uniform([box.left - 1.0, box.ahead - 1.0], [box.right + 1.0, box.behind + 1.0], (count, 2))
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    here = pose.outside(own.astype(np.float32)) + np.array([pose.x, pose.z], np.float32)
    return here, (here + apart * np.stack([np.cos(angle), np.sin(angle)], 1)).astype(np.float32)


def jump(feel: Feel, winds: list[WindPrimitive], wind: WindPrimitive, mixing: Mixing, apart: float) -> float:
    here, there = pairs(wind, apart)
    one, other = (named(feel, winds, mixing=mixing, place=place) for place in (here, there))
    return float(np.linalg.norm(one - other, axis=1).max())


@pytest.mark.parametrize("wind", [GUST, WHIRL, BLAST], ids=lambda wind: wind.kind)
def test_f7_mixed_by_weight_no_line_shows_where_a_mask_ends(feel: Feel, wind: WindPrimitive) -> None:
    still = [each.model_copy(update={"swing": 0.0}) for each in ALL]
    assert jump(feel, still, wind, "weight", 0.01) < 0.06
    assert jump(feel, still, wind, "weight", 0.001) < 0.01
    assert jump(feel, still, wind, "priority", 0.01) > 0.15


def test_f7_where_two_masks_of_one_priority_end_together_no_line_shows(feel: Feel) -> None:
    one = Whirlwind(position=[-2.0, 0.0], radius=5.0, swing=0.0)
    other = Blast(position=[2.0, 0.0], outline=Shape(disc=5.0), priority=20, swing=0.0)
    for wind in (one, other):
        assert jump(feel, [BREEZE, one, other], wind, "weight", 0.001) < 0.01


@given(st.floats(0.05, 1.0), st.floats(0.05, 1.0))
def test_f7_equal_priorities_count_by_their_weights_alike(feel: Feel, ours: float, theirs: float) -> None:
    east = Breeze(direction=90.0, gustiness=0.0, swing=0.0, strength=0.6, weight=ours)
    north = east.model_copy(update={"direction": 0.0, "weight": theirs})
    place = FIELD[:5]
    message = feel(east, north, place=place, time=TIME, mixing="weight")
    covered = 1.0 - (1.0 - ours) * (1.0 - theirs)
    expected = 0.6 * covered * np.array([ours, -theirs]) / (ours + theirs)
    np.testing.assert_allclose(message, np.broadcast_to(expected, message.shape), atol=1e-5)
    swapped = feel(north, east, place=place, time=TIME, mixing="weight", names=["wind[1] breeze", "wind[0] breeze"])
    np.testing.assert_array_equal(bits(message), bits(swapped))


@pytest.mark.parametrize("priority", [0, 30])
def test_f7_a_weight_of_0_leaves_no_trace(feel: Feel, priority: int) -> None:
    nothing = BLAST.model_copy(update={"weight": 0.0, "priority": priority})
    np.testing.assert_array_equal(
        bits(named(feel, [BREEZE, WHIRL, nothing], mixing="weight")),
        bits(named(feel, [BREEZE, WHIRL], mixing="weight")),
    )


def test_f7_a_weight_of_1_where_the_mask_is_whole_covers_all_below(feel: Feel) -> None:
    pose = BLAST.pose(time=TIME)
    whole = BLAST.mask(pose.inside(FIELD), time=TIME) == 1.0
    assert whole.sum() > 30
    together, alone = (named(feel, winds, mixing="weight") for winds in (ALL, [BLAST]))
    np.testing.assert_array_equal(bits(together)[whole], bits(alone)[whole])


@given(st.floats(0.0, 1.0))
def test_f7_a_wind_covers_those_below_as_far_as_its_weight_says(feel: Feel, weight: float) -> None:
    under = Breeze(direction=0.0, gustiness=0.0, swing=0.0, strength=0.4)
    over = under.model_copy(update={"direction": 90.0, "priority": 1, "weight": weight})
    message = feel(under, over, place=FIELD[:5], time=TIME, mixing="weight")
    expected = np.array([0.4 * weight, -0.4 * (1.0 - weight)])
    np.testing.assert_allclose(message, np.broadcast_to(expected, message.shape), atol=1e-6)


def test_f7_by_priority_weights_and_soft_edges_do_not_count(feel: Feel) -> None:
    soft, hard = (
        BLAST.model_copy(update={"soft": soft, "weight": weight}) for soft, weight in ((3.0, 0.2), (0.0, 1.0))
    )
    np.testing.assert_array_equal(bits(named(feel, [BREEZE, soft])), bits(named(feel, [BREEZE, hard])))


@mixings
def test_w2_all_winds_together_stay_indices(feel: Feel, mixing: Mixing) -> None:
    loud = [wind.model_copy(update={"swing": 0.5, "strength": 1.0}) for wind in ALL]
    assert np.linalg.norm(named(feel, loud, mixing=mixing), axis=1).max() <= 1.0 + 1e-6
