"""The governor: holds a frame time by drawing fewer pixels and shorter distances.

Nothing else depends on how busy the machine is, and it does nothing unless a game asks for it.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import ceil, floor, log
from reprlib import repr as shortened
from statistics import median
from time import perf_counter

from ..engine.fixed import Fixed
from ..engine.handed import NUMBER_TYPES
from .around.outlook import Outlook
from .around.pace import change_step
from .painter import Painter
from .transition import FADE

RUNG = log(2.0) / 6.0
"""Largest saving of a rung over the one above it, as a logarithm of time: both sides of the picture shrink by a twelfth
of an octave."""

LADDER = ((8, 0), (8, 12), (18, 12))
"""Octaves of pixels, across and up, and of distances that are left out, in twelfths; rungs go one by one from each pair
to the next. Pixels go first, as they change at once, but not so many that grass blurs before distances shrink."""

ABOVE = 0.03
"""Excess over the frame time held above which frames are made cheaper, as a logarithm."""

BELOW = 0.16
"""Spare part of the frame time held above which frames are made finer, as a logarithm: more than a rung, or they would
at once take too long."""

WATCHED = 0.25
"""Minimum time for which frames are watched before a change [s]."""

EAGER = 2.0
"""Factor on the number of rungs descended: part of a frame's time does not depend on what is left out."""

FEWEST = 3
"""Minimum number of frames watched before a change."""

BEGINNING = 2
"""Number of frames at first, and after every change, that make things and do not count."""

LONGEST_PATIENCE = 16
"""Maximum number of times in a row that frames must be short before they are made finer."""

SUDDEN = 0.35
"""Excess over the frame time held above which more than `GENTLE` rungs are descended at once, as a logarithm."""

GENTLE = 2
"""Number of rungs whose change is hidden by the motion that the wind makes from frame to frame."""

SPEED = 0.15
"""Speed at which the range changes, as a fraction of the full range a second: strips grow no faster in a change."""


@dataclass(frozen=True, slots=True)
class Fineness:
    """Fractions of pixels and distances that are drawn."""

    scale: float = 1.0
    """Fraction of the pixels, across and up, of those that the preset draws."""

    range: float = 1.0
    """Fraction of the distances up to which representations are due."""


def _rungs() -> tuple[Fineness, ...]:
    pixels, distances = 0, 0
    found = [Fineness()]
    for most, farthest in LADDER:
        while (pixels, distances) != (most, farthest):
            pixels, distances = pixels + (pixels < most), distances + (distances < farthest)
            found.append(Fineness(2.0 ** (-pixels / 12.0), 2.0 ** (-distances / 12.0)))
    return tuple(found)


RUNGS = _rungs()
"""Fineness of each rung, from everything to the least."""


@dataclass(frozen=True, slots=True)
class GovernorState:
    """The governor's state for one viewer: its rung, and how its frames keep to their time."""

    rung: int = 0
    """Index of the present fineness in `RUNGS`."""

    uncounted: int = BEGINNING
    """Number of frames to come that do not count."""

    times: tuple[float, ...] = ()
    """Times of the frames watched so far [s]."""

    short: int = 0
    """Number of times in a row that the watched frames were short."""

    patience: int = 1
    """Number of times in a row that they must be short before a climb."""

    climbed: bool = False
    """Whether the last change was a climb to a finer rung."""


def next_state(state: GovernorState, seconds: float, /, *, hold: float) -> GovernorState:
    """Return the state after a frame on its rung has taken `seconds`; `hold` is the frame time held [s].

    It descends fast, and climbs only as far as the frame time is sure to allow. So it comes to rest under any steady
    load, and does not oscillate. After a climb that had to be taken back, the next climb waits longer.
    """
    if state.uncounted:
        return replace(state, uncounted=state.uncounted - 1)
    times = (*state.times, seconds)
    if len(times) < FEWEST or sum(times) < WATCHED:
        return replace(state, times=times)
    excess = log(max(median(times), 1e-6) / hold)
    if excess > ABOVE:
        rungs = ceil(EAGER * excess / RUNG)
        return _descended(state, rungs if excess > SUDDEN else min(rungs, GENTLE), hold)
    if excess >= -BELOW:
        return replace(state, times=(), short=0)
    if state.short + 1 < state.patience:
        return replace(state, times=(), short=state.short + 1)
    return _climbed(state, floor(-excess / RUNG), hold)


