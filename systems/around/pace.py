"""How fast time goes for a viewer: where it stands still, what is on its way settles by the frame."""

from dataclasses import dataclass

from ...components.viewer import Viewer

IDLE = 0.055
"""How long a frame counts where time idles [s]: two changes, one after the other, are over within 60 frames."""

LATELY, USUALLY = 8.0, 600.0
"""Over how many frames the time between them is averaged: it is that of now, and what a viewer is used to."""

SLOW = 4.0
"""How many times slower than usual time goes where it idles. One that draws an instant a few times is not taken for it,
nor one whose time moves on in fewer frames than it draws."""

LONGEST = 0.1
"""The longest that a frame counts in these averages [s]."""

ASSUMED = 1.0 / 60.0
"""What a viewer is used to before it has looked [s]."""


@dataclass(slots=True)
class Pace:
    """How long lie between a viewer's frames. No clock is read: slow motion is known by what was usual before it."""

    lately: float = ASSUMED
    usually: float = ASSUMED

    def idles(self, dt: float, /) -> bool:
        """Return whether time stands still or goes in slow motion, now that another `dt` [s] has passed."""
        dt = min(max(dt, 0.0), LONGEST)
        self.lately += (dt - self.lately) / LATELY
        idles = SLOW * self.lately <= self.usually
        if dt or not idles:  # nobody gets used to a pause
            self.usually += (dt - self.usually) / USUALLY
        return idles


def counted(viewer: Viewer, /) -> float:
    """Return for how long changes go on in a viewer's frame [s]."""
    return max(viewer.dt, IDLE) if viewer.idles else viewer.dt
