"""Sections: a blade's cross section, by the profile that its kind declares."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from typing import Final

from ...engine.declared.grass import Profile


@dataclass(frozen=True, slots=True)
class Section:
    """The cross section of a blade, as numbers."""

    waist: float = 0.45
    """Width at the ground, as a fraction of the width above."""

    is_round: bool = False
    """Whether the blade is as wide from all sides; then it has no face."""

    folded: float = 0.0
    """Angle between the normals of its two faces and the direction that the blade faces [rad]."""


FLAT: Final = Section()
"""The section of a plain ribbon."""

SECTIONS: Mapping[Profile, Section] = {
    "blade": FLAT,
    "rush": Section(waist=1.0, is_round=True),
    "fold": Section(folded=radians(32.0)),
}
"""The section of each profile."""
