"""Which of a tree's wood is drawn in which pass."""

import numpy as np
import pytest

from tallgrass.systems.trees.wood import parts

RADII = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 1.5, 2.5])
"""Of stems, thinnest first, where one of 1 is as wide as a pixel."""


@pytest.mark.parametrize(("foliage", "drawn"), [(1.0, (4, 1)), (0.5, (3, 7))])
def test_stems_thinner_than_a_pixel_are_drawn_in_part_and_among_leaves_wholly_or_not_at_all(
    foliage: float, drawn: tuple[int, int]
) -> None:
    """Those that cover nearly all of a pixel are solid; among leaves, only what is broader has soft edges."""
    assert parts(RADII, 1.0, foliage) == drawn
