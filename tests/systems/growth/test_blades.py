"""The blades of a patch (paper, section 2.2)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.grow.blades import grow_blades, let_hang, wither
from tallgrass.systems.grow.organs import BLADE, WITHERED
from tallgrass.systems.grow.postures import HANGING, grow_postures
from tallgrass.systems.grow.record import Blades

PATCH = 2.5


def meadow(seed: int = 1, count: int = 500, kind: GrassKind | None = None) -> Blades:
    return grow_blades(kind or GrassKind(), count=count, patch=PATCH, variants=4, seed=seed)


def fields(blades: Blades) -> list[NDArray[Any]]:
    return [blades.root, blades.height, blades.width, blades.facing, blades.rest, blades.variant, blades.rank]


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 700), st.integers(0, 2**63 - 1), st.floats(0.0, 0.9), st.floats(0.5, 20.0), st.integers(1, 6))
def test_g1_any_patch_has_its_blades_inside_and_within_the_kinds_limits(
    count: int, seed: int, lean: float, patch: float, variants: int
) -> None:
    kind = GrassKind(lean=lean)
    blades = grow_blades(kind, count=count, patch=patch, variants=variants, seed=seed)
    assert all(array.shape[0] == count and array.flags.c_contiguous for array in fields(blades))
    assert all(array.dtype == np.float32 for array in fields(blades) if array is not blades.variant)
    assert (blades.root >= 0.0).all()
    assert (blades.root < np.float32(patch)).all()
    assert (blades.height >= np.float32(0.4)).all()
    assert (blades.height <= np.float32(0.7)).all()
    assert np.linalg.norm(blades.rest, axis=1).max() <= lean + 1e-6
    assert (blades.variant < variants).all()
    assert (np.abs(blades.facing) <= np.float32(np.pi)).all()


def test_g1_the_same_seed_is_the_same_patch_and_another_seed_another() -> None:
    for one, two, other in zip(fields(meadow(3)), fields(meadow(3)), fields(meadow(4)), strict=True):
        np.testing.assert_array_equal(one, two)
        if one.size and one.ndim:
            assert np.array_equal(one, other) == (one.shape == (500,) and np.array_equal(one, meadow(3).rank))


@pytest.mark.parametrize("seed", range(4))
def test_blades_are_spread_evenly_at_every_density(seed: int) -> None:
    blades = meadow(seed)
    for kept in (500, 250, 100):
        root = blades.root[blades.rank < kept / 500]
        assert root.shape[0] == kept
        for side in (3, 5):
            cell = (root / PATCH * side).astype(int)
            number = np.bincount(cell[:, 0] * side + cell[:, 1], minlength=side * side)
            chance = kept / side**2
            assert ((number - chance) ** 2 / chance).mean() < 0.8


@pytest.mark.parametrize("seed", range(4))
def test_neither_edges_nor_corners_of_a_patch_are_thin_or_crowded(seed: int) -> None:
    root = np.concatenate([meadow(seed * 10 + number).root for number in range(10)])
    rim = (np.minimum(root, PATCH - root).min(axis=1) < 0.125 * PATCH).mean()
    assert rim == pytest.approx(1.0 - 0.75**2, abs=0.03)


def test_ranks_are_a_permutation() -> None:
    blades = meadow(count=320)
    np.testing.assert_allclose(np.sort(blades.rank) * 320, np.arange(320), atol=1e-3)


def test_neighbours_are_alike_in_height() -> None:
    apart, near = [], []
    for seed in range(6):
        blades = meadow(seed)
        away = blades.root[:, None] - blades.root[None]
        distance = np.linalg.norm(away - PATCH * np.round(away / PATCH), axis=2)
        difference = np.abs(blades.height[:, None] - blades.height[None])
        near.append(difference[(distance < 0.15) & (distance > 0.0)].mean())
        apart.append(difference[distance > 0.6].mean())
    assert np.mean(near) < 0.97 * np.mean(apart)


def test_heights_use_the_whole_range_and_lean_never_stops() -> None:
    blades = meadow()
    assert np.ptp(blades.height) > 0.25
    lean = np.linalg.norm(blades.rest, axis=1)
    assert lean.min() >= 0.05 - 1e-6
    assert lean.max() > 0.28


@pytest.mark.parametrize("clumping", [0.0, 0.5, 1.0])
def test_lean_and_facing_point_everywhere(clumping: float) -> None:
    """Facings are compared by their doubled azimuths, as both sides of a blade are lit alike."""
    blades = meadow(kind=GrassKind(clumping=clumping))
    for way in (2.0 * blades.facing, np.arctan2(blades.rest[:, 1], blades.rest[:, 0])):
        angle = (way + np.pi) % (2.0 * np.pi) - np.pi
        assert abs(np.exp(1j * angle).mean()) < 0.15
        assert np.histogram(angle, 8, (-np.pi, np.pi))[0].min() > 35


def test_neighbours_face_and_lean_alike_where_a_kind_stands_in_tussocks() -> None:
    alike = {clumping: np.mean([alikeness(clumping, seed) for seed in range(6)], axis=0) for clumping in (0.0, 1.0)}
    np.testing.assert_allclose(alike[0.0], 0.0, atol=0.05)
    assert (alike[1.0] > 0.3).all()


def alikeness(clumping: float, seed: int) -> tuple[float, float]:
    """Return the mean cosines of the angles between neighbours' doubled facings, and between their leans."""
    blades = meadow(seed, kind=GrassKind(clumping=clumping))
    away = blades.root[:, None] - blades.root[None]
    distance = np.linalg.norm(away - PATCH * np.round(away / PATCH), axis=2)
    near, lean = (distance < 0.15) & (distance > 0.0), np.arctan2(blades.rest[:, 1], blades.rest[:, 0])
    face, lies = (np.cos(way[:, None] - way[None])[near].mean() for way in (2.0 * blades.facing, lean))
    return face, lies


