"""What has been made for a viewer already need not be made again, whoever has looked meanwhile."""

from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

Made = TypeVar("Made")

MOST_VIEWERS = 4
"""Viewers for whom anything is remembered: those that looked last."""


class Remembered(Generic[Made]):
    """What was last made for each viewer, and what it was made of."""

    def __init__(self) -> None:
        self._made: dict[str, tuple[object, Made]] = {}

    def of(self, viewer: str, made_of: tuple[object, ...] | None, make: Callable[[], Made], /) -> Made:
        """Return what `make` makes for a viewer.

        It is not made again if it was made of the same: of arrays of the same bytes, and of other things that are
        equal. With None it is always made.
        """
        now = made_of and [part.tobytes() if type(part) is np.ndarray else part for part in made_of]
        found = self._made.pop(viewer, None)
        if found is None or now is None or now != found[0]:
            found = now, make()
        self._made[viewer] = found
        if len(self._made) > MOST_VIEWERS:
            del self._made[next(iter(self._made))]
        return found[1]
