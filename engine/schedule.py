"""The schedule of a frame: systems in phases, which a game may read, add, replace and disable."""

import logging
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from dataclasses import replace as changed
from enum import IntEnum
from functools import partial
from inspect import isasyncgenfunction, iscoroutinefunction, isgeneratorfunction
from itertools import count
from reprlib import repr as shortened
from time import perf_counter, thread_time
from typing import Any, Protocol, TypeVar

from ..components.words import guess
from .complaint import said

WAITED = 0.25
"""Waiting time from which a turn counts as a wait [s]: time on the clock in which its thread does not run."""

IDLE = 10.0
"""Ratio of waiting to working time from which a turn counts as a wait: on a busy machine threads wait for a CPU."""

PATIENCE, WINDOW = 3, 16
"""Number of waits that are often, among this many of the latest turns; a single one may import something."""

Key = TypeVar("Key")

log = logging.getLogger("tallgrass")


class Phase(IntEnum):
    """Steps of a frame, in this order."""

    INPUT = 0
    """A game's own work before anything else of the frame. The viewer has looked already."""

    TILE = 1
    """Patches come and go around the viewer."""

    SEE = 2
    """Culling, discrete distance, representations."""

    BLOW = 3
    """The wind's messages reach the receivers."""

    DRAW = 4
    """Visible grass is gathered for the graphics card."""


class HasRun(Protocol):
    """An object whose method `run` is a system."""

    def run(self) -> object:
        """Do once what the system does in a frame."""


Run = Callable[[], object] | HasRun
"""Work of a system: a callable without arguments, or an object with such a method `run`."""


@dataclass(frozen=True, slots=True)
class System:
    """A system of a schedule at one moment; after a change the schedule has a new record of it."""

    name: str
    """Its name, unique in its schedule."""

    phase: Phase
    """Phase in which it runs."""

    run: Callable[[], object]
    """Function that is called once a frame."""

    enabled: bool = True
    """Whether it runs. A system that has failed does not run either; it is listed in the schedule's `failures`."""

    trusted: bool = False
    """Whether its errors are raised to the caller; other systems are left out when they raise."""

    origin: str = ""
    """Module and name of the function."""

    number: int = 0
    """Number of systems that had been added to its schedule before."""


def has_waited(took: float, busy: float, /) -> bool:
    """Return whether a call that took `took` on the clock, and `busy` of its thread's time [s], has waited too long."""
    return took - busy > max(WAITED, IDLE * busy)


def is_often(latest: dict[Key, int], key: Key, /, *, is_long: bool) -> bool:
    """Note whether a turn was long; return whether it was, and `PATIENCE` of the latest `WINDOW` turns were.

    `latest` has bits for each key that has had a long turn: 1 for a long one, the lowest bit for the last turn.
    """
    bits = (latest.pop(key, 0) << 1 | is_long) & ((1 << WINDOW) - 1)
    if bits:
        latest[key] = bits
    return is_long and bits.bit_count() >= PATIENCE


class UnknownSystemError(KeyError):
    """No system of a schedule has this name; the message is one sentence, and names the one it resembles."""

    def __str__(self) -> str:
        return str(self.args[0])  # KeyError would put it in quotes


