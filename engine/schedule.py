"""The schedule of a frame: systems in phases, which a game may read, add to, replace and leave out."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from dataclasses import replace as changed
from difflib import get_close_matches
from enum import IntEnum
from functools import partial
from inspect import isasyncgenfunction, iscoroutinefunction, isgeneratorfunction
from itertools import count
from time import perf_counter, thread_time
from typing import Any, Protocol

from .complaint import said

WAITED = 0.25
"""How long nobody may wait in a frame [s]: that is time on the clock in which this thread does nothing."""

IDLE = 10.0
"""How many times as long as it works: on a busy machine those who work wait as well, for their turn."""

PATIENCE, WINDOW = 3, 16
"""How often, of a system's latest turns, it may not have waited for so long."""

log = logging.getLogger("tallgrass")


class Phase(IntEnum):
    """What a frame goes through, in this order."""

    INPUT = 0
    """Before anything else of the frame: what a game wants to have done by then. The viewer has looked already."""

    TILE = 1
    """Patches come and go around the viewer."""

    SEE = 2
    """Culling, discrete distance, representations."""

    BLOW = 3
    """The wind's messages reach the receivers."""

    DRAW = 4
    """What is seen is gathered for the graphics card."""


class HasRun(Protocol):
    """An object that is a system by its method `run`."""

    def run(self) -> object:
        """Do once what the system does in a frame."""


Run = Callable[[], object] | HasRun
"""What a system does: a callable without arguments, or an object with such a method `run`."""


@dataclass(frozen=True, slots=True)
class System:
    """A system of a schedule, as it stands at the moment; the schedule changes it, and gives out a new record then."""

    name: str
    """What it is called, once in its schedule."""

    phase: Phase
    """The phase that it runs in."""

    run: Callable[[], object]
    """What it does once a frame."""

    enabled: bool = True
    """Whether it has its turn in a frame; one that has failed has none, and is named in the schedule's `failures`."""

    trusted: bool = False
    """Whether what it raises goes through; all others are left out when they raise."""

    origin: str = ""
    """Module and name of what it runs."""

    number: int = 0
    """How many systems had been added to its schedule before."""


def has_waited(took: float, busy: float, /) -> bool:
    """Return whether somebody who took so long on the clock, and was busy for so long [s], has waited too long."""
    return took - busy > max(WAITED, IDLE * busy)


class UnknownSystemError(KeyError):
    """No system of a schedule has this name; the message is one sentence, and names the one it resembles."""

    def __str__(self) -> str:
        return str(self.args[0])  # KeyError would put it in quotes


