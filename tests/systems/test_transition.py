"""Appearance of patches in transition (X3, X4, X5)."""

from collections.abc import Callable
from dataclasses import fields, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.patch import Lod
from tallgrass.components.viewer import Viewer
from tallgrass.engine.schedule import Phase
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.world import World
from tallgrass.systems.around.appearance import Appearance, appearance, border_width, handed_over, strips_left
from tallgrass.systems.around.changes import Changes
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.around.transitions import SEAMLESS, SLACK, Transitions
from tallgrass.systems.show.blades.shown import BladesShown
from tallgrass.systems.show.registry import NAMES
from tallgrass.systems.show.strips.shown import StripsShown
from tallgrass.systems.site import Site, outlook_on
from tallgrass.systems.space.window import window_rows
from tallgrass.systems.transition import FADE
from tallgrass.testing import systems_on

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

parts = st.floats(0.0, 1.0, width=32)
switches = st.builds(Transitions, *[st.booleans()] * 4)


def shown(
    blades: float, strips: float, carpet: float, *, kept: float = 1.0, transitions: Transitions = SEAMLESS
) -> dict[str, float]:
    """Appearance of one patch."""
    weight = np.array([[blades], [strips], [carpet]], np.float32)
    found = appearance(weight, np.array([kept], np.float32), transitions=transitions)
    values = {field.name: float(getattr(found, field.name)[0]) for field in fields(Appearance) if field.name != "cover"}
    return values | dict(zip(NAMES, found.cover[:, 0].tolist(), strict=True))


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


def test_x5_strips_grow_from_the_ground_to_their_full_height() -> None:
    first, *others, last = (shown(0.0, part, 1 - part)["growth"] for part in (0.001, 0.2, 0.4, 1.0))
    assert first < 0.01
    assert first < others[0] < others[1] < last == 1.0


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


@pytest.mark.parametrize(
    ("thin", "least", "most"),
    [(0.02, 1.0, 1.35), (0.2, 1.0, 1.26), (0.4, 1.0, 1.17), (0.6, 1.0, 1.08), (0.8, 0.98, 1.01), (1.0, 0.89, 1.0)],
)
@given(handed=parts)
def test_x4_what_is_handed_over_covers_about_as_much_as_before_thin_grass_a_little_more_and_thick_a_little_less(
    handed: float, thin: float, least: float, most: float
) -> None:
    blades, strips = (float(each[0]) for each in handed_over(np.array([handed], np.float32), fade=True))
    covered = 1.0 - (1.0 - thin * blades) * (1.0 - thin * strips)
    assert least * thin - 1e-6 <= covered <= most * thin + 1e-6


def test_x4_handing_over_begins_with_blades_alone_and_ends_with_strips_alone() -> None:
    blades, strips = handed_over(np.linspace(0.0, 1.0, 21, dtype=np.float32), fade=True)
    assert (blades[0], strips[0]) == (1.0, 0.0)
    assert (blades[-1], strips[-1]) == (0.0, 1.0)
    assert np.abs(np.diff(blades)).max() < 0.09
    assert np.abs(np.diff(strips)).max() < 0.09
    hard = np.array(handed_over(np.linspace(0.0, 1.0, 21, dtype=np.float32), fade=False))
    assert set(hard.ravel().tolist()) == {0.0, 1.0}
    assert (hard.sum(axis=0) == 1.0).all()


@pytest.mark.parametrize(("reach", "border"), [(8, 4.0), (20, 6.0)])
def test_x5_towards_their_end_the_distance_leaves_less_and_less_of_strips(reach: int, border: float) -> None:
    away = np.linspace(0.0, 30.0, 121, dtype=np.float32)
    kept = strips_left(away, reach=reach)
    assert border_width(reach) == border
    assert kept[away <= reach + 0.5 - border].min() == 1.0
    assert kept[away >= reach + 0.5].max() == 0.0
    assert (np.diff(kept) <= 0.0).all()
    assert np.abs(np.diff(kept)).max() <= 0.25 / border + 1e-6


