"""The registry of wind kinds: built-in ones, installed ones and a game's own."""

import logging
import re
from collections.abc import Callable, Collection, Iterable
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from inspect import isabstract
from typing import TypeVar

from ..components.wind import INTERFACE, WindPrimitive
from ..components.words import guess
from .complaint import said
from .installed import CHOSEN, OURS, Installed, Provided, chosen_names, claimed, outdone, owner, owners, unknown_names
from .plugged import SYSTEMS

GROUP = "tallgrass.wind"
"""Entry-point group of wind kinds; an entry's name is the `kind:` of scene files, its value a class."""

log = logging.getLogger("tallgrass")

KIND = re.compile(r"[a-z][a-z0-9_-]*")
_W = TypeVar("_W", bound=WindPrimitive)


class PluginError(ValueError):
    """A kind is unknown, claimed twice or broken; the message is one sentence that names its package."""


class NewerError(PluginError):
    """A kind is written for a newer tallgrass."""


class WindKinds:
    """Wind kinds by name. A class is imported when its kind is first asked for, and never before.

    `chosen` names the installed kinds or distributions to use in addition to those of tallgrass; None is all. It may
    also name entries of `others`, which are no winds.
    """

    def __init__(
        self, entries: Iterable[EntryPoint], *, chosen: Collection[str] | None = None, others: Iterable[EntryPoint] = ()
    ) -> None:
        self._installed = Installed(entries, chosen=chosen)
        self._entries = self._installed.used
        self._classes: dict[str, type[WindPrimitive]] = {}
        self._ours = frozenset(entry.value for entry in self._installed.all() if owner(entry)[0] == OURS)
        self._are_ours: dict[type[WindPrimitive], bool] = {}
        for name in unknown_names(chosen, [*self._installed.all(), *others]):
            log.warning("%s names '%s', but no such kind, system or distribution is installed", CHOSEN, name)

    def provided(self) -> list[Provided]:
        """Return all kinds in alphabetical order, also those left out, without importing anything."""
        own = {kind: each for kind, each in self._classes.items() if kind not in self._entries}
        return self._installed.provided(*(Provided(kind, _address(each), "", "ready") for kind, each in own.items()))

    def origin(self, primitive: WindPrimitive, /) -> str:
        """Return who brings a wind: a distribution and its version, or the module and name of a game's own class."""
        entries = self._entries.get(primitive.kind, [])
        if len(entries) == 1 and type(primitive) is self._classes.get(primitive.kind):
            return owners(entries)
        return _address(type(primitive))

    def is_ours(self, primitive: type[WindPrimitive], /) -> bool:
        """Return whether a class of winds is tallgrass's own, without importing anything."""
        known = self._are_ours.get(primitive)
        if known is None:
            known = self._are_ours[primitive] = f"{primitive.__module__}:{primitive.__qualname__}" in self._ours
        return known

    def names(self) -> list[str]:
        """Return the kinds that a scene may use, in alphabetical order, without importing anything."""
        return sorted(self._entries.keys() | self._classes.keys())

    def add(self, kind: str, primitive: type[WindPrimitive]) -> None:
        """Add a game's own kind; a class of the same module and name replaces itself, for reloading.

        Raises PluginError when the name is malformed, or is already another class's or a distribution's.
        """
        if not KIND.fullmatch(kind):
            raise PluginError(f"a kind is written in lower-case letters, digits, - and _, unlike '{kind}'")
        _must_be_primitive(primitive, f"the class for kind '{kind}'")
        if kind in self._entries:
            raise PluginError(f"kind '{kind}' already comes with {owners(self._entries[kind])}")
        other = self._classes.get(kind, primitive)
        if _address(other) != _address(primitive):
            raise PluginError(f"kind '{kind}' is claimed by both {_address(other)} and {_address(primitive)}")
        self._classes[kind] = _named(primitive, kind)

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
            raise PluginError(claimed(f"kind '{kind}'", entries))
        if kind in self._installed.taken:
            log.warning("%s", outdone(f"kind '{kind}'", self._installed.taken[kind]))
        try:
            loaded = entries[0].load()
        except (Exception, SystemExit) as error:  # importing a plugin runs its code, which may do anything
            raise PluginError(f"kind '{kind}' of {owners(entries)} cannot be loaded: {said(error)}") from error
        return _named(_must_be_primitive(loaded, f"kind '{kind}' of {owners(entries)}"), kind)

    def _unknown(self, kind: str) -> str:
        left_out = self._installed.left_out
        if kind in left_out:
            return f"kind '{kind}' of {owners(left_out[kind])} is left out: {CHOSEN} does not name it"
        near = guess(kind, self.names()) or ";"
        return f"unknown kind '{kind}'{near} known: {', '.join(self.names()) or 'none'}"


@cache
def wind_kinds() -> WindKinds:
    """Return the kinds of this process: those that are installed and chosen by the environment, and those of `wind`."""
    others = entry_points(group=SYSTEMS)
    return WindKinds(entry_points(group=GROUP), chosen=chosen_names(), others=others)


def wind(kind: str) -> Callable[[type[_W]], type[_W]]:
    """Return a class decorator that makes a game's own wind primitive a `kind:` of scene files.

    Raises PluginError when the kind is taken, and when the class is no complete `WindPrimitive`.
    """
    if not isinstance(kind, str):
        raise PluginError("a wind is registered by its kind, as @wind('ripple'), not by @wind alone")

    def added(primitive: type[_W]) -> type[_W]:
        wind_kinds().add(kind, primitive)
        return primitive

    return added


def _must_be_primitive(thing: object, what: str) -> type[WindPrimitive]:
    if not (isinstance(thing, type) and issubclass(thing, WindPrimitive)):
        raise PluginError(f"{what} must be a class that derives from WindPrimitive")
    if isabstract(thing):
        raise PluginError(f"{what} lacks {' and '.join(sorted(thing.__abstractmethods__))}")
    if not isinstance(thing.interface, int):
        raise PluginError(f"{what} has the interface {thing.interface!r}, which is no whole number")
    if thing.interface != INTERFACE:
        refusal = NewerError if thing.interface > INTERFACE else PluginError
        raise refusal(f"{what} is written for interface {thing.interface} of winds; this tallgrass has {INTERFACE}")
    return thing


def _named(primitive: type[WindPrimitive], kind: str) -> type[WindPrimitive]:
    """Set the kind of a class that does not declare its `kind` to the one it is registered as; return the class."""
    field = primitive.model_fields["kind"]
    if field.is_required():
        field.default = kind
        primitive.model_rebuild(force=True)
    return primitive


def _address(primitive: type) -> str:
    return f"{primitive.__module__}.{primitive.__qualname__}"
