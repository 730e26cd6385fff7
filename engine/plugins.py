"""The registry of wind kinds: built-in ones, installed ones and a game's own, all through one door."""

import re
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from inspect import isabstract
from typing import TypeVar

from ..components.wind import WindPrimitive

GROUP = "tallgrass.wind"
"""The entry-point group of wind kinds; an entry's name is the `kind:` of scene files, its value a class."""

_KIND = re.compile(r"[a-z][a-z0-9_-]*")
_W = TypeVar("_W", bound=WindPrimitive)


class PluginError(ValueError):
    """A kind is unknown, claimed twice or broken; the message is one sentence that names whose it is."""


class WindKinds:
    """Wind kinds by name. A class is imported when its kind is first asked for, and never before."""

    def __init__(self, entries: Iterable[EntryPoint]) -> None:
        self._entries: dict[str, list[EntryPoint]] = {}
        self._classes: dict[str, type[WindPrimitive]] = {}
        for entry in entries:
            self._entries.setdefault(entry.name, []).append(entry)

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
            raise PluginError(f"kind '{kind}' is claimed by {_owners(entries)}; uninstall all but one of them")
        try:
            loaded = entries[0].load()
        except Exception as error:  # importing a plugin runs its code, which may raise anything
            why = f"{type(error).__name__}: {error}"
            raise PluginError(f"kind '{kind}' of {_owners(entries)} cannot be loaded: {why}") from error
        return _must_be_primitive(loaded, f"kind '{kind}' of {_owners(entries)}")

    def _unknown(self, kind: str) -> str:
        near = get_close_matches(kind, self.names(), n=1)
        guess = f", did you mean '{near[0]}'?" if near else ";"
        return f"unknown kind '{kind}'{guess} known: {', '.join(self.names()) or 'none'}"


@cache
def wind_kinds() -> WindKinds:
    """Return the kinds of this process: those installed, and those added by `wind`."""
    return WindKinds(entry_points(group=GROUP))


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
    return thing


def _owners(entries: list[EntryPoint]) -> str:
    owners = (f"{e.dist.name} {e.dist.version}" if e.dist else f"the entry point {e.value}" for e in entries)
    return " and ".join(owners)


def _address(primitive: type) -> str:
    return f"{primitive.__module__}.{primitive.__qualname__}"
