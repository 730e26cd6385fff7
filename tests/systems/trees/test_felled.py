"""Felled trees of a state, found again among those of a scene (F4)."""

import numpy as np

from tallgrass.systems.trees.felled import found_again

PLACES = np.array([(0.0, 0.0), (3.0, 4.0), (-8.0, 2.0)])


def test_a_tree_is_the_one_that_stands_where_it_stood_whatever_its_number() -> None:
    assert found_again([1, 2], [(3.0, 4.0), (-8.0, 2.0)], PLACES) == [1, 2]
    assert found_again([0, 7], [(-8.0, 2.0), (0.01, 0.0)], PLACES) == [2, 0]
    assert found_again([1, 2], [(3.0, 5.0), (-8.0, 2.0)], PLACES) == [None, 2]
    assert found_again([1], [(3.0, 5.0)], PLACES[:0]) == [None]
