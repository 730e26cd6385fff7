"""What a game asks to be drawn of a viewer's frame."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ...engine.camera import View
from ...engine.declared.parts import PARTS, PartName
from ..space.grown import Grown

ONCE = frozenset[PartName]({"sky", "ground", "grass"})
"""The parts that a frame has once: who asks for one of them again begins the next frame."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What is drawn at a time."""

    parts: frozenset[PartName] = frozenset(PARTS)

    is_deep: bool = False
    """Whether all grass writes depth, where it covers at least half a pixel."""

    is_alone: bool = False
    """Whether nothing else has depth in the picture, before it or after it."""

    on_ours: bool = True
    """Whether what the grass stands on has been drawn here, and is not the game's own."""

    @property
    def over_hosts(self) -> bool:
        """Whether grass is laid over ground that the game has drawn, by how much of that it covers."""
        return "grass" in self.parts and not self.on_ours


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A viewer's frame as far as it has been drawn."""

    seen: View
    """Before clip space was turned the usual way."""

    time: float
    grown: Grown
    parts: frozenset[PartName] = frozenset()
    """Those that have been drawn."""

    def goes_on(self, next_one: Self, /) -> bool:
        """Return whether more parts of the same frame are asked for."""
        if self.grown is not next_one.grown or self.time != next_one.time or not ONCE & next_one.parts:
            return False
        is_same = (
            np.array_equal(one, other)
            for one, other in (
                (self.seen.view, next_one.seen.view), (self.seen.projection, next_one.seen.projection),
            )
        )  # fmt: skip
        return not ONCE & self.parts & next_one.parts and all(is_same)

    def after(self, before: Self | None, /, *, depth: str) -> "tuple[Frame, Asked, bool]":
        """Return the frame as it is once this much is drawn, what that is, and whether it goes on from `before`."""
        is_next = before is None or not before.goes_on(self)
        drawn = self.parts if is_next or before is None else before.parts | self.parts
        asked = Asked(self.parts, depth == "all", depth == "none", "ground" in drawn)
        return replace(self, parts=drawn), asked, not is_next