@dataclass(slots=True, eq=False, repr=False)
class Schedule:
    """Systems by phase, in the order in which they were added unless `before` says otherwise; each is timed by name.

    It is iterated in running order. Systems may change it while they run: what they add has its turn in the next
    frame, what they remove or disable has none any more, and what they replace runs as the new one.
    """

    live: bool = True
    """Whether a system that waits in its turns is left out, as in a game; otherwise it is only named in the log."""

    come_back: Callable[[], str] = lambda: ""
    """Brings back what a system may not leave changed, and returns in words what one has, or nothing."""

    milliseconds: dict[str, float] = field(init=False, default_factory=dict)
    """What each system took when its phase was last run [ms]; only those that ran then and raised nothing."""

    failures: dict[str, str] = field(init=False, default_factory=dict)
    """One sentence for each system that raised something, or often waited, and is left out since."""

    _systems: dict[str, System] = field(init=False, default_factory=dict)
    """By name, in running order."""

    _waits: dict[str, int] = field(init=False, default_factory=dict)
    """Of each system that has waited, in which of its latest turns, one bit for each."""

    _told: set[str] = field(init=False, default_factory=set)
    """The systems of which it has been said that they wait."""

    _numbers: Iterator[int] = field(init=False, default_factory=count)
    _runs: bool = field(init=False, default=False)
    """Whether its systems are running now."""

    def __iter__(self) -> Iterator[System]:
        return iter(tuple(self._systems.values()))

    def __len__(self) -> int:
        return len(self._systems)

    def __contains__(self, name: object) -> bool:
        return name in self._systems

    def __getitem__(self, name: str) -> System:
        if name not in self._systems:
            raise UnknownSystemError(self._unknown(name))
        return self._systems[name]

    def __repr__(self) -> str:
        return f"Schedule({', '.join(f'{system.phase.name} {system.name}' for system in self)})"

    def add(
        self,
        phase: Phase | str,
        name: str,
        run: Run,
        *,
        before: str | None = None,
        after: str | None = None,
        trusted: bool = False,
    ) -> None:
        """Add a system: right before another one if `before` names it, and else at the end of its phase.

        `phase` may be a name in any case, as "blow". `after` only makes sure that the system of that name runs earlier.
        Those that are there keep their order. Of a `trusted` system errors go through: that is for the engine's own.
        Raises ValueError for a name that is empty or taken, for an unknown phase, and for an order that cannot be;
        UnknownSystemError where `before` or `after` is none; TypeError for what cannot run.
        """
        if not (isinstance(name, str) and name.strip()):
            raise ValueError(f"a system's name is a text that is not empty, unlike {name!r}")
        if name in self._systems:
            raise ValueError(f"there is a system '{name}' already; replace it, or take another name")
        ready = _ready(name, run)
        added = System(name, _phase(phase), ready, trusted=trusted, origin=_origin(run), number=next(self._numbers))
        rows = list(self)
        rows.insert(self._place(added, before, after), added)
        self._systems = {row.name: row for row in rows}

    def replace(self, name: str, run: Run, *, trusted: bool = False) -> None:
        """Let a system do something else from now on: it keeps its place, and is enabled or not as before.

        It has not failed any more. Raises UnknownSystemError, and TypeError for what cannot run.
        """
        found = self[name]
        ready = _ready(name, run)
        self._waits.pop(name, None)
        self._systems[name] = changed(found, run=ready, trusted=trusted, origin=_origin(run))
        self.failures.pop(name, None)

    def remove(self, name: str) -> None:
        """Remove a system; raises UnknownSystemError."""
        del self._systems[self[name].name]
        self._waits.pop(name, None)
        self.failures.pop(name, None)
        self.milliseconds.pop(name, None)

    def clear(self) -> None:
        """Remove every system."""
        for system in self:
            self.remove(system.name)

    def enable(self, name: str) -> None:
        """Let a system have its turns again, also one that has failed or waited; raises UnknownSystemError."""
        self._systems[name] = changed(self[name], enabled=True)
        self.failures.pop(name, None)
        self._waits.pop(name, None)

    def disable(self, name: str) -> None:
        """Let a system have no turns until it is enabled; raises UnknownSystemError."""
        self._systems[name] = changed(self[name], enabled=False)

    def run(self, *, first: Phase = Phase.INPUT, last: Phase = Phase.DRAW) -> None:
        """Run every enabled system from the `first` phase to the `last` one once, in order.

        One that raises an Exception is named in the log and left out from then on, unless it is trusted. One that waits
        for longer than `WAITED`, for a disk or another program, is named once; where the schedule is `live` it is left
        out when it has done so three times. So is one that leaves changed what `come_back` brings back.
        """
        for system in self:
            if first <= system.phase <= last:
                self.milliseconds.pop(system.name, None)
        self._runs = True
        try:
            for system in self._turns(first, last):
                self._run(system)
        finally:
            self._runs = False

    def must_be_idle(self) -> None:
        """Raise RuntimeError while its systems run: where one of them draws, all would run again, itself among them."""
        if self._runs:
            raise RuntimeError("this prairie is being drawn: its systems cannot draw it; do so before or after")

    def step(self, which: Phase | str, /) -> None:
        """Run one system by its name, or those of a phase that are enabled, once and out of the order of a frame.

        A system that is named runs even if it is disabled or has failed. Nothing is timed, and nobody is left out:
        what a system raises goes through. Raises UnknownSystemError.
        """
        if not isinstance(which, Phase):
            self[which].run()
            return
        for system in self._turns(which, which):
            system.run()

    def _turns(self, first: Phase, last: Phase) -> Iterator[System]:
        """Give each system of some phases that has a turn, as it stands when its turn comes."""
        for system in tuple(self._systems.values()):
            now = self._systems.get(system.name)  # as in `_now`: a call is saved for each system of a frame
            if now is None or now.number != system.number or not now.enabled:
                continue
            if first <= now.phase <= last and now.name not in self.failures:
                yield now

    def _now(self, system: System) -> System | None:
        """Return a system as it stands now; None if it has been removed, even if another has its name."""
        now = self._systems.get(system.name)
        return now if now and now.number == system.number else None

    def _run(self, system: System) -> None:
        start, spent = perf_counter(), 0.0 if system.trusted else thread_time()
        try:
            system.run()
        except Exception as error:
            if system.trusted:
                raise
            log.debug("%s", system.name, exc_info=error)
            self.come_back()
            self._leave_out(system, f"run raised {said(error)}")
        else:
            took, now = perf_counter() - start, self._systems.get(system.name)
            if now and now.number == system.number:
                self.milliseconds[system.name] = 1000.0 * took
                if not system.trusted:
                    self._judge(system, took, thread_time() - spent)
            if not system.trusted and (left := self.come_back()):
                self._leave_out(system, left)

    def _judge(self, system: System, took: float, busy: float) -> None:
        """Tell of a system that waits in its turns, and in a game leave it out when it does so often."""
        name, waits = system.name, has_waited(took, busy)
        if not waits and name not in self._waits:
            return
        self._waits[name] = (self._waits.get(name, 0) << 1 | waits) & ((1 << WINDOW) - 1)
        told = f"run waits: for {took - busy:.1f} s, and every frame with it"
        if self.live and waits and self._waits[name].bit_count() >= PATIENCE:
            self._leave_out(system, told)
        elif waits and name not in self._told:
            self._told.add(name)
            log.warning("system '%s' of %s: %s", name, system.origin, told)

    def _leave_out(self, system: System, what: str) -> None:
        why = f"system '{system.name}' of {system.origin}: {what}"
        now = self._now(system)
        if now and now.run is system.run:  # it may have replaced or removed itself
            self.failures[system.name] = why
        log.warning("%s; it is left out from now on", why)

    def _place(self, added: System, before: str | None, after: str | None) -> int:
        """Return how many systems run before a new one."""
        rows = list(self)
        place = sum(row.phase <= added.phase for row in rows)
        if before is not None:
            other = self[before]
            if other.phase < added.phase:
                raise ValueError(f"'{added.name}' cannot run before '{before}': {_earlier(other, added)}")
            place = rows.index(other) if other.phase == added.phase else place
        if after is not None:
            other = self[after]
            if other.phase > added.phase:
                raise ValueError(f"'{added.name}' cannot run after '{after}': {_earlier(added, other)}")
            if rows.index(other) >= place:
                raise ValueError(f"'{added.name}' cannot run before '{before}' and after '{after}', which runs later")
        return place

    def _unknown(self, name: object) -> str:
        near = get_close_matches(str(name), self._systems, n=1)
        guess = f", did you mean '{near[0]}'?" if near else f"; there are {', '.join(self._systems) or 'none'}"
        return f"no system '{name}'{guess}"


