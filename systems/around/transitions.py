"""Transitions: means that hide a change of representation."""

from dataclasses import dataclass

SLACK = 1
"""Width of the hysteresis [patches]: a patch goes to the coarser representation farther out than it comes back."""


@dataclass(frozen=True, slots=True)
class Transitions:
    """Means that hide a change of representation (paper, section 4).

    All are on; each can be switched off to measure its worth. Without morph, fade and growth, patches switch at once.
    """

    morph: bool = True
    """Whether blades move between their own places and their painted places (paper, section 4.2)."""

    fade: bool = True
    """Whether representations cross-fade."""

    growth: bool = True
    """Whether strips grow out of the ground where the carpet gives way to them (paper, section 4.3)."""

    hysteresis: bool = True
    """Whether a patch changes to the coarser representation farther out than back (paper, section 4.1)."""

    @property
    def gradual(self) -> bool:
        """Whether a change takes any time."""
        return self.morph or self.fade or self.growth


SEAMLESS = Transitions()
"""All means on."""
