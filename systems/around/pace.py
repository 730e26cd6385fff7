"""Pace of a viewer's time: where it stands still, changes of level of detail proceed by the frame instead."""

from dataclasses import dataclass

from ...components.viewer import Viewer

IDLE = 0.055
"""Time step of a frame while time idles [s]: two changes, one after the other, are over within 60 frames."""

SHORT_TERM, LONG_TERM = 8.0, 600.0
"""Time constants of the two moving averages of the time step [frames]."""

SLOW = 4.0
"""Ratio of the long-term to the short-term average from which on time idles. A viewer that draws an instant a few times
stays below it, as does one whose time moves on in fewer frames than it draws."""

LONGEST = 0.1
"""Limit of a time step in these averages [s]."""

ASSUMED = 1.0 / 60.0
"""Both averages before the first frame [s]."""


@dataclass(slots=True)
class Pace:
    """Moving averages of the time between a viewer's frames. No clock is read: slow motion shows in their ratio."""

    short_term: float = ASSUMED
    long_term: float = ASSUMED

    def idles(self, dt: float, /) -> bool:
        """Average the time step `dt` [s] of a new frame; return whether time stands still or goes in slow motion."""
        dt = min(max(dt, 0.0), LONGEST)
        self.short_term += (dt - self.short_term) / SHORT_TERM
        idles = SLOW * self.short_term <= self.long_term
        if dt or not idles:  # pauses do not count as usual
            self.long_term += (dt - self.long_term) / LONG_TERM
        return idles


def change_step(viewer: Viewer, /) -> float:
    """Return the time step of changes of level of detail in a viewer's frame [s]."""
    return max(viewer.dt, IDLE) if viewer.idles else viewer.dt
