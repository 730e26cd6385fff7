"""The rule by which blades bend."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.bend import posture_of, ribbon, segment_normals, spine
from tallgrass.systems.grow.blades import grow_blades
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.grow.section import Section

KIND = GrassKind()
POSTURES = grow_postures(KIND, variants=6, seed=2)
BLADES = grow_blades(KIND, count=60, patch=2.5, variants=6, seed=2)


def messages() -> st.SearchStrategy[tuple[float, float]]:
    return st.tuples(st.floats(0.0, 1.0), st.floats(-np.pi, np.pi)).map(
        lambda polar: (polar[0] * np.cos(polar[1]), polar[0] * np.sin(polar[1]))
    )


@settings(max_examples=40, deadline=None)
@given(messages())
def test_w3_bent_blades_keep_their_lengths_and_their_roots(message: tuple[float, float]) -> None:
    centre = spine(BLADES, POSTURES, message, points=17).astype(np.float64)
    length = np.linalg.norm(np.diff(centre, axis=1), axis=2)
    np.testing.assert_allclose(length * 16, np.repeat(BLADES.height[:, None], 16, axis=1), rtol=1e-3)
    np.testing.assert_allclose(centre[:, 0], np.insert(BLADES.root, 1, 0.0, axis=1), atol=1e-6)


@settings(max_examples=40, deadline=None)
@given(messages())
def test_w2_rest_gives_way_to_the_wind_by_what_it_leaves_over(message: tuple[float, float]) -> None:
    index, direction = posture_of(BLADES.rest, message)
    total = np.asarray(message) + BLADES.rest.astype(np.float64) * (1.0 - np.hypot(*message))
    np.testing.assert_allclose(direction * index[:, None], total, atol=1e-12)
    assert (index <= 1.0).all()
    np.testing.assert_allclose(np.linalg.norm(direction, axis=1), 1.0, atol=1e-12)


def test_a_full_wind_bends_every_blade_along_it_alone() -> None:
    index, direction = posture_of(BLADES.rest, (0.0, -1.0))
    np.testing.assert_allclose(index, 1.0)
    np.testing.assert_allclose(direction, np.tile([0.0, -1.0], (60, 1)), atol=1e-9)


def test_a_message_above_one_is_one() -> None:
    index, direction = posture_of(BLADES.rest, (3.0, 0.0))
    np.testing.assert_allclose(index, 1.0)
    np.testing.assert_allclose(direction[:, 0], 1.0)


def test_each_blade_can_have_its_own_message() -> None:
    message = np.random.default_rng(1).uniform(-0.6, 0.6, (60, 2))
    together = spine(BLADES, POSTURES, message, points=9)
    for number in (0, 13, 59):
        alone = spine(BLADES, POSTURES, message[number], points=9)
        np.testing.assert_array_equal(together[number], alone[number])


def test_upright_blades_without_rest_stand_still() -> None:
    straight = grow_blades(GrassKind(lean=0.0), count=5, patch=1.0, variants=4, seed=1)
    centre = spine(straight, POSTURES, (0.0, 0.0), points=5)
    np.testing.assert_allclose(centre[:, :, ::2], np.repeat(straight.root[:, None], 5, axis=1), atol=1e-6)
    np.testing.assert_allclose(centre[:, -1, 1], straight.height, rtol=1e-6)


def test_the_shape_at_a_table_index_is_the_tables() -> None:
    row = 64 + 40
    index = POSTURES.index[row]
    straight = grow_blades(GrassKind(lean=0.0), count=5, patch=1.0, variants=4, seed=1)
    centre = spine(straight, POSTURES, (0.0, index), points=17)
    bent = centre - np.insert(straight.root, 1, 0.0, axis=1)[:, None]
    shape = POSTURES.shape[straight.variant, row] * straight.height[:, None, None]
    np.testing.assert_allclose(bent[:, :, 1:][:, :, ::-1], shape, atol=2e-6)
    np.testing.assert_allclose(bent[:, :, 0], 0.0, atol=1e-6)


@pytest.mark.parametrize("taper", [0.5, 1.0, 2.0])
def test_a_ribbon_widens_from_its_waist_and_narrows_as_its_taper_says_across_its_face(taper: float) -> None:
    left, right = ribbon(BLADES, POSTURES, (0.3, 0.1), points=26, taper=taper)
    side, along = right.astype(np.float64) - left, np.linspace(0.0, 1.0, 26)
    width = BLADES.width[:, None] * (1.0 - along) ** taper * np.interp(along, [0.0, 0.16], [0.45, 1.0])
    np.testing.assert_allclose(np.linalg.norm(side, axis=2)[:, :-1], width[:, :-1], atol=1e-6)
    face = np.stack([np.cos(BLADES.facing), np.sin(BLADES.facing)], axis=1)
    np.testing.assert_allclose((side[:, :, ::2] * face[:, None]).sum(axis=2), 0.0, atol=1e-6)
    np.testing.assert_array_equal(side[:, :, 1], 0.0)


@given(st.floats(0.0, 1.0), st.integers(2, 16))
def test_the_last_piece_of_a_ribbon_is_as_broad_in_the_mean_as_the_blade_is_there(taper: float, pieces: int) -> None:
    left, right = ribbon(BLADES, POSTURES, (0.0, 0.0), points=pieces + 1, taper=taper, section=Section(waist=1.0))
    before, last = np.linalg.norm(right.astype(np.float64) - left, axis=2)[:, -2:].T
    mean = BLADES.width * (1.0 / pieces) ** taper / (1.0 + taper)
    np.testing.assert_allclose(0.5 * (before + last), mean, rtol=1e-3, atol=1e-6)


def test_segment_normals_stand_on_the_ribbon_and_face_where_the_blade_does() -> None:
    centre = spine(BLADES, POSTURES, (0.2, 0.1), points=9)
    left, right = ribbon(BLADES, POSTURES, (0.2, 0.1), points=9, taper=1.0)
    normal = segment_normals(BLADES, centre)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=2), 1.0)
    np.testing.assert_allclose((normal * np.diff(centre, axis=1)).sum(axis=2), 0.0, atol=1e-6)
    np.testing.assert_allclose((normal * (right - left)[:, :-1]).sum(axis=2), 0.0, atol=1e-6)
    face = np.stack([np.cos(BLADES.facing), np.zeros(60), np.sin(BLADES.facing)], axis=1)
    assert ((normal * face[:, None]).sum(axis=2) > 0.0).all()


def test_g2_blades_lean_all_ways_and_each_turns_by_parts_of_its_own_from_segment_to_segment() -> None:
    step = np.diff(spine(BLADES, POSTURES, (0.0, 0.0), points=9).astype(np.float64), axis=1)
    heading = step / np.linalg.norm(step, axis=2, keepdims=True)
    turn = np.arccos(np.clip((heading[:, 1:] * heading[:, :-1]).sum(axis=2), -1.0, 1.0))
    part = turn / turn.sum(axis=1, keepdims=True)
    assert part.std(axis=0).min() > 0.01  # below 0.0013 where no turn is random
    assert np.linalg.norm(np.ptp(heading, axis=(0, 1))) > 0.8
