"""Entry points of installed packages: which of them are used, and which distribution brings each."""

import os
import re
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib.metadata import Distribution, EntryPoint
from typing import Literal

CHOSEN = "TALLGRASS_PLUGINS"
"""Environment variable with the installed kinds, systems or distributions to use, as in `a,b`.

Without it all are used; if it is empty, none but those of tallgrass itself, which are always used.
"""

OURS = "tallgrass"
"""Distribution of the built-in entries."""

Status = Literal["ready", "claimed twice", "name taken", "left out"]
"""State of an entry, known without importing it."""


@dataclass(frozen=True, slots=True)
class Provided:
    """A kind of wind or a system, and who brings it."""

    name: str
    """Name of its entry point; of a kind, its name in scene files."""

    distribution: str
    """Distribution that brings it, or module and name of a game's own class."""

    version: str
    """Version of the distribution; "" for a game's own class."""

    status: Status
    """`ready` to be imported, `claimed twice`, `name taken` by a built-in one, or `left out` by the environment."""


class Installed:
    """The entry points of a group by name: those in use, those whose name is taken, and those left out.

    `chosen` are names of entries or distributions to use in addition to those of tallgrass; None is all. The names of
    tallgrass's own entries are taken: other entries of the same name are not used, so that no package breaks what is
    built in.
    """

    def __init__(self, entries: Iterable[EntryPoint], *, chosen: Collection[str] | None) -> None:
        self.used: dict[str, list[EntryPoint]] = {}
        self.left_out: dict[str, list[EntryPoint]] = {}
        for entry in entries:
            entries_by_name = self.used if _is_chosen(entry, chosen) else self.left_out
            entries_by_name.setdefault(entry.name, []).append(entry)
        self.taken: dict[str, list[EntryPoint]] = {}
        for name, used in self.used.items():
            ours = [entry for entry in used if owner(entry)[0] == OURS]
            if ours and len(ours) < len(used):
                self.used[name], self.taken[name] = ours, [entry for entry in used if owner(entry)[0] != OURS]

    def all(self) -> list[EntryPoint]:
        """Return all entries, those left out last."""
        groups = (self.used, self.taken, self.left_out)
        return [entry for group in groups for entries in group.values() for entry in entries]

    def provided(self, *others: Provided) -> list[Provided]:
        """Return all entries and `others` in alphabetical order, also those left out, without importing anything."""
        rows = [Provided(entry.name, *owner(entry), self.status(entry)) for entry in self.all()]
        return sorted([*rows, *others], key=lambda row: (row.name, row.status, row.distribution))

    def status(self, entry: EntryPoint) -> Status:
        """Return the state of an entry, without importing it."""
        used = self.used.get(entry.name, [])
        if _has(used, entry):
            return "ready" if len(used) == 1 else "claimed twice"
        return "name taken" if _has(self.taken.get(entry.name, []), entry) else "left out"


def chosen_names() -> list[str] | None:
    """Return the names to use by the environment; None is all."""
    chosen = os.environ.get(CHOSEN)
    return None if chosen is None else [name for part in chosen.split(",") if (name := part.strip())]


def unknown_names(chosen: Collection[str] | None, entries: Iterable[EntryPoint]) -> list[str]:
    """Return the chosen names that no entry and no distribution of these entries has, in alphabetical order."""
    known = {name for entry in entries for name in _names(entry)}
    return sorted({_normal(name) for name in chosen or ()} - known)


def owner(entry: EntryPoint) -> tuple[str, str]:
    """Return the distribution that brings an entry, and its version."""
    return _name_and_version(entry.dist) if entry.dist else (f"the entry point {entry.value}", "")


@lru_cache(maxsize=64)
def _name_and_version(distribution: Distribution) -> tuple[str, str]:
    """Return a distribution's name and version; cached, as each access reads the metadata file again."""
    return distribution.name or "a distribution without a name", distribution.version or ""


def owners(entries: list[EntryPoint]) -> str:
    """Return the distributions that bring entries and their versions, joined by "and" for a sentence."""
    return " and ".join(" ".join(owner(entry)).strip() for entry in entries)


def claimed(what: str, entries: list[EntryPoint]) -> str:
    """Return the message on several entries of one name."""
    choice = f"uninstall all but one of them, or name it in {CHOSEN}"
    return f"{what} is claimed by {owners(entries)}; {choice}"


def outdone(what: str, entries: list[EntryPoint]) -> str:
    """Return the message on entries that have the name of something built in."""
    names = " and ".join(owner(entry)[0] for entry in entries)
    choice = f"uninstall {names}, or leave it out by {CHOSEN}, which names what to use"
    return f"{what} is built in, and the one of {owners(entries)} is not used; {choice}"


def _has(entries: list[EntryPoint], entry: EntryPoint) -> bool:
    """Return whether this very object is among entries: equal entries may be of two distributions."""
    return any(entry is other for other in entries)


def _is_chosen(entry: EntryPoint, chosen: Collection[str] | None) -> bool:
    if chosen is None or owner(entry)[0] == OURS:
        return True
    return not _names(entry).isdisjoint(_normal(name) for name in chosen)


def _names(entry: EntryPoint) -> set[str]:
    return {_normal(entry.name), _normal(owner(entry)[0])}


def _normal(name: str) -> str:
    """Return a name normalised as package indexes do."""
    return re.sub(r"[-_.]+", "-", name).lower()
