"""Levels of detail and transition weights, patch by patch."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.overlay.marks import Marks
from tallgrass.systems.overlay.paint import ring_shades
from tallgrass.systems.overlay.patches import level_marks, patch_colors, squares, weight_marks
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

BLADES, STRIPS, CARPET = range(3)


def cells_of(marks: Marks, patch: float) -> NDArray[np.int64]:
    """Return the cell under each square of two triangles."""
    middle = marks.shapes["place"].reshape(-1, 6, 3).mean(axis=1)[:, ::2]
    return np.asarray(np.floor(middle / patch), np.int64)


@pytest.fixture
def site(laid: Laid) -> Site:
    return laid()


@pytest.fixture
def outlook(site: Site, look: Look) -> Outlook:
    return look(site, 1.0, 1.0, yaw=0.3)


def test_n8_squares_stand_in_the_middle_of_their_cells() -> None:
    cells = np.array([[0, 0], [-3, 7]], np.int32)
    corners = squares(cells, patch=2.5, scale=np.array([1.0, 0.5], np.float32))
    np.testing.assert_allclose(corners.mean(axis=1), (cells + 0.5) * 2.5, atol=1e-5)
    sides = np.ptp(corners, axis=1)
    assert 2.2 < sides[0, 0] < 2.5
    np.testing.assert_allclose(sides[1], sides[0] / 2, rtol=1e-5)


def test_n8_each_visible_patch_has_one_square_in_its_representations_colour(outlook: Outlook, site: Site) -> None:
    patches, marks = outlook.patches, level_marks(outlook, site, settled=False)
    seen = np.flatnonzero(patches.alive & patches.visible)
    assert 0 < len(seen) < patches.alive.sum()
    np.testing.assert_array_equal(cells_of(marks, site.ground.patch), patches.cell[seen])
    colors = marks.shapes["color"].reshape(-1, 6, 4)[:, 0, :3]
    pure = [ring_shades(each.color, count) for each, count in zip(site.representations, (2, 2, 1), strict=True)]
    for level in (BLADES, STRIPS):
        of_it = (patches.representation[seen] == level) & (patches.distance[seen] <= 4)
        assert of_it.any()
        assert all(any(np.allclose(color, shade) for shade in pure[level]) for color in colors[of_it])
    far = patches.distance[seen] > site.reach[1] + 1
    np.testing.assert_allclose(colors[far], np.tile(pure[CARPET], (far.sum(), 1)))


def test_n8_rings_are_shades_from_strong_to_pale(outlook: Outlook, site: Site) -> None:
    colors, patches = patch_colors(outlook, site), outlook.patches
    near, far = (np.flatnonzero(patches.visible & (patches.distance == distance))[0] for distance in (1, 2))
    assert colors[far].min() > colors[near].min() + 0.1


def test_n8_what_nobody_has_seen_has_the_shade_of_its_distance(outlook: Outlook, site: Site) -> None:
    colors, patches = patch_colors(outlook, site), outlook.patches
    for distance in (1, 2):
        ring = patches.alive & (patches.distance == distance)
        seen, unseen = (np.flatnonzero(ring & (patches.visible == visible)) for visible in (True, False))
        assert seen.size
        assert unseen.size
        np.testing.assert_array_equal(colors[unseen], np.tile(colors[seen[0]], (len(unseen), 1)))


def changing(outlook: Outlook, progress: float) -> int:
    """Put one visible patch into a transition from strips to blades; return its row."""
    patches = outlook.patches
    row = int(np.flatnonzero(patches.visible & patches.alive & (patches.distance == 2))[0])
    patches.representation[row], patches.previous[row] = BLADES, STRIPS
    patches.progress[row] = progress
    return row


@pytest.mark.parametrize("progress", [0.1, 0.5, 0.9])
def test_n8_a_changing_patch_is_filled_by_as_much_as_it_has_changed(
    outlook: Outlook, site: Site, progress: float
) -> None:
    row = changing(outlook, progress)
    marks = weight_marks(outlook, site)
    here = np.flatnonzero((cells_of(marks, site.ground.patch) == outlook.patches.cell[row]).all(axis=1))
    assert len(here) == 2, "the coarser one, and the finer one inside it"
    squares_here = marks.shapes.reshape(-1, 6)[here]
    outer, inner = (np.ptp(one["place"][:, 0]) * np.ptp(one["place"][:, 2]) for one in squares_here)
    assert inner / outer == pytest.approx(progress, abs=1e-3)
    for one, level in zip(squares_here, (STRIPS, BLADES), strict=True):
        np.testing.assert_allclose(one["color"][0, :3], ring_shades(site.representations[level].color, 1)[0], atol=1e-6)
    lines = np.floor(marks.lines["a"][:, ::2] / site.ground.patch)
    assert (lines == outlook.patches.cell[row]).all(), "it alone is outlined"


def test_n8_a_patch_with_one_representation_has_no_weight_to_show(outlook: Outlook, site: Site) -> None:
    patches = outlook.patches
    near = patches.cell[patches.visible & (patches.distance < 2)].tolist()
    shown = cells_of(weight_marks(outlook, site), site.ground.patch).tolist()
    assert not [cell for cell in near if cell in shown]
    assert len(weight_marks(outlook, site).lines) == 0
    row = changing(outlook, 0.5)
    settled = cells_of(level_marks(outlook, site, settled=True), site.ground.patch).tolist()
    assert patches.cell[row].tolist() not in settled
    assert all(cell in settled for cell in near)


def test_n8_a_ring_that_is_changing_has_a_shade_between(outlook: Outlook, site: Site) -> None:
    row = int(np.flatnonzero(outlook.patches.visible & (outlook.patches.distance == 1))[0])
    outlook.patches.sublevel[0, row], outlook.patches.sublevel_before[0, row] = 1, 0
    outlook.patches.sublevel_progress[0, row] = 0.25
    near, far = ring_shades(site.representations[BLADES].color, 2)
    np.testing.assert_allclose(patch_colors(outlook, site)[row], near + 0.25 * (far - near), atol=1e-6)
