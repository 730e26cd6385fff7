"""The order of a frame: named phases, and systems in the order they were added within each."""

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from time import perf_counter


class Phase(IntEnum):
    """What a frame goes through, in this order."""

    INPUT = 0
    """What the game did: the camera, the time."""

    TILE = 1
    """Patches come and go around the viewer."""

    SEE = 2
    """Culling, discrete distance, representations."""

    BLOW = 3
    """The wind's messages reach the receivers."""

    DRAW = 4
    """What is seen is gathered for the graphics card."""


System = Callable[[], None]


@dataclass(slots=True)
class Schedule:
    """Systems by phase, each timed under its name."""

    systems: list[tuple[Phase, str, System]] = field(default_factory=list)
    """Phase, name and function of each system, in running order."""

    milliseconds: dict[str, float] = field(default_factory=dict)
    """What each system took in the last run [ms]."""

    def add(self, phase: Phase, name: str, system: System) -> None:
        """Add a system at the end of its phase."""
        self.systems.append((phase, name, system))
        self.systems.sort(key=lambda row: row[0])

    def run(self, *, last: Phase = Phase.DRAW) -> None:
        """Run every system up to the `last` phase once, in order."""
        for phase, name, system in self.systems:
            if phase > last:
                break
            start = perf_counter()
            system()
            self.milliseconds[name] = 1000.0 * (perf_counter() - start)

    def step(self, which: Phase | str, /) -> None:
        """Run one system by its name, or all those of a phase, once and out of the order of a frame."""
        for phase, name, system in self.systems:
            if which in {phase, name}:
                system()
