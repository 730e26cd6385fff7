"""Checking and converting what a game hands in."""

from collections.abc import Callable, Iterable
from reprlib import repr as shortened

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Doubles
from ..components.pose import Pose

NUMBER_TYPES = (float, int, np.floating, np.integer)
"""Types that are accepted as a number."""

_PLAIN = frozenset({float, np.float64, np.float32})

FARTHEST = 1e6
"""Largest coordinate of a place [m]: beyond it, numbers of cells and squares would overflow."""

SOMEWHERE = f"x, y, z [m] and yaw [rad] are finite numbers, at most {FARTHEST:.0e} either way"
"""Message on poses that are no place."""

MOST_SEED = 2**31 - 1
"""The largest seed of a scene."""

LONGEST = 1e9
"""Longest step and latest time that are accepted [s]: beyond, time is not exact to the microsecond."""


def as_floats(thing: object, due: str, /, *, holes: bool = False) -> NDArray[np.float32]:
    """Return a thing of any shape as an array of numbers.

    Raises ValueError for anything else, and for NaN and infinity; with `holes`, NaN is allowed. `due` begins the
    message and says what the thing has to be.
    """
    try:
        array = thing if type(thing) is np.ndarray and thing.dtype == np.float32 else _as_singles(thing)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{due}, not {shortened(thing)}") from None
    bad = np.isinf(array) if holes else ~np.isfinite(array)
    if thing is None or bad.any():
        raise ValueError(f"{due}, not {'None' if thing is None else _unfit(thing, holes=holes)}")
    return array


def _unfit(thing: object, *, holes: bool) -> str:
    """Return the words for numbers that are not finite in single precision."""
    wide = np.asarray(thing, np.float64)
    if not (np.isinf(wide) if holes else ~np.isfinite(wide)).any():
        return f"numbers as large as {np.nanmax(np.abs(wide)):.3g}"
    return "infinity" if holes else "NaN or infinity"


def _as_singles(thing: object) -> NDArray[np.float32]:
    if isinstance(thing, np.ndarray) and np.iscomplexobj(thing):
        raise TypeError("complex numbers are no places")
    with np.errstate(over="ignore"):  # a number too large for single precision is refused as infinite
        return np.asarray(thing, np.float32)


def as_rays(origin: object, direction: object, /) -> tuple[Doubles, Doubles]:
    """Return origins and directions of rays, each (n, 3); a single one is repeated for all of the other.

    Raises ValueError for anything else, and for a direction of length 0.
    """
    due = "rays have an origin and a direction (x, y, z), one of each in a row"
    each = []
    for thing in (origin, direction):
        shape = as_floats(thing, due).shape
        if shape[-1:] != (3,) and shape != (0,):
            raise ValueError(f"{due}, not an array of shape {shape}")
        each.append(np.asarray(thing, np.float64).reshape(-1, 3))
    if len(each[0]) != len(each[1]) and 1 not in (len(each[0]), len(each[1])):
        raise ValueError(f"{due}, not {len(each[0])} and {len(each[1])} of them")
    if not np.abs(each[1]).max(axis=1, initial=0.0).all():
        raise ValueError(f"{due}, and a direction has a length above 0")
    start, way = each if len(each[0]) == len(each[1]) else np.broadcast_arrays(*each)
    return start, way


def as_camera(camera: object, /) -> Callable[[], tuple[object, object]]:
    """Return the camera of a group as a function that returns the view and the projection matrix.

    Raises TypeError for anything but a function. The returned function raises it if the camera returns anything else.
    """
    if not callable(camera):
        raise TypeError(f"the camera of a group is a function that returns two matrices, not {shortened(camera)}")

    def ask() -> tuple[object, object]:
        told = camera()
        try:
            view, projection = told
        except (TypeError, ValueError):
            due = "the camera of a group returns the view and the projection matrix"
            raise TypeError(f"{due}, not {shortened(told)}") from None
        return view, projection

    return ask


def is_somewhere(pose: Pose, /) -> bool:
    """Return whether a game's pose has numbers within `FARTHEST` for its position and yaw."""
    numbers = (pose.x, pose.z, pose.yaw, 0.0 if pose.y is None else pose.y)
    return all(isinstance(n, NUMBER_TYPES) and -FARTHEST <= n <= FARTHEST for n in numbers)


def as_places_of(poses: Iterable[Pose], /) -> Doubles | None:
    """Return the poses' (x, z, yaw), shape (n, 3); None where `is_somewhere` might not hold for one of them."""
    numbers = [number for pose in poses for number in (pose.x, pose.z, pose.yaw)]
    if not _PLAIN.issuperset(map(type, numbers)):
        return None
    rows = np.array(numbers, np.float64).reshape(-1, 3)
    return rows if (np.abs(rows) <= FARTHEST).all() else None


def must_be_a(due: type, thing: object, what: str, /) -> None:
    """Raise TypeError for a thing that is no instance of `due`; `what` begins the message."""
    if not isinstance(thing, due):
        raise TypeError(f"{what}, unlike {shortened(thing)}")


def must_be_flags(**flags: object) -> None:
    """Raise TypeError for a flag that is no bool."""
    for name, flag in flags.items():
        if not isinstance(flag, bool | np.bool_):
            raise TypeError(f"{name} is True or False, not {shortened(flag)}")


def must_be_viewer(thing: object, /) -> None:
    """Raise TypeError for a viewer's name that is no text."""
    if not isinstance(thing, str):
        raise TypeError(f"a viewer's name is a text such as 'main', not {shortened(thing)}")


def must_be_seed(thing: object, /) -> None:
    """Raise ValueError for a thing that is no valid seed of a scene."""
    if not isinstance(thing, int) or not 0 <= thing <= MOST_SEED:
        raise ValueError(f"a seed is a whole number from 0 to {MOST_SEED}, not {shortened(thing)}")


def must_be_known(what: str, name: str | None, known: Iterable[str], /) -> None:
    """Raise ValueError for a name of a `what` that is not `known`; None is accepted."""
    there = tuple(known)
    if name is not None and name not in there:
        raise ValueError(f"unknown {what} '{name}'; there are {', '.join(there)}")


def to_microseconds(time: float, /) -> float:
    """Return a time to the nearest microsecond [s]: so it does not depend on the steps that it is a sum of."""
    return round(time, 6)


def must_be_seconds(thing: object, what: str, at: str, /) -> None:
    """Raise TypeError for a time that is no number, ValueError for one out of range; `what` begins the message."""
    if not isinstance(thing, NUMBER_TYPES):
        raise TypeError(f"{what} {at} a number of seconds, not {at} {shortened(thing)}")
    if not 0.0 <= thing <= LONGEST:
        raise ValueError(f"{what} {at} 0 s to {LONGEST:g} s, not {at} {thing}")
