"""Pressers, which tread grass down: people, animals, wheels."""

from collections.abc import Iterable
from dataclasses import dataclass
from reprlib import repr as shortened
from typing import TYPE_CHECKING, ClassVar

from .footprint import Footprint, is_between
from .immutable import immutable


@immutable
@dataclass(frozen=True, slots=True)
class Presser(Footprint):
    """A footprint that presses grass down: the component of a game's own entity, whose `Pose` says where it is.

    It is a disc; with a `length` a capsule; with `corners` a polygon. Grass under it lies down away from it, grass
    next to it bends aside. Raises ValueError for an impossible footprint, and for one that reaches farther than 20 m.
    """

    _largest: ClassVar[float] = 20.0

    strength: float = 1.0
    """Length of the message at its middle, in [0, 1]: 1 lays grass of stiffness 1 flat."""

    wear: float = 0.0
    """Fraction of the grass that it wears off at each passage, in [0, 1]; above 0, at least 1/255. With a few
    hundredths, paths form where many walk. Worn ground stays so until it is sown again."""

    if TYPE_CHECKING:

        def __init__(
            self,
            radius: float = 0.3,
            length: float = 0.0,
            corners: Iterable[Iterable[float]] = (),
            strength: float = 1.0,
            wear: float = 0.0,
        ) -> None:
            """Take what `Footprint` and `__post_init__` make of it."""

    def __post_init__(self) -> None:
        """Raise ValueError for an impossible footprint."""
        Footprint.__post_init__(self)  # a class with slots is made twice, and `super()` means the first one
        if not is_between(0.0, self.strength, 1.0):
            raise ValueError(f"a presser's strength is from 0 to 1, not {shortened(self.strength)}")
        if not is_between(0.0, self.wear, 1.0):
            raise ValueError(f"a presser's wear is from 0 to 1, not {shortened(self.wear)}")
