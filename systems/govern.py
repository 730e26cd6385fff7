"""The governor: how much of a picture is drawn, so that a frame keeps to its time.

It is the one thing that depends on how busy the machine is, and there is none unless a game asks for it.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from math import ceil, floor, inf, log
from statistics import median
from time import perf_counter

from ..engine.handed import NUMBERS
from .around.outlook import Outlook
from .around.pace import change_step
from .painter import Painter
from .transition import FADE

RUNG = log(2.0) / 6.0
"""How much less a rung takes than the one above it, as a logarithm, at most: as pixels are left out, two of whose
sides shrink by a twelfth of an octave."""

LADDER = ((8, 0), (8, 12), (18, 12))
"""How many twelfths of an octave of pixels are left out, and of distances, one by one from each pair to
the next: pixels first, for they come and go at once, but not so many that grass is a blur before it is drawn in."""

ABOVE = 0.03
"""How much too long frames may take before they are made cheaper, as a logarithm."""

BELOW = 0.16
"""How much shorter they must be before they are made better, as a logarithm: more than a rung, or they would be too
long right away."""

WATCHED = 0.25
"""How long frames are watched before anything is changed [s]."""

EAGER = 2.0
"""How many times as far down as pixels alone would need: some of what a frame takes stays whatever is left out."""

FEWEST = 3
"""How many frames are watched at least before anything is changed."""

BEGINNING = 2
"""Frames at first, and after every change, that make things and do not count."""

LONGEST_PATIENCE = 16
"""How many times in a row frames must at most be seen to be short before they are made better."""

SUDDEN = 0.35
"""How much too long frames must take for more than `GENTLE` rungs to be descended at once, as a logarithm."""

GENTLE = 2
"""Rungs whose change is lost in what the wind changes from frame to frame."""

SPEED = 0.15
"""How much of their distances representations are drawn in or out by in a second: strips grow no faster in a change."""


@dataclass(frozen=True, slots=True)
class Fineness:
    """What is drawn of a picture."""

    scale: float = 1.0
    """Part of the pixels, across and up."""

    range: float = 1.0
    """Part of the distances up to which representations are due."""


def _rungs() -> tuple[Fineness, ...]:
    pixels, distances = 0, 0
    found = [Fineness()]
    for most, farthest in LADDER:
        while (pixels, distances) != (most, farthest):
            pixels, distances = pixels + (pixels < most), distances + (distances < farthest)
            found.append(Fineness(2.0 ** (-pixels / 12.0), 2.0 ** (-distances / 12.0)))
    return tuple(found)


RUNGS = _rungs()
"""What is drawn, from everything to the least."""


@dataclass(frozen=True, slots=True)
class Pace:
    """How frames have kept to their time, and what comes of it."""

    rung: int = 0
    """Number of what is drawn in `RUNGS`."""

    passing: int = BEGINNING
    """Frames that are still to pass uncounted."""

    times: tuple[float, ...] = ()
    """What those that count have taken [s]."""

    short: int = 0
    """How many times in a row they have been too short."""

    patience: int = 1
    """How many times they must be."""

    climbed: bool = False
    """Whether the last change was for the better."""


def paced(pace: Pace, seconds: float, /, *, hold: float) -> Pace:
    """Return the pace after a frame of its rung has taken so long; `hold` is how long it may take [s].

    Downwards it hurries, upwards it goes no farther than there is room for in any case: so it comes to rest under any
    steady load, and never swings about its aim. A climb that was taken back makes the next one wait for longer.
    """
    if pace.passing:
        return replace(pace, passing=pace.passing - 1)
    times = (*pace.times, seconds)
    if len(times) < FEWEST or sum(times) < WATCHED:
        return replace(pace, times=times)
    pace, over = replace(pace, times=()), log(max(median(times), 1e-6) / hold)
    if over > ABOVE:
        rungs = ceil(EAGER * over / RUNG)
        return _descended(pace, rungs if over > SUDDEN else min(rungs, GENTLE), hold)
    if over < -BELOW and pace.short + 1 < pace.patience:
        return replace(pace, short=pace.short + 1)
    return _climbed(pace, floor(-over / RUNG), hold) if over < -BELOW else replace(pace, short=0)


def _descended(pace: Pace, rungs: int, hold: float) -> Pace:
    rung = min(len(RUNGS) - 1, pace.rung + rungs)
    if rung == pace.rung:
        return pace
    patience = min(LONGEST_PATIENCE, 2 * pace.patience) if pace.climbed else 1
    return Pace(rung, _to_pass(pace.rung, rung, hold), patience=patience)


def _climbed(pace: Pace, rungs: int, hold: float) -> Pace:
    rung = max(0, pace.rung - min(rungs, GENTLE))
    if rung == pace.rung:
        return replace(pace, short=0)
    return Pace(rung, _to_pass(pace.rung, rung, hold), patience=pace.patience, climbed=True)


def _to_pass(rung: int, other: int, hold: float) -> int:
    """Return how many frames pass before a change of rungs has come to an end."""
    way = abs(RUNGS[rung].range - RUNGS[other].range)
    return BEGINNING + (ceil((FADE + way / SPEED) / hold) if way else 0)


def eased(now: float, due: float, /, *, dt: float) -> float:
    """Return where a range is after `dt` [s] on its way to the one that is due."""
    return max(due, now - SPEED * dt) if due < now else min(due, now + SPEED * dt)


class Governor:
    """Holds the time of a prairie's draws, for each viewer by itself."""

    def __init__(self, hold: float | None = None) -> None:
        self.hold = hold
        self.resting = False
        """Whether everything stays as it was in the frame before."""

        self._paces: dict[str, Pace] = {}
        self._drawn: dict[str, int] = {}
        self._begun = 0.0

    @property
    def hold(self) -> float | None:
        """How long a draw may take [s]; None to draw everything, whatever it takes. ValueError for what is no time."""
        return self._hold

    @hold.setter
    def hold(self, seconds: float | None) -> None:
        if seconds is not None and not (isinstance(seconds, NUMBERS) and 0.0 < seconds < inf):
            raise ValueError(f"a frame is held to a time above 0 s, or by None to none, not to {seconds!r}")
        self._hold = seconds

    def begin(self, outlook: Outlook, /, *, goes_on: bool = False) -> None:
        """Begin a viewer's frame: let the representations around it follow what is drawn of its picture now.

        One that `goes_on` with other parts is the same as before.
        """
        name, self._begun = outlook.viewer.name, perf_counter()
        if not self.resting and not goes_on:
            self._drawn[name] = 0 if self.hold is None else self._paces.setdefault(name, Pace()).rung
            outlook.lens.range = eased(
                outlook.lens.range, RUNGS[self._drawn[name]].range, dt=change_step(outlook.viewer)
            )

    def fineness(self, viewer: str, /) -> Fineness:
        """Return what is drawn of a viewer's picture now."""
        return RUNGS[self._drawn.get(viewer, 0)]

    @contextmanager
    def watching(self, painter: Painter, viewer: str, /) -> Iterator[Fineness]:
        """Time what is drawn meanwhile for a viewer; with a graphics card it is the card that is timed.

        What is known of a card comes later. Without one, all that has been done since the frame began counts too.
        """
        if self.hold is None or viewer not in self._paces:  # a system may have set it since the frame began
            yield self.fineness(viewer)
            return
        watch, spent = painter.stopwatch, perf_counter() - self._begun
        with watch.timing((viewer, self._drawn.get(viewer, 0))):
            yield self.fineness(viewer)
        for (name, rung), seconds in watch.read():
            pace = self._paces[name]
            if rung == pace.rung and not self.resting:
                self._paces[name] = paced(pace, seconds + (spent if watch.waits else 0.0), hold=self.hold)
