"""What a game hands in: numbers made into arrays, and what is refused."""

from reprlib import repr as shortened

import numpy as np
from numpy.typing import NDArray

NUMBERS = (float, int, np.floating, np.integer)
"""What is taken for a number where one is handed in."""


def as_floats(thing: object, due: str, /) -> NDArray[np.float32]:
    """Return what is handed in as numbers, of any shape.

    Raises ValueError where it is nothing of the kind, or not finite. `due` begins the sentence: what it has to be.
    """
    try:
        array = np.asarray(thing, np.float32)
    except (TypeError, ValueError):
        raise ValueError(f"{due}, not {shortened(thing)}") from None
    if thing is None or not np.isfinite(array).all():
        raise ValueError(f"{due}, not {'None' if thing is None else 'NaN or infinity'}")
    return array


def must_be_viewer(thing: object, /) -> None:
    """Raise TypeError for what is no viewer's name."""
    if not isinstance(thing, str):
        raise TypeError(f"a viewer is called by a text such as 'main', not by {shortened(thing)}")


def must_be_step(thing: object, /) -> None:
    """Raise TypeError for what is no number, ValueError for one that time cannot move on by."""
    if not isinstance(thing, NUMBERS):
        raise TypeError(f"a prairie advances by a number of seconds, not by {shortened(thing)}")
    if not (np.isfinite(thing) and thing >= 0.0):
        raise ValueError(f"a prairie advances by 0 s or more, not by {thing}")
