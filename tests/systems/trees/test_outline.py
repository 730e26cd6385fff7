"""What is drawn of trees no farther than they go: corners about their pictures, and trees beside a picture (F3)."""

import numpy as np
import pytest

from tallgrass.components.arrays import Bytes, Doubles
from tallgrass.engine.camera import View, projection_matrix, view_matrix
from tallgrass.systems.space.frustum import picture_sides
from tallgrass.systems.trees.bounds import outside_picture
from tallgrass.systems.trees.choice import Choice
from tallgrass.systems.trees.model import Model, models_of
from tallgrass.systems.trees.outline import BOX, CORNERS, MARGIN, TRIANGLE, Outline, card_outline, picture_outline
from tallgrass.systems.trees.standing import STANDING, Standing
from tallgrass.testing import looking

SIDE, SLIM, ASPECT = 96, 80, 16.0 / 9.0


def crowns(aside: Doubles) -> Bytes:
    """Return slender pictures of round crowns so far from the middle, the one larger than the other [texels]."""
    up, across = np.mgrid[0:SIDE, 0:SLIM] - 0.5 * np.array([SIDE, SLIM])[:, None, None]
    wide = 20.0 + 0.3 * np.abs(aside)[:, None, None]
    covered = ((across - aside[:, None, None]) / wide) ** 2 + (up / 36.0) ** 2 < 1.0
    return np.where(covered, 255, 0).astype(np.uint8)


def spans(corners: Outline, picture: int) -> tuple[Doubles, Doubles]:
    """Return from where to where its corners' lines go in each row of texels."""
    high, rows = 0.5 * SIDE * (np.array(corners.high) + 1.0), np.arange(SIDE) + 0.5
    left, right = (0.5 * SIDE * np.interp(rows, high, corners.reaches[2 * picture + side]) for side in (0, 1))
    return 0.5 * SLIM - left, 0.5 * SLIM + right


def test_all_that_a_picture_of_a_tree_covers_lies_within_its_corners_and_little_else() -> None:
    pictures = crowns(np.array([-12.0, 0.0, 9.0]))
    corners = picture_outline(pictures)
    assert len(corners.reaches) == 2 * len(pictures)
    for number, picture in enumerate(pictures > 0):
        left, right = spans(corners, number)
        texels = np.arange(SLIM)
        within = (texels >= left[:, None] - 1e-6) & (texels + 1.0 <= right[:, None] + 1e-6)
        assert not (picture & ~within).any()
        assert picture.sum() > 0.66 * (right - left)[picture.any(axis=1)].sum()


def test_about_a_picture_that_covers_nothing_the_whole_of_it_is_drawn() -> None:
    empty = picture_outline(np.zeros((2, SIDE, SLIM), np.uint8))
    assert (empty.high[0], empty.high[-1]) == (-1.0, 1.0)
    assert empty.reaches == [(SLIM / SIDE,) * CORNERS] * 4


@pytest.mark.parametrize(("corners", "most"), [(4, 4.4), (TRIANGLE, 5.6)])  # at least 4 and 5.2, of an ellipse
@pytest.mark.parametrize("askew", [0.0, 0.3])
def test_all_that_the_picture_of_a_twig_covers_lies_within_its_corners_and_little_else(
    askew: float, corners: int, most: float
) -> None:
    up, across = np.mgrid[0:SIDE, 0:SIDE] + 0.5 - 0.5 * SIDE
    covered = ((across + askew * up) / 14.0) ** 2 + (up / 40.0) ** 2 < 1.0
    one, two, *rest = card_outline(covered, MARGIN, corners=corners)
    around = np.array([one, two, *rest[::-1]]) * (0.5 * SIDE, SIDE) + np.array([0.5 * SIDE, 0.0])
    assert len(around) == corners
    rows, columns = np.nonzero(covered)
    for first, second in zip(around, np.roll(around, -1, axis=0), strict=True):
        inwards = np.array([first[1] - second[1], second[0] - first[0]]) / np.linalg.norm(second - first)
        assert ((np.stack([columns, rows], axis=1) + 0.5 - first) @ inwards).min() > MARGIN
    x, y = around.T
    assert 0.5 * (x * np.roll(y, -1) - np.roll(x, -1) * y).sum() < most * (14.0 + MARGIN) * (40.0 + MARGIN)
    assert np.array_equal(card_outline(np.zeros_like(covered), MARGIN, corners=len(BOX)), BOX)


@pytest.fixture(scope="module")
def poplar() -> Model:
    return models_of("poplar", 5)[0]


@pytest.mark.parametrize("off", [20.0, 60.0])
def test_a_slender_tree_is_in_a_picture_as_soon_as_its_crown_is_and_no_sooner(poplar: Model, off: float) -> None:
    camera = looking(0.0, 10.0, off, pitch=0.0, view=60.0)
    sides = picture_sides(View(view_matrix(camera), projection_matrix(camera.view, ASPECT)))
    rows = np.zeros(200, STANDING)
    rows["root"][:, 0], rows["height"] = np.linspace(0.0, 2.5 * off, len(rows)), poplar.height
    seen = outside_picture(Choice(Standing(rows), [poplar], [0.0]).extents, sides) <= 0.0
    edge = off * np.tan(np.radians(30.0)) * ASPECT
    x, crown = rows["root"][:, 0], poplar.radius / np.cos(np.arctan(edge / off))
    assert seen[x < edge + crown].all()
    assert not seen[x > edge + 1.3 * crown].any()
