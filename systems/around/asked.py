"""Parts of a frame that a game asks to be drawn."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from ...engine.camera import View
from ...engine.declared.parts import PARTS, PartName
from ..space.grown import Grown

ONCE = frozenset[PartName]({"sky", "ground", "grass"})
"""Parts that are drawn at most once in a frame: asking for one of them again begins the next frame."""


@dataclass(frozen=True, slots=True)
class Asked:
    """Parts to draw in one call, and how."""

    parts: frozenset[PartName] = frozenset(PARTS)

    is_deep: bool = False
    """Whether all grass writes depth, where it covers at least half a pixel."""

    is_alone: bool = False
    """Whether nothing else reads or writes the picture's depth, before this call or after it."""

    on_own_ground: bool = True
    """Whether the ground under the grass was drawn in this frame; otherwise it is the game's."""

    @property
    def over_hosts(self) -> bool:
        """Whether grass is blended over ground that the game has drawn, by its coverage."""
        return "grass" in self.parts and not self.on_own_ground


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A viewer's frame, of which some parts have been drawn."""

    seen: View
    """The game's matrices, before clip space is converted to OpenGL's usual one."""

    time: float
    """The prairie's time [s]."""

    grown: Grown
    parts: frozenset[PartName] = frozenset()
    """Parts that have been drawn."""

    def goes_on(self, later: Self, /) -> bool:
        """Return whether the parts of `later` belong to this same frame."""
        if self.grown is not later.grown or self.time != later.time or not ONCE & later.parts:
            return False
        is_same = (
            np.array_equal(before, now)
            for before, now in (
                (self.seen.view, later.seen.view), (self.seen.projection, later.seen.projection),
            )
        )  # fmt: skip
        return not ONCE & self.parts & later.parts and all(is_same)

    def after(self, before: Self | None, /, *, depth: str) -> "tuple[Frame, Asked, bool]":
        """Return the frame once these parts are drawn, what to draw for that, and whether it goes on from `before`."""
        is_next = before is None or not before.goes_on(self)
        drawn = self.parts if is_next or before is None else before.parts | self.parts
        asked = Asked(self.parts, is_deep=depth == "all", is_alone=depth == "none", on_own_ground="ground" in drawn)
        return replace(self, parts=drawn), asked, not is_next
