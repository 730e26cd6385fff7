"""Sections: what a blade is like across, by the profile that its kind declares."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import radians
from typing import Final

from ...engine.declared.grass import Profile


@dataclass(frozen=True, slots=True)
class Section:
    """What a profile makes of a blade."""

    waist: float = 0.45
    """Width where it leaves the ground, as a part of that above."""

    is_round: bool = False
    """Whether it is as wide from all sides: then it has no face."""

    folded: float = 0.0
    """Angle by which each of its two faces is turned away from where the blade faces [rad]."""


FLAT: Final = Section()
"""A blade that is a ribbon."""

SECTIONS: Mapping[Profile, Section] = {
    "blade": FLAT,
    "rush": Section(waist=1.0, is_round=True),
    "fold": Section(folded=radians(32.0)),
}
"""The section of each profile."""
