"""The registry of wind kinds: built-in ones, installed ones and a game's own, all through one door."""

import logging
import os
import re
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from inspect import isabstract
from typing import Literal, TypeVar

from ..components.wind import INTERFACE, WindPrimitive

GROUP = "tallgrass.wind"
"""The entry-point group of wind kinds; an entry's name is the `kind:` of scene files, its value a class."""

CHOSEN = "TALLGRASS_PLUGINS"
"""The environment variable that names the kinds or distributions to use of those installed: `a,b`; empty is none.

Without it all are used. The built-in kinds always are.
"""

OURS = "tallgrass"
"""The distribution of the built-in kinds."""

log = logging.getLogger("tallgrass")

_KIND = re.compile(r"[a-z][a-z0-9_-]*")
_W = TypeVar("_W", bound=WindPrimitive)


class PluginError(ValueError):
    """A kind is unknown, claimed twice or broken; the message is one sentence that names whose it is."""


Status = Literal["ready", "claimed twice", "left out"]
"""What is known of a kind before its class is imported."""


@dataclass(frozen=True, slots=True)
class Provided:
    """A kind of wind and who brings it."""

    kind: str
    """As scene files call it."""

    distribution: str
    """What brings it: a distribution, or the module and name of a game's own class."""

    version: str
    """Version of the distribution; of a game's own class, nothing."""

    status: Status
    """`ready`, `claimed twice`, or `left out` by the environment."""


class WindKinds:
    """Wind kinds by name. A class is imported when its kind is first asked for, and never before.

    Of the installed ones, `chosen` names the kinds or distributions to use beside those of tallgrass; None is all.
    """

    def __init__(self, entries: Iterable[EntryPoint], *, chosen: Collection[str] | None = None) -> None:
        self._entries: dict[str, list[EntryPoint]] = {}
        self._left_out: dict[str, list[EntryPoint]] = {}
        self._classes: dict[str, type[WindPrimitive]] = {}
        for entry in entries:
            kept = self._entries if _is_chosen(entry, chosen) else self._left_out
            kept.setdefault(entry.name, []).append(entry)
        known = {name for entry in self._all() for name in _names(entry)}
        for name in sorted({_normal(name) for name in chosen or ()} - known):
            log.warning("%s names '%s', but no such kind or distribution is installed", CHOSEN, name)

    def provided(self) -> list[Provided]:
        """Return who brings which kind, in alphabetical order, those left out too; nothing is imported for it."""
        rows = [Provided(entry.name, *_owner(entry), self._status(entry)) for entry in self._all()]
        own = (kind for kind in self._classes if kind not in self._entries)
        rows += [Provided(kind, _address(self._classes[kind]), "", "ready") for kind in own]
        return sorted(rows, key=lambda row: (row.kind, row.status, row.distribution))

    def origin(self, primitive: WindPrimitive, /) -> str:
        """Return who brings a wind: a distribution and its version, or the module and name of a game's own class."""
        entries = self._entries.get(primitive.kind, [])
        if len(entries) == 1 and type(primitive) is self._classes.get(primitive.kind):
            return _owners(entries)
        return _address(type(primitive))

    def names(self) -> list[str]:
        """Return the kinds a scene may use, in alphabetical order; nothing is imported for it."""
        return sorted(self._entries.keys() | self._classes.keys())

    def add(self, kind: str, primitive: type[WindPrimitive]) -> None:
        """Add a game's own kind; a class of the same module and name replaces itself, for reloading.

        Raises PluginError when the name is malformed, or is already another class's or a distribution's.
        """
        if not _KIND.fullmatch(kind):
            raise PluginError(f"a kind is written in lower-case letters, digits, - and _, unlike '{kind}'")
        _must_be_primitive(primitive, f"the class for kind '{kind}'")
        if kind in self._entries:
            raise PluginError(f"kind '{kind}' already comes with {_owners(self._entries[kind])}")
        other = self._classes.get(kind, primitive)
        if _address(other) != _address(primitive):
            raise PluginError(f"kind '{kind}' is claimed by both {_address(other)} and {_address(primitive)}")
        self._classes[kind] = primitive

    def find(self, kind: str) -> type[WindPrimitive]:
        """Return the class of a kind.

        Raises PluginError when the kind is unknown, when two distributions claim it, and when its class
        cannot be imported or is no wind primitive.
        """
        if kind not in self._classes:
            self._classes[kind] = self._load(kind)
        return self._classes[kind]

    def _load(self, kind: str) -> type[WindPrimitive]:
        entries = self._entries.get(kind, [])
        if not entries:
            raise PluginError(self._unknown(kind))
        if len(entries) > 1:
            choice = f"uninstall all but one of them, or name it in {CHOSEN}"
            raise PluginError(f"kind '{kind}' is claimed by {_owners(entries)}; {choice}")
        try:
            loaded = entries[0].load()
        except Exception as error:  # importing a plugin runs its code, which may raise anything
            why = f"{type(error).__name__}: {error}"
            raise PluginError(f"kind '{kind}' of {_owners(entries)} cannot be loaded: {why}") from error
        return _must_be_primitive(loaded, f"kind '{kind}' of {_owners(entries)}")

    def _all(self) -> list[EntryPoint]:
        return [entry for kept in (self._entries, self._left_out) for entries in kept.values() for entry in entries]

    def _status(self, entry: EntryPoint) -> Status:
        kept = self._entries.get(entry.name, [])
        if all(entry is not other for other in kept):  # equal entries may be of two distributions
            return "left out"
        return "ready" if len(kept) == 1 else "claimed twice"

    def _unknown(self, kind: str) -> str:
        if kind in self._left_out:
            return f"kind '{kind}' of {_owners(self._left_out[kind])} is left out: {CHOSEN} does not name it"
        near = get_close_matches(kind, self.names(), n=1)
        guess = f", did you mean '{near[0]}'?" if near else ";"
        return f"unknown kind '{kind}'{guess} known: {', '.join(self.names()) or 'none'}"


