"""Postures: index to shape (paper, section 3.2)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.postures import HANGING, grow_postures
from tallgrass.systems.grow.record import Postures

KINDS = {
    "meadow": GrassKind(),
    "soft": GrassKind(stiffness=0.2),
    "stiff": GrassKind(stiffness=8.0),
    "lawn": GrassKind(height=[0.05, 0.09], width=0.003),
    "reed": GrassKind(height=[1.4, 2.4], width=0.03, taper=0.6),
    "limp": GrassKind(stiffness=0.02, width=0.001),
}


@pytest.fixture(scope="module", params=KINDS)
def postures(request: pytest.FixtureRequest) -> Postures:
    return grow_postures(KINDS[request.param], seed=7)


def links(shape: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(np.linalg.norm(np.diff(shape.astype(np.float64), axis=-2), axis=-1))


def test_w3_every_posture_keeps_the_blades_length(postures: Postures) -> None:
    lengths = links(postures.shape)
    np.testing.assert_allclose(lengths, 1.0 / lengths.shape[-1], rtol=1e-5)
    np.testing.assert_allclose(lengths.sum(axis=-1), 1.0, atol=1e-6)


@pytest.mark.parametrize("part", [0.1, 0.25, 0.5, 0.9])
def test_w3_shapes_between_two_postures_keep_the_blades_length(postures: Postures, part: float) -> None:
    between = postures.shape[:, :-1] * (1.0 - part) + postures.shape[:, 1:] * part
    lengths = links(between)
    np.testing.assert_allclose(lengths * lengths.shape[-1], 1.0, atol=1e-3)


def test_w3_index_zero_is_upright_and_negative_indices_are_the_mirror_image(postures: Postures) -> None:
    middle = postures.index.shape[0] // 2
    assert postures.index[middle] == 0.0
    np.testing.assert_array_equal(postures.shape[:, middle, :, 0], 0.0)
    np.testing.assert_allclose(postures.shape[:, ::-1] * [-1.0, 1.0], postures.shape, atol=1e-7)


def test_w3_index_one_is_near_flat(postures: Postures) -> None:
    last = postures.shape[:, -1, -1] - postures.shape[:, -1, -2]
    tip = np.degrees(np.arctan2(last[:, 0], last[:, 1]))
    assert (tip[:-HANGING] > 80.0).all()
    assert (tip[:-HANGING] < 90.0).all()


def test_the_last_variants_hang_over_and_lie_at_index_one(postures: Postures) -> None:
    shape = postures.shape[-HANGING:]
    chord = np.degrees(np.arctan2(*np.moveaxis(shape[:, -1, -1], -1, 0)))
    assert ((chord > 80.0) & (chord < 90.0)).all()
    assert shape[..., 1].min() > -0.01
    half = shape[:, 96]  # index 0.5
    turn = np.diff(np.arctan2(*np.moveaxis(np.diff(half, axis=1), -1, 0)), axis=1)
    assert (half[:, :, 1].max(axis=1) < 0.8).all()
    assert turn[1].max() > 2.0 * turn[0].max()  # it is folded at one place


def test_w3_a_higher_index_is_a_stronger_bend_in_even_steps(postures: Postures) -> None:
    tip = postures.shape[:, :, -1]
    deflection = np.arctan2(tip[..., 0], tip[..., 1])
    step = np.diff(deflection, axis=1)
    assert (np.diff(postures.index) > 0.0).all()
    assert (np.diff(tip[:-HANGING, :, 0], axis=1) > 0.0).all()
    np.testing.assert_allclose(step / step.mean(axis=1, keepdims=True), 1.0, atol=0.25)


def test_blades_bend_more_towards_their_tips(postures: Postures) -> None:
    directions = np.diff(postures.shape[0, -1].astype(np.float64), axis=0)
    angle = np.arctan2(directions[:, 0], directions[:, 1])
    assert (np.diff(angle) > 0.0).all()
    assert angle[0] < np.radians(40.0)


def test_g2_segments_are_oriented_at_random_in_all_variants_but_the_first() -> None:
    shape = grow_postures(GrassKind(), variants=4 + HANGING, seed=3).shape[:4]
    turn = np.diff(np.arctan2(*np.moveaxis(np.diff(shape[:, 96], axis=1), -1, 0)), axis=1)
    wobble = np.abs(np.diff(turn, n=2, axis=1)).max(axis=1)
    assert (wobble[1:] > 3.0 * wobble[0]).all()
    for first in range(4):
        for second in range(first):
            assert np.abs(shape[first] - shape[second]).max() > 0.01


def test_w12_kinds_bend_into_different_shapes() -> None:
    soft, stiff = (grow_postures(KINDS[name], variants=1, seed=1).shape[0, -1] for name in ("soft", "stiff"))
    assert soft[-1, 1] > stiff[-1, 1] + 0.03


def test_postures_depend_on_the_seed_and_on_nothing_else() -> None:
    first, again, other = (grow_postures(GrassKind(), seed=seed).shape for seed in (5, 5, 6))
    np.testing.assert_array_equal(first, again)
    np.testing.assert_array_equal(first[0], other[0])
    assert np.abs(first[1:] - other[1:]).max() > 1e-3


@settings(max_examples=8, deadline=None)
@given(
    height=st.floats(0.03, 4.0),
    width=st.floats(0.001, 0.1),
    stiffness=st.floats(0.02, 100.0),
    damping=st.floats(0.02, 100.0),
    taper=st.floats(0.2, 4.0),
)
def test_w3_any_kind_that_a_scene_may_declare_has_postures(
    height: float, width: float, stiffness: float, damping: float, taper: float
) -> None:
    kind = GrassKind(height=[height, height], width=width, stiffness=stiffness, damping=damping, taper=taper)
    shape = grow_postures(kind, variants=2, rows=65, seed=1).shape
    assert np.isfinite(shape).all()
    np.testing.assert_allclose(links(shape).sum(axis=-1), 1.0, atol=1e-6)
    assert (np.diff(shape[:, :, -1, 0], axis=1) > -1e-4).all()


@pytest.mark.parametrize("rows", [0, 1, 2, 128])
def test_an_even_number_of_rows_is_refused(rows: int) -> None:
    with pytest.raises(ValueError, match="odd number of rows"):
        grow_postures(GrassKind(), rows=rows)
