"""Numbers that end in zero, as what falls off does: that is no error, whatever a host has told numpy."""

from types import FunctionType

import numpy as np


class Underflowing:
    """A class whose public methods, and those of classes made from it, let numbers end in zero.

    Nothing else of what a host may have told numpy to raise happens in them.
    """

    def __init_subclass__(cls) -> None:
        """Let those that the class brings do so."""
        super().__init_subclass__()
        for name, each in [*vars(cls).items()]:
            if name == "__init__" or not name.startswith("_"):
                setattr(cls, name, _let(each))


def _let(each: object) -> object:
    if isinstance(each, FunctionType):
        return np.errstate(under="ignore")(each)
    if isinstance(each, property):
        return property(*(one and _let(one) for one in (each.fget, each.fset, each.fdel)))  # type: ignore[arg-type]
    return each
