"""Felled trees of a saved state: by number and place, so that another scene finds them."""

from collections.abc import Sequence

import numpy as np

from ...components.arrays import Doubles, Place

SAME = 0.05
"""Distance within which two trees are the same one [m]: another processor or release may place it differently, and no
two trees are so close."""


def found_again(numbers: Sequence[int], stood: Sequence[Place], places: Doubles, /) -> list[int | None]:
    """Return the indices of the felled trees among `places` (n, 2) [m], None for one that is not among them.

    `numbers` are their indices when felled, and `stood` their places.
    """
    return [_found(number, place, places) for number, place in zip(numbers, stood, strict=True)]


def _found(number: int, place: Place, places: Doubles) -> int | None:
    if 0 <= number < len(places) and np.abs(places[number] - place).max() <= SAME:
        return number
    there = np.flatnonzero(np.abs(places - place).max(axis=1) <= SAME)
    return int(there[0]) if len(there) else None
