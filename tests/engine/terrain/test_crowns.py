"""Crowns over the grass: which of them differ from before, and how much grass they leave (F4)."""

import numpy as np
import pytest

from tallgrass.engine.terrain.crowns import SHADE_KEEPS, Crowns


def rows_of(discs: object) -> set[tuple[float, ...]]:
    return {tuple(row) for row in np.asarray(discs).tolist()}


@pytest.mark.parametrize("seed", range(8))
def test_crowns_that_differ_are_those_added_removed_or_changed(seed: int) -> None:
    draw = np.random.default_rng(seed)
    crowns, discs, fading = Crowns(), draw.uniform(1.0, 50.0, (12, 4)), np.zeros((0, 4))
    assert rows_of(crowns.stand(discs)) == rows_of(discs)
    for _ in range(12):
        before = rows_of(crowns.discs)
        removed = draw.random(len(discs)) < draw.choice([0.0, 0.1, 0.5])
        fading = np.concatenate([fading[draw.random(len(fading)) < 0.5], 0.5 * discs[removed]])
        discs = discs[~removed].copy()
        discs[draw.random(len(discs)) < 0.1, 3] *= 0.5
        at = int(draw.integers(len(discs) + 1))
        discs = np.insert(discs, at, draw.uniform(1.0, 50.0, (int(draw.integers(3)), 4)), axis=0)
        assert rows_of(crowns.stand(discs, fading)) == before ^ rows_of(np.concatenate([discs, fading]))
        assert not len(crowns.stand(discs, fading))


def test_fading_crowns_shade_the_grass_as_standing_ones_do() -> None:
    disc, place = np.array([[3.0, -2.0, 4.0, 1.2]]), np.array([[3.0, -2.0], [5.0, -2.0], [8.0, -2.0]], np.float32)
    standing, fading = Crowns(), Crowns()
    standing.stand(disc)
    fading.stand(disc[:0], disc)
    left = standing.left_at(place)
    assert left is not None
    expected = SHADE_KEEPS + (1.0 - SHADE_KEEPS) * np.exp(-1.2 * np.array([1.0, 0.75**2, 0.0]))
    np.testing.assert_allclose(left, expected, rtol=1e-6)
    np.testing.assert_array_equal(fading.left_at(place), left)
