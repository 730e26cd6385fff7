"""Which of a tree's wood is drawn in which pass."""

import numpy as np
import pytest

from tallgrass.systems.trees.wood import parts

RADII = np.array([0.1, 0.3, 0.5, 0.7, 0.9, 1.5])
"""Of stems, thinnest first, where one of 1 is as wide as a pixel."""


@pytest.mark.parametrize(("foliage", "soft"), [(1.0, 4), (0.5, 6)])
def test_a_stem_thinner_than_a_pixel_is_drawn_in_part_and_among_leaves_the_thinnest_not_at_all(
    foliage: float, soft: int
) -> None:
    drawn = parts(RADII, RADII, 1.0, foliage)
    assert drawn.solid == 2  # those that cover nearly all of a pixel
    assert drawn.soft == soft
