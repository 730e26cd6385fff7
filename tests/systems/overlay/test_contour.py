"""Contours of masks that are sampled."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Extent
from tallgrass.systems.overlay.contour import Contour, contour, sampled

WIDE = Extent(-1000.0, 1000.0, -1000.0, 1000.0)


def disc(radius: float, soft: float = 0.0) -> tuple[Extent, "Mask"]:
    return Extent(-radius, radius, -radius, radius), Mask(radius, soft)


class Mask:
    def __init__(self, radius: float, soft: float) -> None:
        self.radius, self.soft = radius, soft

    def __call__(self, place: Floats) -> Floats:
        inside = np.float32(self.radius) - np.hypot(place[:, 0], place[:, 1])
        return np.clip(inside / np.float32(self.soft), 0.0, 1.0) if self.soft else (inside > 0.0).astype(np.float32)


def drawn(extent: Extent, mask: Mask, level: float = 0.004, seen: Extent = WIDE) -> Contour:
    grid = sampled(mask, extent, seen)
    assert grid is not None
    return contour(grid, level)


def area(corners: Floats) -> float:
    a, b = (corners[:, k].astype(float) - corners[:, 0] for k in (1, 2))
    return float(np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum() / 2)


@given(st.floats(0.5, 200.0))
def test_n8_the_outline_of_a_disc_has_its_radius(radius: float) -> None:
    found = drawn(*disc(radius))
    np.testing.assert_allclose(np.hypot(*found.edge.reshape(-1, 2).T), radius, rtol=2e-3)
    length = np.linalg.norm(found.edge[:, 1] - found.edge[:, 0], axis=1).sum()
    assert length == pytest.approx(2 * np.pi * radius, rel=0.01)
    assert area(found.corners) == pytest.approx(np.pi * radius**2, rel=0.01)
    assert found.weight == pytest.approx(1.0)


@given(st.floats(0.1, 0.9))
def test_n8_a_soft_edge_is_outlined_at_any_level(level: float) -> None:
    found = drawn(*disc(10.0, soft=4.0), level)
    np.testing.assert_allclose(np.hypot(*found.edge.reshape(-1, 2).T), 10.0 - 4.0 * level, rtol=0.0, atol=0.01)
    assert found.weight.min() >= level
    assert found.weight.max() == 1.0


def test_n8_an_outline_is_closed() -> None:
    found = drawn(*disc(7.0))
    ends, counts = np.unique(found.edge.reshape(-1, 2), axis=0, return_counts=True)
    assert len(ends) == len(found.edge)
    assert (counts == 2).all()


def test_n8_a_mask_with_a_hole_has_two_outlines() -> None:
    def ring(place: Floats) -> Floats:
        away = np.hypot(place[:, 0], place[:, 1])
        return ((away < 9.0) & (away > 4.0)).astype(np.float32)

    grid = sampled(ring, Extent(-9.0, 9.0, -9.0, 9.0), WIDE)
    assert grid is not None
    found = contour(grid, 0.5)
    away = np.hypot(*found.edge.reshape(-1, 2).T)
    assert np.minimum(np.abs(away - 9.0), np.abs(away - 4.0)).max() < 0.01
    assert area(found.corners) == pytest.approx(np.pi * (81 - 16), rel=0.01)


def test_n8_a_mask_ends_where_its_extent_does() -> None:
    found = drawn(Extent(-2.0, 3.0, -1.0, 4.0), Mask(100.0, 0.0))
    low, high = found.edge.reshape(-1, 2).min(axis=0), found.edge.reshape(-1, 2).max(axis=0)
    assert low == pytest.approx([-2.0, -1.0], abs=0.01)
    assert high == pytest.approx([3.0, 4.0], abs=0.01)
    assert area(found.corners) == pytest.approx(25.0, rel=0.01)


def test_n8_of_a_large_mask_only_what_is_seen_is_sampled() -> None:
    extent, mask = disc(900.0)
    found = drawn(extent, mask, seen=Extent(850.0, 950.0, -50.0, 50.0))
    edge = found.edge.reshape(-1, 2)
    assert np.hypot(*edge.T) == pytest.approx(900.0, abs=0.05), "no outline where sampling ends"
    assert (np.abs(edge[:, 1]) < 60.0).all()
    assert sampled(mask, extent, Extent(950.0, 960.0, 0.0, 10.0)) is None


def test_n8_a_mask_that_is_nowhere_has_no_outline() -> None:
    found = drawn(Extent(-1.0, 1.0, -1.0, 1.0), Mask(-1.0, 0.0))
    assert len(found.edge) == len(found.corners) == 0
