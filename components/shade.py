"""What casts a shadow on the grass."""

from dataclasses import dataclass
from math import hypot
from sys import float_info

from .footprint import is_between

_LARGEST = float_info.max


@dataclass(frozen=True, slots=True)
class Shade:
    """Something that stands between the sun and the grass: the component of a game's own entity.

    It is taken as a ball; with a `height`, as one stretched or pressed flat along `up`: a disc, an egg, a trunk. The
    farther its shadow falls, the softer is its edge. A prairie in the same world draws it; of many, those eight count
    that are nearest to the eye. Raises ValueError for a place that is nowhere, for an `up` that leads nowhere, and for
    a radius or height that is no length.
    """

    place: tuple[float, float, float]
    """Where its middle is (x, y, z) [m]."""

    radius: float
    """How large it is about `up`, above 0 [m]."""

    height: float | None = None
    """How high it is from end to end along `up`, above 0 [m]; without it, twice the radius, which is a ball."""

    up: tuple[float, float, float] = (0.0, 1.0, 0.0)
    """The direction of the axis that it is round about; its length does not count."""

    def __post_init__(self) -> None:
        """Raise ValueError for what cannot cast a shadow."""
        if not _is_place(self.place):
            raise ValueError(f"a shade's place is three finite numbers (x, y, z), not {self.place!r}")
        if not _is_length(self.radius):
            raise ValueError(f"a shade's radius is above 0 m, not {self.radius!r}")
        if self.height is not None and not _is_length(self.height):
            raise ValueError(f"a shade's height is above 0 m, not {self.height!r}")
        if not _is_place(self.up) or hypot(*self.up) < 1e-6:
            raise ValueError(f"a shade's up is a direction (x, y, z), not {self.up!r}")


def _is_place(thing: object) -> bool:
    try:
        numbers: tuple[object, ...] = tuple(thing)  # type: ignore[arg-type]
    except TypeError:
        return False
    return len(numbers) == 3 and all(is_between(-_LARGEST, number, _LARGEST) for number in numbers)


def _is_length(thing: object) -> bool:
    return is_between(0.0, thing, _LARGEST) and thing != 0.0