@given(
    st.lists(
        st.tuples(*[st.integers(-1, 2)] * 3, st.sampled_from([0.0, 0.3, 1.0]), st.booleans()), min_size=1, max_size=20
    ),
    st.floats(0.0, 2.0),
)
def test_x1_what_is_settled_and_wants_nothing_is_left_alone(
    patches: list[tuple[int, int, int, float, bool]], step: float
) -> None:
    def columns() -> tuple[Any, ...]:
        types = (np.int8, np.int8, np.int8, np.float32, np.bool_)
        return tuple(np.array(column, kind) for column, kind in zip(zip(*patches, strict=True), types, strict=True))

    now, before, wanted, progress, slowly = columns()
    every = Changes(now, before, progress)
    every.advance(wanted, slowly, step=step)
    now, before, _, progress, _ = columns()
    few = Changes(now, before, progress)
    rows = few.unsettled(wanted)
    few.advance_rows(rows, wanted[rows], slowly[rows], step=step)
    for name in ("now", "before", "progress"):
        np.testing.assert_array_equal(getattr(every, name), getattr(few, name))


# ---- The system ----------------------------------------------------------------------------------

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
HERE = (1.25, 1.25)
STEP = 0.11


def row_at(outlook: Outlook, away: int) -> int:
    """Return the row of the patch that lies a number of patches to the right of the viewer's."""
    cell = outlook.viewer.centre + np.array([away, 0], np.int32)
    return int(window_rows(cell[None], side=outlook.patches.side)[0])


def lod_of(world: World, outlook: Outlook, row: int) -> Lod:
    lod = world.find(int(outlook.patches.entity[row]), Lod)
    assert lod is not None
    return lod


def all_round(look: Look, site: Site) -> Outlook:
    """Look all round until every patch is an entity."""
    look(site, *HERE)
    return look(site, *HERE)


def alone(site: Site, world: World) -> Outlook:
    """Outlook of a viewer that stands still."""
    viewer = Viewer(eye=(HERE[0], 1.7, HERE[1]), dt=STEP, jumped=False)
    return outlook_on(site, viewer, world.create(viewer))


def showing(outlook: Outlook, row: int) -> set[str]:
    """Return the representations that draw the patch of a row; the carpet only with a cover above 0."""
    strips = np.concatenate([ring.rows for ring in outlook.shows(StripsShown).rings])
    blades, carpet = outlook.shows(BladesShown).standing.rows, outlook.appearance.cover[2, row] > 0.0
    return {name for name, there in zip(NAMES, (row in blades, row in strips, carpet), strict=True) if there}


@pytest.mark.parametrize(
    ("away", "own", "hold"),
    [
        (0, "blades", "strips"),
        (0, "blades", "carpet"),
        (1, "blades", "strips"),
        (4, "strips", "blades"),
        (5, "strips", "carpet"),
        (8, "carpet", "strips"),
    ],
)
def test_a_held_patch_goes_to_its_representation_through_a_transition_and_comes_back(
    laid: Laid, look: Look, world: World, away: int, own: str, hold: str
) -> None:
    site = laid(terrain=FLAT)
    outlook = all_round(look, site)
    row = row_at(outlook, away)
    lod = lod_of(world, outlook, row)
    assert (lod.representation, lod.progress, lod.hold, outlook.changing) == (own, 1.0, None, 0)
    for start, target, name in ((own, hold, hold), (hold, own, None)):
        lod.hold = name
        look(site, *HERE, dt=STEP)
        assert (lod.representation, lod.previous, lod.progress) == (target, start, 0.0)
        assert outlook.changing == 1
        progress = []
        while lod.progress < 1.0:
            look(site, *HERE, dt=STEP)
            progress.append(lod.progress)
        np.testing.assert_allclose(np.diff(progress)[:-1], STEP / FADE, atol=1e-5)
        assert len(progress) == np.ceil(FADE / STEP)
        look(site, *HERE, dt=STEP)
        assert (lod.representation, lod.previous, outlook.changing) == (target, target, 0)
        assert lod.wanted == own
        seen = showing(outlook, row)
        if away <= site.reach[1]:  # beyond, the distance leaves nothing of strips (X5), held or not
            assert target in seen
        assert seen <= {target, "carpet" if target == "strips" else target}


