"""Systems of installed packages, found by entry points and imported when a prairie is made."""

import logging
from collections.abc import Callable, Collection, Iterable
from contextlib import AbstractContextManager, nullcontext
from functools import cache
from importlib.metadata import EntryPoint, entry_points

from .complaint import said
from .installed import Installed, Provided, chosen_names, claimed, owners

SYSTEMS = "tallgrass.systems"
"""Entry-point group of systems; an entry's name is the system's, its value a function `bring(prairie)`.

The function adds systems to `prairie.systems`, and returns nothing.
"""

Within = Callable[[str], AbstractContextManager[object]]
"""Returns a context for the name of a system."""

log = logging.getLogger("tallgrass")


class SystemPlugins:
    """Systems of installed packages by name. They are imported when the first prairie is made, and never before.

    Of those installed, `chosen` names the systems or distributions to use; None is all.
    """

    def __init__(self, entries: Iterable[EntryPoint], *, chosen: Collection[str] | None = None) -> None:
        self._installed = Installed(entries, chosen=chosen)
        self._logged: set[str] = set()

    def provided(self) -> list[Provided]:
        """Return all systems in alphabetical order, also those left out, without importing anything."""
        return self._installed.provided()

    def bring(
        self, prairie: object, /, come_back: Callable[[], str] = lambda: "", within: Within = nullcontext
    ) -> None:
        """Let every package add its systems to a prairie, in alphabetical order of their names.

        A package that fails, or a name that two packages claim, is logged and left out. What a package had added before
        it failed stays. `come_back` undoes a change that no package may leave behind, and returns what was done, or "".
        Each package runs inside the context that `within` returns for its name. The same message is logged once, for
        all prairies together.
        """
        for name, entries in sorted(self._installed.used.items()):
            with within(name):
                why = _bring(prairie, name, entries, come_back)
            if why is not None and why not in self._logged:
                self._logged.add(why)
                log.warning("%s", why)


@cache
def system_plugins() -> SystemPlugins:
    """Return the systems of this process: those installed, as the environment chooses."""
    return SystemPlugins(entry_points(group=SYSTEMS), chosen=chosen_names())


def bring_systems(prairie: object, /, come_back: Callable[[], str], within: Within) -> None:
    """Let every installed package add its systems to a prairie that is being made; it has its `systems` already."""
    system_plugins().bring(prairie, come_back, within)


def _bring(prairie: object, name: str, entries: list[EntryPoint], come_back: Callable[[], str]) -> str | None:
    """Let a package add its system; return why it cannot, or None."""
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
        come_back()
        return f"{what} cannot be added: {said(error)}; it is left out"
    left = come_back()
    return f"{what} {left}; the prairie's own is current again" if left else None