@dataclass(slots=True, eq=False, repr=False)
class Schedule:
    """Systems by phase, in the order in which they were added unless `before` says otherwise; each is timed by name.

    Iteration is in running order. Systems may change the schedule while they run: an added system first runs in the
    next frame, a removed or disabled one no longer runs, and a replaced one runs as the new one.
    """

    live: bool = True
    """Whether a system that often waits is left out, as in a game; otherwise it is only logged."""

    come_back: Callable[[], str] = lambda: ""
    """Undoes a change that no system may leave behind; returns what was done, as "left ...", or ""."""

    milliseconds: dict[str, float] = field(init=False, default_factory=dict)
    """Duration of each system when its phase was last run [ms]; only of systems that ran then without an error."""

    failures: dict[str, str] = field(init=False, default_factory=dict)
    """One sentence for each system that has been left out, as it raised an error or often waited."""

    _systems: dict[str, System] = field(init=False, default_factory=dict)
    """Systems by name, in running order."""

    _waits: dict[str, int] = field(init=False, default_factory=dict)
    """Waits in the latest turns of each system, as `is_often` notes them."""

    _logged: set[str] = field(init=False, default_factory=set)
    """Names of the systems whose waits have been logged."""

    _numbers: Iterator[int] = field(init=False, default_factory=count)
    _closed: bool = field(init=False, default=False)
    _runs: bool = field(init=False, default=False)
    """Whether systems are running now."""

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

        `phase` may be a name in any case, as "blow". `after` only checks that the system of that name runs earlier.
        Other systems keep their order. Errors of a `trusted` system are raised to the caller: that is for the engine's
        own. Raises ValueError for a name that is empty or taken, an unknown phase, and an impossible order;
        UnknownSystemError where `before` or `after` names no system; TypeError for a `run` that cannot be called;
        RuntimeError after `Prairie.release`.
        """
        if self._closed:
            raise RuntimeError("this prairie has been released: load it again to add a system")
        if not (isinstance(name, str) and name.strip()):
            raise ValueError(f"a system's name is a text that is not empty, unlike {shortened(name)}")
        if name in self._systems:
            raise ValueError(f"there is a system '{name}' already; replace it, or take another name")
        ready = _ready(name, run)
        added = System(name, _phase(phase), ready, trusted=trusted, origin=_origin(run), number=next(self._numbers))
        rows = list(self)
        rows.insert(self._place(added, before, after), added)
        self._systems = {row.name: row for row in rows}

    def replace(self, name: str, run: Run, *, trusted: bool = False) -> None:
        """Give a system another function: it keeps its place, and stays enabled or disabled.

        Its failure is forgotten. Raises UnknownSystemError, and TypeError for a `run` that cannot be called.
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

    def close(self) -> None:
        """Remove every system, and refuse others from now on."""
        self.clear()
        self._closed = True

    def enable(self, name: str) -> None:
        """Let a system run again, also one that has failed or waited; raises UnknownSystemError."""
        self._systems[name] = changed(self[name], enabled=True)
        self.failures.pop(name, None)
        self._waits.pop(name, None)

    def disable(self, name: str) -> None:
        """Keep a system from running until it is enabled; raises UnknownSystemError."""
        self._systems[name] = changed(self[name], enabled=False)

    def run(self, *, first: Phase = Phase.INPUT, last: Phase = Phase.DRAW) -> None:
        """Run every enabled system from the `first` phase to the `last` one once, in order.

        A system that raises an Exception is logged and left out from then on, unless it is trusted. SystemExit goes
        through, and is logged: a game may end itself. A system that waits
        for longer than `WAITED`, for a disk or another program, is logged once; in a `live` schedule it is left out
        after `PATIENCE` waits in its latest `WINDOW` turns. A system that leaves a change for `come_back` to undo is
        left out at once.
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

    def must_be_idle(self, purpose: str, /) -> None:
        """Raise RuntimeError while systems run: they cannot draw the prairie, which would run all of them recursively.

        Nor can they change what they are made for. `purpose` says what they cannot do, as "draw it".
        """
        if self._runs:
            raise RuntimeError(f"this prairie is being drawn: its systems cannot {purpose}; do so before or after")

    def step(self, which: Phase | str, /) -> None:
        """Run once, outside of a frame, one system by its name, or the enabled ones of a phase.

        A named system runs even if it is disabled or has failed. Nothing is timed, no system is left out, and errors
        are raised to the caller. Raises UnknownSystemError.
        """
        if not isinstance(which, Phase):
            self[which].run()
            return
        for system in self._turns(which, which):
            system.run()

    def _turns(self, first: Phase, last: Phase) -> Iterator[System]:
        """Yield each system of a range of phases that has its turn, in its state at that moment."""
        for system in tuple(self._systems.values()):
            now = self._systems.get(system.name)  # `_now` inlined: it would cost a call for each system of a frame
            if now is None or now.number != system.number or not now.enabled:
                continue
            if first <= now.phase <= last and now.name not in self.failures:
                yield now

    def _now(self, system: System) -> System | None:
        """Return the present record of a system; None if it has been removed, even if another has its name."""
        now = self._systems.get(system.name)
        return now if now and now.number == system.number else None

    def _run(self, system: System) -> None:
        start, spent = perf_counter(), 0.0 if system.trusted else thread_time()
        try:
            system.run()
        except BaseException as error:
            if system.trusted:
                raise
            self.come_back()
            if isinstance(error, SystemExit):
                log.warning("system '%s' of %s ends the program: run raised %s", *_called(system), said(error))
            if not isinstance(error, Exception):
                raise
            log.debug("%s", system.name, exc_info=error)
            self._leave_out(system, f"run raised {said(error)}")
        else:
            took, now = perf_counter() - start, self._systems.get(system.name)
            if now and now.number == system.number:
                self.milliseconds[system.name] = 1000.0 * took
                if not system.trusted:
                    self._judge(system, took, thread_time() - spent)
            if not system.trusted and (left := self.come_back()):
                self._leave_out(system, f"run {left}")

    def _judge(self, system: System, took: float, busy: float) -> None:
        """Log a system that waits, and in a live schedule leave it out when it waits often."""
        waits, what = has_waited(took, busy), f"run waits: for {took - busy:.1f} s, and every frame with it"
        if is_often(self._waits, system.name, is_long=waits) and self.live:
            self._leave_out(system, what)
        elif waits and system.name not in self._logged:
            self._logged.add(system.name)
            log.warning("system '%s' of %s: %s", *_called(system), what)

    def _leave_out(self, system: System, what: str) -> None:
        why = f"system '{system.name}' of {system.origin}: {what}"
        now = self._now(system)
        if now and now.run is system.run:  # it may have replaced or removed itself
            self.failures[system.name] = why
        log.warning("%s; it is left out from now on", why)

    def _place(self, added: System, before: str | None, after: str | None) -> int:
        """Return the number of systems that run before a new one."""
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
        near = guess(str(name), self._systems) or f"; there are {', '.join(self._systems) or 'none'}"
        return f"no system '{name}'{near}"


def _called(system: System) -> tuple[str, str]:
    return system.name, system.origin


def _earlier(one: System, other: System) -> str:
    return f"phase {one.phase.name} comes before phase {other.phase.name}"


def _phase(phase: Phase | str) -> Phase:
    name = phase.name if isinstance(phase, Phase) else str(phase)
    if name.upper() not in Phase.__members__:
        raise ValueError(f"no phase '{name}'; there are {', '.join(Phase.__members__)}")
    return Phase[name.upper()]


def _ready(name: str, run: Run) -> Callable[[], object]:
    """Return the function of a system.

    A class is refused, as a call would only make an object; so are generators and coroutines, as a call would only
    start them.
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
