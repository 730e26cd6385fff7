"""Strips: images of the blades between two planes (paper, sections 2.1, 2.2, 4.2)."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.bend import ribbon, spine
from tallgrass.systems.grow.blades import grow_blades
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.grow.record import Blades
from tallgrass.systems.show.strips.grow import Strips, grow_strips, targets_on

PATCH, MARGIN, STRIPS, TEXEL = 2.0, 0.3, 4, 0.008
KIND = GrassKind(width=0.02)
POSTURES = grow_postures(KIND, seed=2)


def grown(kind: GrassKind = KIND, count: int = 120, seed: int = 2, **options: Any) -> tuple[Blades, Strips]:
    blades = grow_blades(kind, count=count, patch=PATCH, variants=4, seed=seed)
    settings = {"patch": PATCH, "strips": STRIPS, "texel": TEXEL, "taper": kind.taper, "margin": MARGIN} | options
    return blades, grow_strips(blades, POSTURES, **settings)


BLADES, SHEET = grown()


def triangles(blades: Blades, points: int = 13, taper: float = KIND.taper) -> NDArray[Any]:
    left, right = ribbon(blades, POSTURES, (0.0, 0.0), points=points, taper=taper)
    both = [left[:, :-1], right[:, :-1], right[:, 1:], left[:, :-1], right[:, 1:], left[:, 1:]]
    return np.stack(both, axis=2).reshape(blades.root.shape[0], points - 1, 2, 3, 3).astype(np.float64)


def covered(corners: NDArray[Any], point: NDArray[Any]) -> NDArray[Any]:
    """Return the mask of points (p, 2) that lie in any of the triangles (n, 3, 2)."""
    a, b, c = (corners[:, None, k] for k in range(3))

    def side(p: NDArray[Any], q: NDArray[Any]) -> NDArray[Any]:
        along, away = q - p, point - p
        return np.asarray(along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0])

    one, two, three = side(a, b), side(b, c), side(c, a)
    left, right = (one > 0) & (two > 0) & (three > 0), (one < 0) & (two < 0) & (three < 0)
    return np.asarray((left | right).any(axis=0))


def texel_of(sheet: Strips, u: NDArray[Any], v: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    h, w = sheet.texels.shape[2:4]
    return np.clip((v * h).astype(int), 0, h - 1), np.clip((u * w).astype(int), 0, w - 1)


def test_g1_every_blade_is_painted_on_the_strip_of_its_slice() -> None:
    for orientation, axis in ((0, 1), (1, 0)):
        number = SHEET.slice[orientation]
        low = number * PATCH / STRIPS
        assert ((BLADES.root[:, axis] >= low - 1e-6) & (BLADES.root[:, axis] <= low + PATCH / STRIPS + 1e-6)).all()
        np.testing.assert_allclose(SHEET.plane[number], low + PATCH / STRIPS / 2, rtol=1e-6)


def test_g1_targets_are_the_blades_control_points_seen_along_the_slices_normal() -> None:
    centre = spine(BLADES, POSTURES, (0.0, 0.0), points=17)
    for orientation, axis in ((0, 0), (1, 2)):
        u, v = np.moveaxis(targets_on(SHEET, BLADES, POSTURES)[orientation], -1, 0)
        np.testing.assert_allclose(u * (PATCH + 2 * MARGIN) - MARGIN, centre[:, :, axis], atol=1e-5)
        np.testing.assert_allclose(v * SHEET.height, centre[:, :, 1], atol=1e-5)


@pytest.mark.parametrize("orientation", [0, 1])
def test_g1_every_blade_is_painted_at_its_targets(orientation: int) -> None:
    across = np.abs([-np.sin(BLADES.facing), np.cos(BLADES.facing)][orientation]) * BLADES.width
    targets, shown = targets_on(SHEET, BLADES, POSTURES), 0
    for blade in np.flatnonzero(across > 2.5 * TEXEL * 0.7):
        for point in range(9):
            row, column = texel_of(SHEET, *targets[orientation, blade, point])
            texel = SHEET.texels[orientation, SHEET.slice[orientation, blade], row, column]
            assert texel[3] > 64
            shown += 1
    assert shown > 100


@pytest.mark.parametrize("orientation", [0, 1])
def test_g1_a_strip_covers_what_the_blades_of_its_slice_cover(orientation: int) -> None:
    axis = (0, 2)[orientation]
    ribbons = triangles(BLADES)
    random = np.random.default_rng(orientation)
    for strip in (0, 2):
        corners = ribbons[SHEET.slice[orientation] == strip].reshape(-1, 3, 3)[:, :, [axis, 1]]
        spot = random.random((6000, 2)) * [PATCH + 2 * MARGIN, 0.5]
        truth = covered(corners, spot - [MARGIN, 0.0]).astype(float)
        row, column = texel_of(SHEET, spot[:, 0] / (PATCH + 2 * MARGIN), spot[:, 1] / SHEET.height)
        painted = SHEET.texels[orientation, strip, row, column, 3] / 255.0
        error = painted - truth
        assert truth.mean() > 0.05
        assert abs(error.mean()) < 4.0 * error.std() / np.sqrt(error.size)
        assert np.corrcoef(painted, truth)[0, 1] > 0.75
        assert truth[painted == 0.0].mean() < 0.004
        assert truth[painted == 1.0].mean() > 0.97


def test_what_is_painted_is_premultiplied_by_coverage() -> None:
    texels = SHEET.texels.astype(int)
    assert (texels[..., :3] <= texels[..., 3:] + 1).all()
    assert (SHEET.ranks <= texels[..., 3] + 1).all()
    assert not texels[texels[..., 3] == 0].any()


def test_g1_a_texel_tells_the_place_along_the_blade() -> None:
    texels = SHEET.texels[0].astype(float)
    full = texels[..., 3] == 255
    row = np.nonzero(full)[1]
    place = (texels[..., 0] / np.maximum(texels[..., 3], 1))[full]
    height = (row + 0.5) / texels.shape[1] * SHEET.height
    assert np.corrcoef(place, height)[0, 1] > 0.9
    assert place[row < 3].max() < 0.06


@pytest.mark.parametrize("orientation", [0, 1])
def test_a_lone_blades_texels_have_twice_its_own_azimuth_on_either_strip(orientation: int) -> None:
    shown = 0
    for seed in range(5):
        blades, sheet = grown(GrassKind(width=0.04, lean=0.1), count=1, seed=seed)
        texels = sheet.texels[orientation, sheet.slice[orientation, 0]].astype(float)
        full = texels[texels[..., 3] == 255]
        twice = np.array([np.cos(2.0 * blades.facing[0]), np.sin(2.0 * blades.facing[0])])
        np.testing.assert_allclose(full[:, 1:3] / 127.5 - 1.0, np.broadcast_to(twice, (len(full), 2)), atol=0.01)
        shown += full.shape[0]
    assert shown > 100


def test_g3_of_two_blades_the_one_that_stays_longer_is_painted() -> None:
    blades = grow_blades(GrassKind(width=0.05, lean=0.0), count=2, patch=PATCH, variants=1, seed=1)
    blades.root[:] = [[1.0, 0.1], [1.0, 0.3]]
    blades.facing[:] = [np.pi / 2, np.pi / 2]
    blades.height[:] = [0.7, 0.4]
    blades.rank[:] = [0.5, 0.0]
    sheet = grow_strips(blades, POSTURES, patch=PATCH, strips=2, texel=TEXEL, taper=1.0, margin=MARGIN)
    row, column = texel_of(sheet, np.array([1.3 / 2.6]), np.array([0.1, 0.6]) / sheet.height)
    texels = sheet.texels[0, 0, row, column].astype(float)
    ranks = sheet.ranks[0, 0, row, column].astype(float)
    np.testing.assert_allclose(ranks / texels[:, 3], [0.0, 0.5], atol=0.01)


def test_ranks_thin_a_strip_out_blade_by_blade() -> None:
    coverage, rank = SHEET.texels[0, ..., 3].astype(float), SHEET.ranks[0]
    painted = coverage > 32
    assert np.quantile(rank[painted] / coverage[painted], 0.5) == pytest.approx(0.5, abs=0.12)
    assert np.unique(rank[coverage == 255]).size > 60


def test_the_texture_reaches_over_the_margins_and_the_highest_tip() -> None:
    centre = spine(BLADES, POSTURES, (0.0, 0.0), points=17)
    assert 0.0 < SHEET.height - centre[:, :, 1].max() <= TEXEL + 1e-6
    h, w = SHEET.texels.shape[2:4]
    assert w == int(np.ceil((PATCH + 2 * MARGIN) / TEXEL))
    assert h == pytest.approx(SHEET.height / TEXEL, abs=1e-6)


@pytest.fixture(scope="module")
def finest() -> float:
    _, sheet = grown(strips=20, texel=0.01, height=0.8)
    return float(sheet.texels[..., 3].mean()) / 255.0 * 20


@pytest.mark.parametrize(("strips", "texel", "part"), [(1, 0.05, 0.6), (2, 0.02, 0.75), (9, 0.01, 0.92)])
def test_g5_strips_go_from_fine_to_coarse_and_lose_only_what_hides_behind(
    finest: float, strips: int, texel: float, part: float
) -> None:
    _, sheet = grown(strips=strips, texel=texel, height=0.8)
    assert sheet.texels.shape[:2] == (2, strips)
    area = sheet.texels[..., 3].mean() / 255.0 * strips
    assert part * finest < area <= 1.02 * finest


def test_the_same_blades_make_the_same_strips() -> None:
    _, again = grown()
    for name in ("texels", "ranks", "slice", "plane"):
        np.testing.assert_array_equal(getattr(SHEET, name), getattr(again, name))
