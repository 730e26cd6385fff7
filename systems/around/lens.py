"""Lenses: reach of each representation at a viewer's angle of view."""

from dataclasses import dataclass
from math import radians, tan

from ...engine.camera import View

USUAL = 1.0 / tan(radians(22.5))
"""Focal length that rings are made for, in half heights of the picture: its angle of view is 45 degrees."""

LONG = 1.275
"""Zoom from which on a lens is long, below 36 degrees: it extends the reach of representations, not only of rings."""

CATCH_UP = 2.0
"""Growth of the reach with the zoom beyond `LONG`, until both have grown alike."""


def reach_under(reach: tuple[int, ...], lens: float, /) -> tuple[float, ...]:
    """Return the reach of each representation, from the finest, under a lens that magnifies `lens` times.

    Each reach is multiplied by `lens`, but never exceeds the next coarser one's reach without a lens. A representation
    that has no range of its own ends where the finer one does.
    """
    far: list[float] = []
    for number, limit in enumerate(reach[:-1]):
        has_range = limit >= 0 and (number == 0 or limit > reach[number - 1])
        far.append(min(limit * lens, max(limit, reach[number + 1])) if has_range else far[-1] if number else limit)
    return (*far, reach[-1])


def zoom_of(view: View, /) -> float:
    """Return the magnification relative to an angle of view of 45 degrees, 1 at least."""
    perspective, focal_length = view.projection[3, 3] == 0.0, abs(float(view.projection[1, 1]))
    return max(focal_length / USUAL, 1.0) if perspective else 1.0


@dataclass(slots=True)
class Lens:
    """Scale of the reaches of a viewer's representations, by its angle of view and by the governor."""

    zoom: float = 1.0
    """Magnification relative to an angle of view of 45 degrees, 1 at least."""

    range: float = 1.0
    """Part of all distances that the governor leaves."""

    reach: tuple[int, ...] = ()
    """Largest discrete distance at which each representation is due without a lens."""

    room: tuple[int, ...] = ()
    """Largest discrete distance at which each representation may be due, as its pools have slots for that."""

    @property
    def factor(self) -> float:
        """Factor on the reach of representations, 1 at least; of a long lens it is `zoom`."""
        return max(min(self.zoom, 1.0 + CATCH_UP * (self.zoom - LONG)), 1.0)

    def reach_in(self, reach: tuple[int, ...], /) -> tuple[float, ...]:
        """Return the reach of each representation, with `range` and a long lens applied."""
        if self.factor == 1.0:
            return self.drawn_in(reach)
        far = zip(reach_under(reach, self.factor), self.room, strict=True)
        return tuple(min(limit, room) * self.range if limit > 0 else limit for limit, room in far)

    def drawn_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return limits of distance with `range` applied."""
        return limits if self.range == 1.0 else tuple(limit * self.range if limit > 0 else limit for limit in limits)

    def rings_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return the outer limits of rings, with `range` and `zoom` applied."""
        return tuple(limit * self.zoom for limit in self.drawn_in(limits))