def _descended(state: GovernorState, rungs: int, hold: float) -> GovernorState:
    rung = min(len(RUNGS) - 1, state.rung + rungs)
    if rung == state.rung:
        return replace(state, times=())
    patience = min(LONGEST_PATIENCE, 2 * state.patience) if state.climbed else 1
    return GovernorState(rung, _frames_of_change(state.rung, rung, hold), patience=patience)


def _climbed(state: GovernorState, rungs: int, hold: float) -> GovernorState:
    rung = max(0, state.rung - min(rungs, GENTLE))
    if rung == state.rung:
        return replace(state, times=(), short=0)
    return GovernorState(rung, _frames_of_change(state.rung, rung, hold), patience=state.patience, climbed=True)


def _frames_of_change(rung: int, other: int, hold: float) -> int:
    """Return the number of frames until a change from one rung to another is over."""
    way = abs(RUNGS[rung].range - RUNGS[other].range)
    return BEGINNING + (ceil((FADE + way / SPEED) / hold) if way else 0)


def eased(now: float, due: float, /, *, dt: float) -> float:
    """Return the range after `dt` [s] of moving from `now` towards `due`."""
    return max(due, now - SPEED * dt) if due < now else min(due, now + SPEED * dt)


LONGEST = 5.0
"""Longest time that can be held [s]: more is rather a rate in frames a second, or milliseconds."""


class Governor(Fixed):
    """Holds the time of a prairie's draws, for each viewer separately."""

    def __init__(self, hold: float | None = None) -> None:
        self.hold = hold
        self.resting = False
        """Whether rungs and ranges stay as they were in the frame before."""

        self._states: dict[str, GovernorState] = {}
        self._rungs: dict[str, int] = {}
        """Rung at which the present frame is drawn, by viewer."""
        self._begun = 0.0
        """Reading of the clock when the present frame began [s]."""
        self._fix(Governor)

    @property
    def hold(self) -> float | None:
        """Longest time of a draw [s]; None to draw everything. ValueError for anything but a time up to 5 s."""
        return self._hold

    @hold.setter
    def hold(self, seconds: float | None) -> None:
        if seconds is not None and not (isinstance(seconds, NUMBER_TYPES) and 0.0 < seconds <= LONGEST):
            due = f"a time above 0 s and up to {LONGEST:g} s, such as 1 / 60, or None for no limit"
            raise ValueError(f"hold is {due}, not {shortened(seconds)}")
        self._hold = seconds

    def begin(self, outlook: Outlook, /, *, goes_on: bool = False) -> None:
        """Begin a viewer's frame: choose its rung, and move the range of its representations towards that rung's.

        A frame that `goes_on` with other parts stays on its rung.
        """
        name, self._begun = outlook.viewer.name, perf_counter()
        if not self.resting and not goes_on:
            self._rungs[name] = 0 if self.hold is None else self._states.setdefault(name, GovernorState()).rung
            outlook.lens.range = eased(
                outlook.lens.range, RUNGS[self._rungs[name]].range, dt=change_step(outlook.viewer)
            )

    def fineness(self, viewer: str, /) -> Fineness:
        """Return the fineness of a viewer's present picture."""
        return RUNGS[self._rungs.get(viewer, 0)]

    @contextmanager
    def watching(self, painter: Painter, viewer: str, /) -> Iterator[Fineness]:
        """Time the drawing inside this context for a viewer, and give its fineness.

        A graphics card's own time is measured, which arrives some frames later. Where there is no card, the processor's
        time since the frame began is added.
        """
        if self.hold is None or viewer not in self._states:  # a system may have set `hold` since the frame began
            yield self.fineness(viewer)
            return
        watch, spent = painter.stopwatch, perf_counter() - self._begun
        with watch.timing((viewer, self._rungs.get(viewer, 0))):
            yield self.fineness(viewer)
        for (name, rung), seconds in watch.read():
            state = self._states[name]
            if rung == state.rung and not self.resting:
                self._states[name] = next_state(state, seconds + (spent if watch.waits else 0.0), hold=self.hold)
