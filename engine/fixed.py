"""Refusing attributes that an object does not have: a misspelt one would be set, and nothing would come of it."""

from typing import TYPE_CHECKING

from ..components.words import guess


class Fixed:
    """A base class whose objects take no attributes of new names once they are made.

    Objects of other subclasses than the one that calls `_fix` may take any.
    """

    _is_fixed = False

    def _fix(self, kind: type, /) -> None:
        """Take no new names from now on, if this is an object of `kind` itself: the end of its `__init__`."""
        self._is_fixed = type(self) is kind

    if not TYPE_CHECKING:  # with it, type checkers would take any name

        def __setattr__(self, name: str, value: object) -> None:
            """Set an attribute; raises AttributeError with a sentence for a new name."""
            if self._is_fixed and name not in self.__dict__ and not hasattr(type(self), name):
                own = [each for each in dir(self) if not each.startswith("_")]
                inner = [each for each in own if each in vars(self) and hasattr(type(vars(self)[each]), name)]
                hint = f", did you mean '{inner[0]}.{name}'?" if inner else guess(name, own)
                raise AttributeError(f"'{name}' of a {type(self).__name__} cannot be set, as it has none{hint}")
            object.__setattr__(self, name, value)  # calls less than super, in every frame