def test_half_way_to_what_it_is_held_in_a_patch_shows_both(laid: Laid, look: Look, world: World) -> None:
    site = laid(terrain=FLAT)
    outlook = all_round(look, site)
    row = row_at(outlook, 1)
    lod_of(world, outlook, row).hold = "strips"
    look(site, *HERE, dt=STEP)
    look(site, *HERE, dt=0.5 * FADE)
    assert showing(outlook, row) == {"blades", "strips"}
    assert row in outlook.shows(BladesShown).morphing.rows


def test_only_the_patch_that_is_held_changes(laid: Laid, look: Look, world: World) -> None:
    site = laid(terrain=FLAT)
    outlook = all_round(look, site)
    patches, row = outlook.patches, row_at(outlook, 0)
    before = patches.representation.copy()
    lod_of(world, outlook, row).hold = "carpet"
    for _ in range(20):
        look(site, *HERE, dt=STEP)
    assert np.flatnonzero(patches.representation != before).tolist() == [row]


@pytest.mark.parametrize(("hold", "away", "finest"), [("blades", 5, "strips"), ("blades", 9, "carpet")])
def test_held_finer_than_there_is_room_for_a_patch_takes_the_finest_possible(
    laid: Laid, look: Look, world: World, hold: str, away: int, finest: str
) -> None:
    site = laid(terrain=FLAT)
    outlook = all_round(look, site)
    lod = lod_of(world, outlook, row_at(outlook, away))
    lod.hold = hold
    for _ in range(30):
        look(site, *HERE, dt=STEP)
    assert (lod.hold, lod.representation, lod.progress) == (hold, finest, 1.0)


def test_a_patch_is_held_until_the_viewer_has_left_it_behind(laid: Laid, look: Look, world: World) -> None:
    site = laid(terrain=FLAT)
    outlook = all_round(look, site)
    cell = outlook.viewer.centre.copy()
    lod = lod_of(world, outlook, row_at(outlook, 0))
    lod.hold = "strips"
    look(site, HERE[0] + 9 * 2.5, HERE[1])
    assert lod.hold == "strips"
    look(site, HERE[0] + 10 * 2.5, HERE[1])
    with pytest.raises(RuntimeError, match="left the patch"):
        lod.hold = "strips"
    look(site, *HERE)
    row = row_at(outlook, 0)
    again = lod_of(world, outlook, row)
    assert (outlook.patches.cell[row] == cell).all()
    assert (again.hold, again.representation) == (None, "blades")


def test_a_system_after_lod_may_want_another_representation_as_far_as_there_is_room(laid: Laid, world: World) -> None:
    site = laid(terrain=FLAT)
    outlook = alone(site, world)
    systems = systems_on(site, [outlook], world)
    asked: list[str | None] = []

    def want() -> None:
        for _, lod in world.all(Lod):
            asked.append(lod.wanted)
            lod.wanted = "blades"

    systems.add(Phase.SEE, "mine", want, before="transition", after="lod")
    systems.run(last=Phase.SEE)
    patches = outlook.patches
    assert set(asked) == set(NAMES)
    for name, number, limit in (("blades", 0, -1), ("strips", 1, site.reach[0]), ("carpet", 2, site.reach[1])):
        farther = patches.distance > limit + SLACK + 1 if number else patches.distance >= 0
        assert (patches.representation[farther & patches.alive] >= number).all(), name
    near = patches.alive & (patches.distance <= site.reach[0] + SLACK + 1)
    assert (patches.representation[near] == 0).all()
    systems.disable("mine")
    systems.run(last=Phase.SEE)
    assert outlook.changing > 0
    np.testing.assert_array_equal(patches.representation[patches.distance == site.reach[0] + SLACK + 1], 1)


def test_n3_without_gradual_transitions_a_held_patch_switches_at_once(laid: Laid, world: World) -> None:
    hard = Transitions(morph=False, fade=False, growth=False)
    site = replace(laid(terrain=FLAT), transitions=hard)
    outlook = alone(site, world)
    systems = systems_on(site, [outlook], world)
    for _ in range(2):
        systems.run(last=Phase.SEE)
    lod = lod_of(world, outlook, row_at(outlook, 0))
    lod.hold = "carpet"
    systems.run(last=Phase.SEE)
    assert (lod.representation, lod.previous, lod.progress, outlook.changing) == ("carpet", "carpet", 1.0, 1)
