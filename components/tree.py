"""Trees and bushes of a prairie."""

from dataclasses import dataclass
from reprlib import repr as shortened

from .footprint import is_between

LOWEST, HIGHEST = 0.5, 60.0
"""How high one may be at least and at most [m]: of the sorts that there are, none grows higher."""


@dataclass(frozen=True, slots=True)
class Tree:
    """A tree or bush: the component of an entity whose `Pose` says where it stands and how it is turned.

    A scene's trees are entities of the prairie; a game may make more, of any kind that the scene's `trees:` has. Delete
    the entity to fell it, with its shadow. Raises ValueError for an impossible tree, TypeError for a kind that is not a
    text.
    """

    kind: str
    """Which of the scene's `trees:` it is of."""

    height: float = 10.0
    """How high it stands, 0.5 to 60 [m]: a tree that grows is given another."""

    foliage: float = 1.0
    """How many of its leaves it has, from 0 to 1; without any, it is bare."""

    def __post_init__(self) -> None:
        """Raise ValueError and TypeError for what is no tree."""
        if not isinstance(self.kind, str):
            raise TypeError(f"a tree's kind is a name of the scene's trees, not {shortened(self.kind)}")
        if not is_between(LOWEST, self.height, HIGHEST):
            raise ValueError(f"a tree is {LOWEST:g} to {HIGHEST:g} m high, not {shortened(self.height)}")
        if not is_between(0.0, self.foliage, 1.0):
            raise ValueError(f"a tree's foliage is from 0 to 1, not {shortened(self.foliage)}")
