"""How a patch shows on its way from one representation to another (X3, X4, X5)."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.systems.around.appearance import BORDER, Looks, handed_over, kept_near, looks
from tallgrass.systems.around.transitions import SEAMLESS, Transitions

Floats = NDArray[np.float32]

parts = st.floats(0.0, 1.0, width=32)
switches = st.builds(Transitions, *[st.booleans()] * 4)


def shown(
    blades: float, strips: float, carpet: float, *, kept: float = 1.0, transitions: Transitions = SEAMLESS
) -> dict[str, float]:
    """How one patch shows."""
    weight = np.array([[blades], [strips], [carpet]], np.float32)
    found = looks(weight, np.array([kept], np.float32), transitions=transitions)
    return {field.name: float(getattr(found, field.name)[0]) for field in fields(Looks)}


SETTLED = {
    (1, 0, 0): {"blades": 1, "morph": 0, "handed": 0, "strips": 0, "carpet": 0},
    (0, 1, 0): {"blades": 0, "morph": 0, "handed": 1, "strips": 1, "growth": 1, "carpet": 0},
    (0, 0, 1): {"blades": 0, "strips": 0, "carpet": 1},
    (0, 0, 0): {"blades": 0, "strips": 0, "carpet": 0},
}


@pytest.mark.parametrize("weight", SETTLED)
@given(transitions=switches)
def test_x4_what_is_settled_shows_wholly(weight: tuple[int, int, int], transitions: Transitions) -> None:
    found = shown(*weight, transitions=transitions)
    assert {name: found[name] for name in SETTLED[weight]} == SETTLED[weight]


@given(parts, parts, switches)
def test_x4_nothing_shows_more_than_wholly(part: float, kept: float, transitions: Transitions) -> None:
    for weight in ((1 - part, part, 0.0), (0.0, 1 - part, part), (1 - part, 0.0, part)):
        assert all(0.0 <= value <= 1.0 for value in shown(*weight, kept=kept, transitions=transitions).values())


@given(parts, parts)
def test_x3_blades_only_come_nearer_and_are_handed_over_no_sooner_than_they_come(one: float, other: float) -> None:
    before, after = (shown(1 - part, part, 0.0) for part in sorted((one, other)))
    assert before["morph"] <= after["morph"] or after["blades"] == 0.0
    assert before["handed"] <= after["handed"]
    assert before["handed"] <= before["morph"] + 0.1 or before["blades"] == 0.0


def test_x3_blades_have_arrived_before_the_last_of_them_goes() -> None:
    last = shown(0.04, 0.96, 0.0)
    assert last["morph"] == 1.0
    assert last["handed"] < 1.0
    assert shown(0.999, 0.001, 0.0)["morph"] < 0.001


@given(parts, parts)
def test_x5_strips_grow_before_the_carpet_sinks(part: float, kept: float) -> None:
    found = shown(0.0, part, 1 - part, kept=kept)
    assert found["strips"] in (0.0, 1.0)
    assert found["carpet"] == 1.0 or found["growth"] > 0.7
    if found["strips"]:
        assert found["carpet"] > 0.0 or found["growth"] == 1.0


@given(parts)
def test_x5_strips_that_grow_never_fade(part: float) -> None:
    assert shown(0.0, part, 1 - part)["strips"] == (1.0 if part > 0.0 else 0.0)
    plain = shown(0.0, part, 1 - part, transitions=Transitions(growth=False))
    assert plain["growth"] == 1.0
    assert plain["strips"] == pytest.approx(part, abs=1e-6)
    assert plain["carpet"] == pytest.approx(1 - part, abs=1e-6)


def test_n3_without_morph_fade_and_growth_a_patch_is_one_thing_at_a_time() -> None:
    hard = Transitions(morph=False, fade=False, growth=False)
    assert not hard.gradual
    for part in (0.2, 0.8):
        for weight in ((1 - part, part, 0.0), (0.0, 1 - part, part)):
            found = shown(*weight, kept=0.3, transitions=hard)
            assert sorted((found["blades"], found["strips"], found["carpet"])) == [0.0, 0.0, 1.0]
            assert found["growth"] == 1.0


@given(parts)
def test_x4_what_is_handed_over_covers_as_much_as_before(handed: float) -> None:
    blades, strips = (float(each[0]) for each in handed_over(np.array([handed], np.float32), fade=True))
    thin = 0.4
    covered = 1.0 - (1.0 - thin * blades) * (1.0 - thin * strips)
    assert covered == pytest.approx(thin, rel=0.07)
    assert 1.0 - (1.0 - blades) * (1.0 - strips) >= 0.8


def test_x4_handing_over_begins_with_blades_alone_and_ends_with_strips_alone() -> None:
    blades, strips = handed_over(np.linspace(0.0, 1.0, 21, dtype=np.float32), fade=True)
    assert (blades[0], strips[0]) == (1.0, 0.0)
    assert (blades[-1], strips[-1]) == (0.0, 1.0)
    assert np.abs(np.diff(blades)).max() < 0.08
    assert np.abs(np.diff(strips)).max() < 0.08
    hard = np.array(handed_over(np.linspace(0.0, 1.0, 21, dtype=np.float32), fade=False))
    assert set(hard.ravel().tolist()) == {0.0, 1.0}
    assert (hard.sum(axis=0) == 1.0).all()


def test_x5_towards_their_end_the_distance_leaves_less_and_less_of_strips() -> None:
    away = np.linspace(0.0, 30.0, 121, dtype=np.float32)
    kept = kept_near(away, reach=20)
    assert kept[away <= 20.5 - BORDER].min() == 1.0
    assert kept[away >= 20.5].max() == 0.0
    assert (np.diff(kept) <= 0.0).all()
    assert np.abs(np.diff(kept)).max() <= 0.25 / BORDER + 1e-6
