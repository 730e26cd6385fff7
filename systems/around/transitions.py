"""Transitions: how a change of representation is made not to be seen."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Transitions:
    """What carries a patch from one representation to another (paper, section 4).

    All of it is on; to measure what each part is worth, it can be left out. Without morph, fade and growth, patches
    switch at once.
    """

    morph: bool = True
    """Whether blades move between their own places and their painted places (paper, section 4.2)."""

    fade: bool = True
    """Whether one representation fades while the other appears."""

    growth: bool = True
    """Whether strips grow out of the ground where the carpet gives way to them (paper, section 4.3)."""

    hysteresis: bool = True
    """Whether a patch goes to the coarser representation later than it comes back from it (paper, section 4.1)."""

    @property
    def gradual(self) -> bool:
        """Whether a change takes any time at all."""
        return self.morph or self.fade or self.growth


SEAMLESS = Transitions()
"""With all of it."""
