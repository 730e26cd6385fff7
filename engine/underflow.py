"""Allowing underflow to zero, even where a host has made numpy raise for it."""

from types import FunctionType

import numpy as np


class Underflowing:
    """A base class whose subclasses ignore floating-point underflow in their public methods.

    A host's other settings of numpy's errors stay in force.
    """

    def __init_subclass__(cls) -> None:
        """Wrap the subclass's own public methods."""
        super().__init_subclass__()
        for name, member in [*vars(cls).items()]:
            if name == "__init__" or not name.startswith("_"):
                setattr(cls, name, _wrapped(member))


def _wrapped(member: object) -> object:
    if isinstance(member, FunctionType):
        return np.errstate(under="ignore")(member)
    if isinstance(member, property):
        accessors = (member.fget, member.fset, member.fdel)
        return property(*(accessor and _wrapped(accessor) for accessor in accessors))  # type: ignore[arg-type]
    return member
