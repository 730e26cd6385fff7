"""The saucer's shape, on arrays alone (R4)."""

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.bodies.fly import LEVEL_RADIUS, LOWEST, level
from tallgrass.systems.bodies.saucer import FIN, RADIUS, borders, face_normals, saucer

Mesh = tuple[NDArray[np.void], NDArray[np.int32]]


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return saucer()


def welded(mesh: Mesh) -> NDArray[np.int64]:
    """Return the triangles, with vertices at equal places merged, (n, 3)."""
    _, same = np.unique(np.round(mesh[0]["place"], 5), axis=0, return_inverse=True)
    return np.asarray(same.reshape(-1)[mesh[1]])


def test_r4_the_saucer_is_closed(mesh: Mesh) -> None:
    triangles = welded(mesh)
    edges = np.stack([triangles, np.roll(triangles, -1, axis=1)], -1).reshape(-1, 2)
    there = {(int(a), int(b)) for a, b in edges}
    assert len(there) == len(edges), "no edge is walked twice in one direction"
    assert all((b, a) in there for a, b in there), "and every edge is walked back"
    assert (np.sort(triangles, axis=1)[:, :-1] < np.sort(triangles, axis=1)[:, 1:]).all()


def test_r4_its_normals_are_of_unit_length_and_point_outwards(mesh: Mesh) -> None:
    vertices, triangles = mesh
    np.testing.assert_allclose(np.linalg.norm(vertices["normal"], axis=1), 1.0, atol=1e-6)
    smooth = vertices["normal"][triangles]
    assert (np.einsum("ijk,ik->ij", smooth, face_normals(*mesh)) > 0.7).all()
    corners = vertices["place"][triangles].astype(np.float64)
    volume = np.einsum("ij,ij->i", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])).sum() / 6.0
    assert 1.5 < volume < 3.5, "of triangles that are counter-clockwise from outside it is positive [m3]"


def test_r4_it_is_three_metres_across_and_nearly_one_high(mesh: Mesh) -> None:
    vertices, triangles = mesh
    assert np.hypot(vertices["place"][:, 0], vertices["place"][:, 2]).max() == pytest.approx(RADIUS, abs=1e-6)
    assert np.ptp(vertices["place"], axis=0) == pytest.approx((3.0, 0.9, 3.0), abs=1e-6)
    assert 300 < len(triangles) < 2000


def test_r4_its_fin_is_behind(mesh: Mesh) -> None:
    fin = mesh[0][mesh[0]["part"] == FIN]["place"]
    assert fin[:, 2].min() > 0.5
    assert np.abs(fin[:, 0]).max() < 0.1


def test_every_edge_that_can_be_an_outline_has_a_border(mesh: Mesh) -> None:
    corners, triangles = borders(*mesh)
    assert len(corners) % 4 == 0
    assert len(triangles) == len(corners) // 2
    quads = corners.reshape(-1, 4)
    assert (quads["outside"] == (0.0, 0.0, 1.0, 1.0)).all()
    np.testing.assert_array_equal(quads["place"][:, 0], quads["other"][:, 1])
    np.testing.assert_array_equal(quads["place"][:, :2], quads["place"][:, 2:])
    for name in ("side", "beyond"):
        edge = (quads["place"][:, 1] - quads["place"][:, 0]).astype(np.float64)
        assert np.abs(np.einsum("ij,ij->i", edge, quads[name][:, 0])).max() < 1e-5, "both sides meet in the edge"
    seen_from = np.array([3.0, 4.0, 9.0])
    front = (face_normals(*mesh) * (seen_from - mesh[0]["place"][mesh[1][:, 0]])).sum(axis=1) > 0.0
    ends = np.sort(np.stack([welded(mesh), np.roll(welded(mesh), -1, axis=1)], -1).reshape(-1, 2), axis=1)
    facing: dict[tuple[int, int], list[bool]] = {}
    for edge_ends, shows in zip(map(tuple, ends), np.repeat(front, 3), strict=True):
        facing.setdefault(edge_ends, []).append(bool(shows))
    outline = sum(first != second for first, second in facing.values())
    toward = seen_from - quads["place"][:, 0]
    sides = [(quads[name][:, 0] * toward).sum(axis=1) > 0.0 for name in ("side", "beyond")]
    assert np.abs(int((sides[0] != sides[1]).sum()) - outline) <= 2


def test_r4_a_saucer_keeps_above_the_mean_of_the_grass_within_a_radius_and_clear_of_the_highest() -> None:
    asked: list[NDArray[np.float32]] = []

    def sloping(xz: NDArray[np.float32]) -> NDArray[np.float32]:
        asked.append(xz)
        return np.asarray(0.5 + 0.1 * xz[:, 0] - 0.2 * xz[:, 1], np.float32)

    assert level(7.0, -2.0, sloping, height=2.0) == pytest.approx(0.5 + 0.7 + 0.4 + 2.0, abs=1e-5)
    away = np.hypot(*(asked[0] - (7.0, -2.0)).T)
    assert away.max() == pytest.approx(LEVEL_RADIUS, rel=1e-5)
    assert (np.abs(away - 0.5 * LEVEL_RADIUS) < 0.1 * LEVEL_RADIUS).sum() >= 4

    def spiked(xz: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.where(np.arange(len(xz)) == 3, np.float32(9.0), np.float32(0.0))

    assert level(0.0, 0.0, spiked, height=2.0) == 9.0 + LOWEST
