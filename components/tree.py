"""Trees and bushes of a prairie."""

from dataclasses import dataclass
from reprlib import repr as shortened

from .footprint import is_between
from .immutable import immutable

LOWEST, HIGHEST = 0.5, 60.0
"""Least and greatest height of a tree [m]: none of the habits grows higher."""


@immutable
@dataclass(frozen=True, slots=True)
class Tree:
    """A tree or bush: the component of an entity whose `Pose` says where it stands and how it is turned.

    A scene's trees are entities of the prairie; a game may make more, of any kind in the scene's `trees:`. Delete the
    entity to fell the tree, with its shadow. Raises ValueError for an impossible tree, TypeError for a kind that is not
    a text.
    """

    kind: str
    """Name of its kind in the scene's `trees:`."""

    height: float = 10.0
    """Height, 0.5 to 60 [m]; to let a tree grow, replace the component."""

    foliage: float = 1.0
    """Fraction of its leaves that it has, from 0 to 1; at 0 it is bare."""

    def __post_init__(self) -> None:
        """Raise ValueError or TypeError for an impossible tree."""
        if not isinstance(self.kind, str):
            raise TypeError(f"a tree's kind is a name of the scene's trees, not {shortened(self.kind)}")
        if not is_between(LOWEST, self.height, HIGHEST):
            raise ValueError(f"a tree is {LOWEST:g} to {HIGHEST:g} m high, not {shortened(self.height)}")
        if not is_between(0.0, self.foliage, 1.0):
            raise ValueError(f"a tree's foliage is from 0 to 1, not {shortened(self.foliage)}")
