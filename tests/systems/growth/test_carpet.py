"""The carpet: images of endless grass from several angles (paper, section 2.2)."""

from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.bend import ribbon, segment_normals, spine
from tallgrass.systems.grow.blades import grow_blades
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.show.carpet.grow import ASIDE, BENDS, FLATTEST, STEEPEST, Carpet, grow_carpet
from tallgrass.systems.space.canopy import lodged

PATCH, TEXELS, SEGMENTS = 1.0, 128, 8
KIND = GrassKind(height=[0.25, 0.4], width=0.014)
HEADINGS = np.array([[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]])
POSTURES = grow_postures(KIND, seed=4)
BLADES = grow_blades(KIND, count=60, patch=PATCH, variants=4, seed=4)


@pytest.fixture(scope="module")
def carpet() -> Carpet:
    return grow_carpet(BLADES, POSTURES, patch=PATCH, texels=TEXELS, taper=KIND.taper)


@pytest.fixture(scope="module")
def dense() -> Carpet:
    """Growth with so many blades that single ones hardly matter."""
    blades = grow_blades(KIND, count=240, patch=PATCH, variants=4, seed=4)
    return grow_carpet(blades, POSTURES, patch=PATCH, texels=64, taper=KIND.taper)


@cache
def soup() -> tuple[NDArray[Any], NDArray[Any], NDArray[Any]]:
    """Return the corners (n, 3, 3), places (n, 3) and normals (n, 3) of every triangle of the patch."""
    left, right = ribbon(BLADES, POSTURES, (0.0, 0.0), points=SEGMENTS + 1, taper=KIND.taper)
    normal = segment_normals(BLADES, spine(BLADES, POSTURES, (0.0, 0.0), points=SEGMENTS + 1))
    corners, places, normals = [], [], []
    for blade in range(left.shape[0]):
        for k in range(SEGMENTS):
            low, high = k / SEGMENTS, (k + 1) / SEGMENTS
            corners += [[left[blade, k], right[blade, k], right[blade, k + 1]]]
            places += [[low, low, high]]
            corners += [[left[blade, k], right[blade, k + 1], left[blade, k + 1]]]
            places += [[low, high, high]]
            normals += [normal[blade, k]] * 2
    return np.array(corners, np.float64), np.array(places), np.array(normals)


def cast(origin: NDArray[Any], ray: NDArray[Any], corners: NDArray[Any]) -> tuple[int, float, float] | None:
    """Return the distance to the first triangle on a ray, its number, and the barycentric weights there; or None."""
    a, edge, side = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    cross = np.cross(ray, side)
    scale = (edge * cross).sum(axis=1)
    flat = np.abs(scale) < 1e-14
    scale = np.where(flat, 1.0, scale)
    away = origin - a
    u = (away * cross).sum(axis=1) / scale
    turned = np.cross(away, edge)
    v = (turned @ ray) / scale
    far = (side * turned).sum(axis=1) / scale
    far = np.where(~flat & (u >= 0) & (v >= 0) & (u + v <= 1), far, np.inf)
    first = int(far.argmin())
    return None if np.isinf(far[first]) else (first, u[first], v[first])


def meet(start: NDArray[Any], heading: NDArray[Any], slope: float, carpet: Carpet) -> list[float]:
    """Return what a ray through a point of the plane at mid-height hits, in the meaning of the carpet's texels."""
    corners, places, normals = soup()
    reach = carpet.height / slope
    ray = np.array([heading[0], -slope, heading[1]])
    origin = np.array([start[0], carpet.height / 2.0, start[1]]) - ray * reach / 2.0
    middle = origin[[0, 2]] + heading * reach / 2
    low = np.floor(middle / PATCH - np.abs(heading) * reach / PATCH / 2 - 1).astype(int)
    high = np.ceil(middle / PATCH + np.abs(heading) * reach / PATCH / 2 + 1).astype(int)
    lateral = np.array([-heading[1], heading[0]])
    around = np.array(
        [(i, j) for i in range(low[0] - 1, high[0] + 1) for j in range(low[1] - 1, high[1] + 1)], np.float64
    )
    texels = carpet.texels.shape[2]
    around += np.abs(lateral) * ((around @ np.abs(heading)) * (round(ASIDE * texels) / texels) % 1.0)[:, None]
    shifts = np.column_stack([around[:, 0], np.zeros(len(around)), around[:, 1]]) * PATCH
    field = (corners[None] + shifts[:, None, None]).reshape(-1, 3, 3)
    offset = (field[:, :, [0, 2]] - start) @ lateral
    near = np.flatnonzero((offset.min(axis=1) <= 0.0) & (offset.max(axis=1) >= 0.0))
    hit = cast(origin, ray, field[near]) if near.size else None
    if hit is None:
        return [0.0, 0.0, 0.0, 0.0]
    number, u, v = hit
    triangle = near[number] % corners.shape[0]
    weights = np.array([1.0 - u - v, u, v])
    azimuth = np.arctan2(normals[triangle][2], normals[triangle][0]) - np.arctan2(heading[1], heading[0])
    height = weights @ corners[triangle, :, 1] / carpet.height
    return [weights @ places[triangle], height, 0.5 + 0.5 * np.cos(2.0 * azimuth), 1.0]


