"""Arrows: the messages of receivers."""

from collections.abc import Callable
from math import pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.arrays import Floats
from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.overlay.arrows import arrow_marks, arrows, evenly_spread, messages_of_shown
from tallgrass.systems.overlay.paint import index_color
from tallgrass.systems.show.blades.shown import BladesShown, Standing
from tallgrass.systems.show.strips.shown import StripsOfRing, StripsShown
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
Look = Callable[..., Outlook]
FLAT = Terrain(np.zeros((3, 3), np.float32), 50.0)
bends = st.tuples(st.floats(-pi, pi), st.floats(0.01, 1.0))


@given(st.lists(bends, min_size=1, max_size=8))
def test_n8_an_arrow_has_its_messages_direction_and_length(many: list[tuple[float, float]]) -> None:
    angle, index = np.array(many, np.float32).T
    message = np.stack([np.cos(angle), np.sin(angle)], axis=1) * index[:, None]
    place = np.arange(2 * len(many), dtype=np.float32).reshape(-1, 2)
    marks = arrows(place, message, np.full(len(many), 2.0, np.float32), FLAT, eye=(3.0, 9.0, 2.0))
    core = marks.lines[len(marks.lines) // 2 :][: len(many)]
    np.testing.assert_allclose(core["a"][:, ::2], place, atol=1e-5)
    np.testing.assert_allclose((core["b"] - core["a"])[:, ::2], 2.0 * message, atol=1e-4)
    np.testing.assert_allclose(core["color"][:, :3], index_color(index), atol=1e-4)


@pytest.mark.parametrize("eye", [(0.0, 50.0, 0.0), (0.0, 0.3, 50.0), (-20.0, 5.0, -20.0)])
def test_n8_an_arrows_head_is_at_its_tip_and_turned_to_the_eye(eye: tuple[float, float, float]) -> None:
    message, longest = np.array([[0.8, 0.0]], np.float32), np.ones(1, np.float32)
    _, left, right = arrows(np.zeros((1, 2), np.float32), message, longest, FLAT, eye=eye).lines[3:]
    apart = (left["a"] - right["a"]).astype(float)
    for barb in (left, right):
        np.testing.assert_allclose(barb["b"][::2], [0.8, 0.0], atol=1e-6)
        assert 0.4 < barb["a"][0] < 0.6
    assert np.linalg.norm(apart) == pytest.approx(0.8 * 2 * 0.36 * 0.45, rel=1e-3)
    assert apart[0] == pytest.approx(0.0, abs=1e-6)
    assert apart @ (np.array(eye) - left["b"]) == pytest.approx(0.0, abs=1e-4)


def test_n8_the_index_is_read_from_the_colour() -> None:
    colors = index_color(np.linspace(0.0, 1.0, 11, dtype=np.float32))
    apart = np.linalg.norm(colors[:, None] - colors[None], axis=-1) + np.eye(11)
    assert apart.min() > 0.15


def bent(angle: float) -> Floats:
    """Return a message in a direction [rad]."""
    return np.array([np.cos(angle), np.sin(angle)], np.float32) * np.float32(0.5)


def scattered(count: int = 40000) -> Floats:
    return np.random.default_rng(3).uniform(-60.0, 60.0, (count, 2)).astype(np.float32)


def chosen_from(place: Floats, eye: tuple[float, float, float]) -> tuple[NDArray[np.intp], Floats]:
    return evenly_spread(place, np.zeros(len(place), np.float32), np.zeros_like(place), eye=eye)


def test_n8_arrows_are_few_and_as_dense_in_the_picture_near_and_far() -> None:
    place = scattered()
    rows, longest = chosen_from(place, (0.0, 2.0, 0.0))
    assert 300 < len(rows) < 2000
    assert len(np.unique(rows)) == len(rows)
    away = np.hypot(*place[rows].T)
    near, far = ((away > a) & (away < 2 * a) for a in (5.0, 20.0))
    assert far.sum() < 8.0 * near.sum(), "on four by four times the ground"
    assert longest[far].mean() > 2.0 * longest[near].mean()


def test_n8_the_same_receivers_stay_chosen_while_the_eye_hardly_moves() -> None:
    place = scattered()
    before, after = (set(chosen_from(place, (x, 2.0, 0.0))[0].tolist()) for x in (0.0, 0.05))
    assert len(before & after) > 0.95 * len(before)


def test_n8_ground_that_faces_away_has_no_arrows() -> None:
    place = scattered(4000)
    slope = np.zeros_like(place)
    slope[:, 0] = -np.sign(place[:, 0])
    rows, _ = evenly_spread(place, np.zeros(len(place), np.float32), slope, eye=(0.0, 2.0, 0.0))
    assert np.abs(place[rows, 0]).max() < 5.0


def test_n8_arrows_are_what_receivers_have_been_told_whoever_has_told_them(laid: Laid, look: Look) -> None:
    site, angles = laid(), (0.3, 1.3, 2.3)
    outlook = look(site, 0.0, 0.0, hear=lambda heard, **_: np.full_like(heard.place, bent(0.3)))
    kept = outlook.kept
    rings: list[Standing | StripsOfRing] = [outlook.shows(BladesShown).standing, *outlook.shows(StripsShown).rings]
    for receiving, angle in zip(kept["strips"].receiving, angles[1:], strict=True):
        for slot in receiving.slots.tolist():
            receiving.messages.ask(slot)[:] = bent(angle)
    place, message = messages_of_shown(outlook)
    assert len(place) > 1000
    reach = site.ground.patch * 0.5 + site.representations[1].margin() + 1e-3
    for ring, angle in zip(rings, angles, strict=True):
        here = place[np.abs(np.arctan2(message[:, 1], message[:, 0]) - angle) < 1e-3]
        middles = (outlook.patches.cell[ring.rows] + 0.5) * site.ground.patch
        assert len(here) > len(middles) > 0
        away = np.abs(here[:, None] - middles[None]).max(axis=2)
        assert away.min(axis=1).max() < reach, "each stands on a patch that is shown so"
    marks = arrow_marks(outlook, site.ground.terrain)
    runs = (marks.lines["b"] - marks.lines["a"])[: len(marks.lines) // 6, ::2]
    found = np.unique(np.arctan2(runs[:, 1], runs[:, 0]).round(2))
    assert found == pytest.approx(angles)


def test_n8_only_grass_that_grows_has_arrows(laid: Laid, look: Look) -> None:
    bare = laid(dense=np.zeros((2, 2, 2), np.float32))
    outlook = look(bare, 0.0, 0.0)
    assert len(messages_of_shown(outlook)[0]) == 0
    assert len(arrow_marks(outlook, bare.ground.terrain).lines) == 0