def _earlier(one: System, other: System) -> str:
    return f"phase {one.phase.name} comes before phase {other.phase.name}"


def _phase(phase: Phase | str) -> Phase:
    name = phase.name if isinstance(phase, Phase) else str(phase)
    if name.upper() not in Phase.__members__:
        raise ValueError(f"no phase '{name}'; there are {', '.join(Phase.__members__)}")
    return Phase[name.upper()]


def _ready(name: str, run: Run) -> Callable[[], object]:
    """Return what is to be called.

    A class is refused, because calling it would only make one more object; and so is what a call would only begin.
    """
    if isinstance(run, type):
        raise TypeError(f"system '{name}' was handed the class {run.__name__}; hand it an object made from that")
    ready: Callable[[], object] | None = run if callable(run) else getattr(run, "run", None)
    if not callable(ready):
        raise TypeError(
            f"system '{name}' needs a function without arguments or an object with run(), unlike {type(run).__name__}"
        )
    if iscoroutinefunction(ready) or isgeneratorfunction(ready) or isasyncgenfunction(ready):
        raise TypeError(f"system '{name}' would never run: it is async or yields, and a frame does not wait for it")
    return ready


def _origin(run: Any) -> str:
    while isinstance(run, partial):
        run = run.func
    named = run if isinstance(getattr(run, "__qualname__", None), str) else type(run)
    return f"{named.__module__ or 'builtins'}.{named.__qualname__}"