@pytest.mark.parametrize(("row", "direction"), [(0, 0), (1, 3), (2, 1), (3, 2), (4, 0)])
def test_g4_the_carpet_means_what_rays_through_the_field_meet(carpet: Carpet, row: int, direction: int) -> None:
    spots = np.random.default_rng(row).random((40, 2)) * PATCH
    truth = np.array([meet(spot, HEADINGS[direction], float(carpet.slope[row]), carpet) for spot in spots])
    image = carpet.texels[row, direction] / 255.0
    column, line = (spots / PATCH * TEXELS).astype(int).T
    error = image[line, column] - truth
    spread = error.std(axis=0) / np.sqrt(spots.shape[0])
    assert (np.abs(error.mean(axis=0)) < 4.0 * spread + 0.004).all()


def test_g4_a_carpet_of_fine_texels_shows_each_ray_what_it_meets() -> None:
    fine = grow_carpet(BLADES, POSTURES, patch=PATCH, texels=400, taper=KIND.taper, slopes=(0.4,))
    spots = np.random.default_rng(7).random((150, 2)) * PATCH
    truth = np.array([meet(spot, HEADINGS[1], 0.4, fine) for spot in spots])
    column, row = (spots / PATCH * 400).astype(int).T
    found = fine.texels[0, 1, row, column] / 255.0
    assert (np.abs(found - truth).max(axis=1) < 0.05).mean() > 0.78
    assert np.corrcoef(found[:, 1], truth[:, 1])[0, 1] > 0.85


def test_g4_a_flatter_view_sees_less_ground_and_more_of_the_tips(dense: Carpet) -> None:
    texels = dense.texels.astype(float).mean(axis=(1, 2, 3))
    assert (np.diff(dense.slope) > 0.0).all()
    assert (np.diff(texels[:, 3]) < 0.0).all()
    assert (np.diff(texels[:, 1] / texels[:, 3]) < 0.0).all()


def test_g4_the_view_from_behind_sees_as_much_as_the_view_from_before(dense: Carpet) -> None:
    coverage = dense.texels[..., 3].mean(axis=(2, 3)) / 255.0
    np.testing.assert_allclose(coverage[:3, 0], coverage[:3, 2], rtol=0.03)
    np.testing.assert_allclose(coverage[:3, 1], coverage[:3, 3], rtol=0.03)


