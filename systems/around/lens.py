"""Lenses: how far a viewer sees each representation."""

from dataclasses import dataclass
from math import radians, tan

from ...engine.camera import View

USUAL = 1.0 / tan(radians(22.5))
"""What a projection stretches heights by where the picture is 45 degrees high: rings are made for it."""

LONG = 1.275
"""The zoom from which on a lens is long, below 36 degrees: it brings representations near, and not just their rings."""

LONGER = 2.0
"""How much faster than the zoom their reach grows from there on, until it has grown as much."""


def brought_near(reach: tuple[int, ...], lens: float, /) -> tuple[float, ...]:
    """Return the reach of each representation, from the finest, under a lens that shows things `lens` times larger.

    Each reach is multiplied by `lens`, but goes no farther than the next coarser one's does without a lens. A
    representation that has no range of its own ends where the finer one does.
    """
    near: list[float] = []
    for number, limit in enumerate(reach[:-1]):
        own = limit >= 0 and (number == 0 or limit > reach[number - 1])
        near.append(min(limit * lens, max(limit, reach[number + 1])) if own else near[-1] if number else limit)
    return (*near, reach[-1])


def zoom_of(view: View, /) -> float:
    """Return how many times larger things are seen than where the picture is 45 degrees high, 1 at least."""
    perspective, tall = view.projection[3, 3] == 0.0, abs(float(view.projection[1, 1]))
    return max(tall / USUAL, 1.0) if perspective else 1.0


@dataclass(slots=True)
class Lens:
    """How far a viewer sees each representation."""

    zoom: float = 1.0
    """How many times larger things are seen than where the picture is 45 degrees high, 1 at least."""

    range: float = 1.0
    """Part of the distances up to which representations are due."""

    reach: tuple[int, ...] = ()
    """Largest discrete distance at which each representation is due without a lens."""

    room: tuple[int, ...] = ()
    """Largest discrete distance at which there is room for each to be due."""

    @property
    def factor(self) -> float:
        """How many times as far representations are due as without it, 1 at least; with a long one it is `zoom`."""
        return max(min(self.zoom, 1.0 + LONGER * (self.zoom - LONG)), 1.0)

    def reach_in(self, reach: tuple[int, ...], /) -> tuple[float, ...]:
        """Return up to where representations are due, as near as they are now and as far as a long lens brings them."""
        if self.factor == 1.0 or not self.room:
            return self.drawn_in(reach)
        far = zip(brought_near(reach, self.factor), self.room, strict=True)
        return tuple(min(limit, room) * self.range if limit > 0 else limit for limit, room in far)

    def drawn_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return distances up to which something is due, as near as they are now."""
        return limits if self.range == 1.0 else tuple(limit * self.range if limit > 0 else limit for limit in limits)

    def rings_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return distances up to which rings are due, as near as they are now and as far as the lens brings them."""
        return tuple(limit * self.zoom for limit in self.drawn_in(limits))
