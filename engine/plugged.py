"""Systems that installed packages bring: found by their entry points, imported when a prairie is made."""

import logging
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import EntryPoint, entry_points

from .complaint import said
from .installed import Installed, Status, chosen_names, claimed, owner, owners

SYSTEMS = "tallgrass.systems"
"""The entry-point group of systems; an entry's name is the system's, its value a function `bring(prairie)`.

It adds to `prairie.systems` what there is to add, and returns nothing.
"""

log = logging.getLogger("tallgrass")


@dataclass(frozen=True, slots=True)
class ProvidedSystem:
    """A system and the distribution that brings it."""

    system: str
    """What its entry point is called."""

    distribution: str
    """What brings it."""

    version: str
    """Version of the distribution."""

    status: Status
    """`ready` to be imported, `claimed twice`, `name taken` by a built-in one, or `left out` by the environment."""


class SystemPlugins:
    """Systems of installed packages by name. They are imported when the first prairie is made, and never before.

    Of those installed, `chosen` names the systems or distributions to use; None is all.
    """

    def __init__(self, entries: Iterable[EntryPoint], *, chosen: Collection[str] | None = None) -> None:
        self._installed = Installed(entries, chosen=chosen)
        self._told: set[str] = set()

    def provided(self) -> list[ProvidedSystem]:
        """Return who brings which system, in alphabetical order, those left out too; nothing is imported for it."""
        installed = self._installed
        rows = [ProvidedSystem(entry.name, *owner(entry), installed.status(entry)) for entry in installed.all()]
        return sorted(rows, key=lambda row: (row.system, row.status, row.distribution))

    def bring(self, prairie: object, /) -> None:
        """Let every package add its systems to a prairie, in alphabetical order of their names.

        One that cannot, or that has its name from two packages, is named in the log and left out. What it had added
        before it failed stays. The same sentence is told once, however many prairies there are.
        """
        for name, entries in sorted(self._installed.used.items()):
            why = _bring(prairie, name, entries)
            if why is not None and why not in self._told:
                self._told.add(why)
                log.warning("%s", why)


@cache
def system_plugins() -> SystemPlugins:
    """Return the systems of this process: those installed, as the environment chooses."""
    return SystemPlugins(entry_points(group=SYSTEMS), chosen=chosen_names())


def bring_systems(prairie: object, /) -> None:
    """Let every installed package add its systems to a prairie that is being made; it has its `systems` already."""
    system_plugins().bring(prairie)


def _bring(prairie: object, name: str, entries: list[EntryPoint]) -> str | None:
    """Let a package add its system, and return why it cannot."""
    if len(entries) > 1:
        twice = claimed(f"system '{name}'", entries)
        return f"{twice}; none is used"
    what = f"system '{name}' of {owners(entries)}"
    try:
        bring = entries[0].load()
    except (Exception, SystemExit) as error:  # noqa: BLE001 - importing a plugin runs its code, which may do anything
        return f"{what} cannot be loaded: {said(error)}; it is left out"
    if isinstance(bring, type) or not callable(bring):
        return f"{what} must be a function that takes the prairie; it is left out"
    try:
        bring(prairie)
    except (Exception, SystemExit) as error:  # a plugin may do anything
        log.debug("%s", name, exc_info=error)
        return f"{what} cannot be added: {said(error)}; it is left out"
    return None