@pytest.mark.parametrize("across", [0, 1])
def test_g4_the_images_repeat_without_a_seam_across_the_view(carpet: Carpet, across: int) -> None:
    """The same grass, cut out half a patch farther aside, gives the same image, shifted by half a patch."""
    aside = np.where(np.arange(2) == across, 0.5 * PATCH, 0.0)
    moved = replace(BLADES, root=((BLADES.root + aside) % PATCH).astype(np.float32))
    other = grow_carpet(moved, POSTURES, patch=PATCH, texels=TEXELS, taper=KIND.taper).texels[:, across::2]
    same = np.roll(carpet.texels[:, across::2], TEXELS // 2, axis=3 - across)
    apart = np.abs(same.astype(int) - other)
    assert apart.mean() < 0.05
    assert (apart > 2).mean() < 0.005


def test_g4_a_level_view_meets_as_much_as_of_leaves_that_stand_anyhow(dense: Carpet) -> None:
    """Patches in line would never hide one another's gaps."""
    through = 1.0 - dense.texels[:2, ..., 3].mean(axis=(1, 2, 3)) / 255.0
    expected = through[1] ** (float(dense.slope[1]) / float(dense.slope[0]))
    assert through[0] == pytest.approx(expected, abs=0.02)


def test_g1_the_carpet_shows_the_roots_of_the_same_blades() -> None:
    texels = grow_carpet(BLADES, POSTURES, patch=PATCH, texels=256, taper=KIND.taper, slopes=(50.0,)).texels[0, 0]
    column, row = (BLADES.root / PATCH * 256).astype(int).T
    near = np.max([texels[(row + i) % 256, (column + j) % 256, 3] for i in (-1, 0, 1) for j in (-1, 0, 1)], axis=0)
    assert (near > 0).mean() > 0.9
    assert (texels[..., 3] > 0).mean() < 0.3


def test_what_is_painted_is_premultiplied_and_without_blades_there_is_nothing(carpet: Carpet) -> None:
    texels = carpet.texels.astype(int)
    assert (texels[..., :3] <= texels[..., 3:] + 1).all()
    assert not texels[texels[..., 3] == 0].any()


def test_g4_images_reach_up_to_the_highest_tip(carpet: Carpet) -> None:
    tips = spine(BLADES, POSTURES, (0.0, 0.0), points=9)[:, :, 1].max()
    assert 0.0 < carpet.height - tips <= 0.011


@pytest.mark.parametrize("texels", [8, 50, 96])
def test_g5_a_coarser_carpet_has_the_same_means(carpet: Carpet, texels: int) -> None:
    other = grow_carpet(BLADES, POSTURES, patch=PATCH, texels=texels, taper=KIND.taper)
    assert other.texels.shape == (5, 4, texels, texels, 4)
    apart = np.abs(other.texels.mean(axis=(2, 3)) - carpet.texels.mean(axis=(2, 3))) / 255.0
    assert apart[2:].max() < 0.01
    assert apart.max() < 0.03, "from the side, few blades show which patches stand in line, to a texel"


def bent_as(carpet: Carpet, bend: float, *, aside: bool) -> NDArray[Any]:
    """Return the columns of leaves met more, and of the factors of place and height, for a bend, (slopes, 3)."""
    towards, away = (carpet.bent[:, round((1.0 + each) * (BENDS // 2))] for each in (-bend, bend))
    if not aside:
        return away[:, :3]
    mean = 0.5 * (towards + away)[:, :3]
    return np.column_stack([mean[:, 0] + away[:, 3], mean[:, 1:] * (1.0 + towards[:, 3:])])


@pytest.mark.parametrize(("bend", "way"), [*((each, "along") for each in (-0.75, -0.5, 0.5, 0.75)), (0.75, "aside")])
def test_g5_of_bent_grass_as_much_is_met_as_its_own_images_show(dense: Carpet, bend: float, way: str) -> None:
    blades = grow_blades(KIND, count=240, patch=PATCH, variants=4, seed=4)
    bends = np.array([bend, 0.0] if way == "aside" else [0.0, -bend], np.float32)
    leant = replace(blades, rest=bends + blades.rest * np.float32(1.0 - abs(bend)))
    rows = bent_as(dense, bend, aside=way == "aside")
    at_rest = 0.1, 0.3, 1.0
    slopes = tuple(slope * lodged(bend) for slope in at_rest)
    truth, still = (
        grow_carpet(
            grown, POSTURES, patch=PATCH, texels=64, taper=KIND.taper, slopes=seen, height=dense.height
        ).texels[:, 0].reshape(len(seen), -1, 4).mean(axis=1) / 255.0
        for grown, seen in ((leant, slopes), (blades, at_rest))
    )  # fmt: skip
    known = np.geomspace(FLATTEST, STEEPEST, len(rows))
    for slope, shown, usual in zip(at_rest, truth, still, strict=True):
        more, place, height = (np.interp(np.log(slope), np.log(known), column) for column in rows.T)
        assert 1.0 - (1.0 - usual[3]) * np.exp(-more) == pytest.approx(shown[3], abs=0.04)
        assert usual[0] / usual[3] * place == pytest.approx(shown[0] / shown[3], abs=0.05)
        assert usual[1] / usual[3] * height * lodged(bend) == pytest.approx(shown[1] / shown[3], abs=0.05)
