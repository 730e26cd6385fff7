"""What workers are asked, and what they tell."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..studio.take import Take

Told = dict[str, Any]

Measure = Callable[[Take, str | None], Told]
"""Returns what a benchmark tells of a take; where a folder is given, its pictures go there."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What workers are asked for each scene."""

    measure: Measure
    """It is a function of a module, or a part of one: by its name workers find it."""

    timed: bool = False
    """Whether it tells of time: then no machine does it for two scenes at once."""