def test_widths_differ_threefold_and_share_out_the_same_leaf_area() -> None:
    blades = meadow()
    fifth, most = np.quantile(blades.width, [0.05, 0.95])
    assert most > 3.0 * fifth
    assert (blades.width @ blades.height) == pytest.approx(0.95 * 0.02 * blades.height.sum(), rel=1e-4)


def test_the_oldest_leaves_hang_over_with_their_face_up_and_none_where_grass_is_straight_or_round() -> None:
    kind, young = GrassKind(), meadow()
    some = let_hang(young, kind, patch=PATCH, variants=4, seed=1)
    hang = some.variant >= 4 - HANGING
    assert hang.mean() == pytest.approx(0.25, abs=0.06)
    for before, after in zip(fields(young), fields(some), strict=True):
        np.testing.assert_array_equal(after[~hang], before[~hang])
    index, lean = np.linalg.norm(some.rest[hang], axis=1), np.arctan2(some.rest[:, 1], some.rest[:, 0])
    assert (index > kind.lean).mean() > 0.8  # few reach over the edge
    assert (index <= 0.9 + 1e-6).all()
    assert np.cos(some.facing - lean)[hang].mean() > 0.9
    for other in (GrassKind(lean=0.0), GrassKind(profile="rush")):
        stands = let_hang(young, other, patch=PATCH, variants=4, seed=1)
        assert (other.lean == 0.0 and not stands.rest[hang].any()) or (stands.rest == young.rest).all()


@pytest.mark.parametrize("lean", [0.2, 0.9])
def test_leaves_that_hang_reach_no_farther_over_the_edge_than_others(lean: float) -> None:
    kind = GrassKind(lean=lean)
    young, postures = meadow(kind=kind), grow_postures(kind, variants=4)
    old = let_hang(young, kind, patch=PATCH, variants=4, seed=1)
    beyond = [np.abs(spine(each, postures, (0.0, 0.0), points=9)[..., ::2] - PATCH / 2).max() for each in (young, old)]
    assert beyond[1] < beyond[0] + 0.02


@settings(max_examples=20, deadline=None)
@given(st.floats(0.05, 0.6), st.integers(0, 2**32))
def test_as_many_blades_are_dead_as_asked_and_they_alone_are_shorter_and_more_bent(part: float, seed: int) -> None:
    alive = meadow(seed=seed, count=900)
    some = wither(alive, part, seed=seed)
    dead = some.organ == WITHERED
    assert dead.mean() == pytest.approx(part, abs=0.06)
    assert (some.organ[~dead] == BLADE).all()
    for before, after in zip(fields(alive), fields(some), strict=True):
        np.testing.assert_array_equal(after[~dead], before[~dead])
    lean = np.linalg.norm(some.rest, axis=1)
    assert (some.height[dead] < alive.height[dead]).all()
    assert (lean[dead] > np.linalg.norm(alive.rest[dead], axis=1)).all()
    assert lean.max() <= 0.9 + 1e-6


def test_grass_alone_withers() -> None:
    with pytest.raises(ValueError, match="grass alone withers"):
        GrassKind(plant="flower", withered=0.1)