@cache
def wind_kinds() -> WindKinds:
    """Return the kinds of this process: those installed, as the environment chooses, and those added by `wind`."""
    chosen = os.environ.get(CHOSEN)
    names = None if chosen is None else [name for part in chosen.split(",") if (name := part.strip())]
    return WindKinds(entry_points(group=GROUP), chosen=names)


def wind(kind: str) -> Callable[[type[_W]], type[_W]]:
    """Return a class decorator that makes a game's own wind primitive a `kind:` of scene files.

    Raises PluginError when the kind is taken, and when the class is no complete `WindPrimitive`.
    """

    def added(primitive: type[_W]) -> type[_W]:
        wind_kinds().add(kind, primitive)
        return primitive

    return added


def _must_be_primitive(thing: object, what: str) -> type[WindPrimitive]:
    if not (isinstance(thing, type) and issubclass(thing, WindPrimitive)):
        raise PluginError(f"{what} must be a class that derives from WindPrimitive")
    if isabstract(thing):
        raise PluginError(f"{what} lacks {' and '.join(sorted(thing.__abstractmethods__))}")
    if thing.interface != INTERFACE:
        raise PluginError(f"{what} is written for interface {thing.interface} of winds; this tallgrass has {INTERFACE}")
    return thing


def _is_chosen(entry: EntryPoint, chosen: Collection[str] | None) -> bool:
    if chosen is None or _owner(entry)[0] == OURS:
        return True
    return not _names(entry).isdisjoint(_normal(name) for name in chosen)


def _names(entry: EntryPoint) -> set[str]:
    return {_normal(entry.name), _normal(_owner(entry)[0])}


def _normal(name: str) -> str:
    """Return a name as package indexes compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def _owner(entry: EntryPoint) -> tuple[str, str]:
    return (entry.dist.name, entry.dist.version) if entry.dist else (f"the entry point {entry.value}", "")


def _owners(entries: list[EntryPoint]) -> str:
    return " and ".join(" ".join(_owner(entry)).strip() for entry in entries)


def _address(primitive: type) -> str:
    return f"{primitive.__module__}.{primitive.__qualname__}"
