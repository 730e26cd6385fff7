"""Which trees are felled, as a state holds it: by number and by where each stood, so that another scene finds them."""

from collections.abc import Sequence

import numpy as np

from ...components.arrays import Doubles

SAME = 0.05
"""How far off a tree may stand that another processor or release has placed [m]: no two are so close."""

Place = tuple[float, float]
"""Where a tree stands, (x, z) [m]."""


def found_again(numbers: Sequence[int], stood: Sequence[Place] | None, places: Doubles, /) -> list[int]:
    """Return which of the trees at `places` (n, 2) [m] those are that had these numbers, and stood there.

    Raises ValueError where none is.
    """
    if stood is None:
        if not all(0 <= number < len(places) for number in numbers):
            raise ValueError("there are fewer trees in this scene than it has felled")
        return list(numbers)
    return [_found(number, place, places) for number, place in zip(numbers, stood, strict=True)]


def _found(number: int, place: Place, places: Doubles) -> int:
    if 0 <= number < len(places) and np.abs(places[number] - place).max() <= SAME:
        return number
    there = np.flatnonzero(np.abs(places - place).max(axis=1) <= SAME)
    if not len(there):
        raise ValueError("a tree is felled in it at ({:.6g}, {:.6g}), where none of this scene's stands".format(*place))
    return int(there[0])
