"""Figures of the morph from blades to textures show what their captions say."""

import numpy as np
import pytest
from matplotlib.collections import LineCollection

from tallgrass.app.figures.figure import Detail
from tallgrass.app.figures.morph import (
    STAGES,
    by_plane,
    draw_coordinates,
    draw_pair,
    draw_way,
    followed,
    morph_over_time,
    slender,
    way,
)
from tallgrass.app.figures.patch import sample
from tallgrass.app.figures.plot import look

SMALL = Detail(size=(96, 54), preset="low", dots=360)


@pytest.mark.usefixtures("_coarse")
def test_x3_the_blades_of_figure_13_are_those_that_its_texture_shows() -> None:
    one = sample(SMALL)
    with look():
        figure = draw_pair(SMALL)
    assert f"the {len(one.rows)} blades" in figure.axes[0].get_title("left")
    places = next(each for each in figure.axes[1].collections if isinstance(each, LineCollection)).get_segments()
    rows = followed(one)
    assert set(rows) <= set(one.rows)
    span = one.quality.patch + 2 * one.strips.margin
    for row, place in zip(rows, places, strict=True):
        np.testing.assert_allclose(place[0], [one.blades.root[row, 0], 0.0], atol=1e-4)
        np.testing.assert_allclose(place[-1, 0], one.targets[0, row, -1, 0] * span - one.strips.margin, atol=1e-4)


@pytest.mark.usefixtures("_coarse")
def test_x3_figure_14_labels_the_texture_coordinates_of_the_blade_that_it_draws() -> None:
    one = sample(SMALL)
    at = one.targets[0, slender(one)]
    with look():
        close = next(axes for axes in draw_coordinates(SMALL).axes if axes.get_title("left").startswith("b)"))
    np.testing.assert_allclose(np.asarray(close.lines[0].get_xydata()), at, atol=1e-6)
    assert [text.get_text() for text in close.texts] == [f"({u:.3f}, {v:.3f})" for u, v in at[::2].astype(float)]


@pytest.mark.usefixtures("_coarse")
def test_x4_blades_of_figure_15_go_from_their_own_places_to_their_painted_places() -> None:
    one = sample(SMALL)
    going = way(one, followed(one))
    np.testing.assert_allclose(going.shown[0], going.own[0], atol=1e-6)
    np.testing.assert_allclose(going.shown[-1], going.target[-1], atol=1e-6)
    assert [round(float(going.morph[going.stage(each)]), 1) for each in (0.0, 0.5, 1.0)] == [0.0, 0.5, 1.0]
    assert (np.diff(morph_over_time()[1]) >= 0.0).all()
    lengths = np.linalg.norm(np.diff(going.own, axis=2), axis=3).sum(axis=2)
    np.testing.assert_allclose(lengths, np.broadcast_to(one.blades.height[followed(one)], lengths.shape), rtol=5e-3)


@pytest.mark.usefixtures("_coarse")
def test_x4_the_way_of_a_tip_is_straight_in_a_wind_that_stands_still_and_else_leaves_its_plane() -> None:
    one = sample(SMALL)
    for frozen in (True, False):
        going = way(one, followed(one), frozen=frozen)
        away = np.abs(np.stack([by_plane(going.shown[:, number, -1]) for number in range(3)])).max(axis=1)
        assert (away[:, 1:].max() < 1e-5) == frozen
        assert (away[:, 2].max() > 0.005) == (not frozen)
    with look():
        figure = draw_way(SMALL)
    assert [axes.get_title("left")[-len(f"w = {w:g}") :] for axes, w in zip(figure.axes, STAGES, strict=False)] == [
        f"w = {w:g}" for w in STAGES
    ]


def test_a_flat_way_has_no_depth_across_its_plane() -> None:
    turn = np.linspace(0.0, 5.0, 40)
    flat = np.stack([np.cos(turn), np.sin(turn), 0.3 * np.cos(turn) - 0.7 * np.sin(turn) + 2.0], axis=1)
    assert np.abs(by_plane(flat)[:, 2]).max() < 1e-12
    bulging = flat + np.stack([0.0 * turn, 0.0 * turn, 0.05 * turn**2], axis=1)
    assert np.abs(by_plane(bulging)[:, 2]).max() > 0.05
