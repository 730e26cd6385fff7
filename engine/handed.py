"""Numbers that a game hands in, made into arrays."""

from reprlib import repr as shortened

import numpy as np
from numpy.typing import NDArray


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
