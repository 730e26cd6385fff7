"""Planting: the grass shown is put on the ground, and its receivers become entities."""

from collections.abc import Iterable
from dataclasses import dataclass
from operator import is_

from ..engine.world import World
from .around.outlook import Outlook
from .show.representation import Representation


@dataclass(frozen=True, slots=True, eq=False)
class _Planted:
    """State of an outlook for which everything shown was planted and had its entities."""

    things: tuple[object, ...] = ()
    """Objects that must be the same ones."""

    counts: tuple[int, ...] = ()
    """Counts of changes that must be equal."""


@dataclass(slots=True)
class Plant:
    """The system `plant`: plants patches that are shown for the first time, or in another way."""

    outlooks: Iterable[Outlook]
    representations: tuple[Representation, ...]
    world: World

    def run(self) -> None:
        """Plant for every viewer that looks."""
        for outlook in self.outlooks:
            last, now = outlook.noted(_Planted, _Planted()), self._state(outlook)
            if last.counts != now.counts or not all(map(is_, last.things, now.things)):
                self._run(outlook)

    def _run(self, outlook: Outlook) -> None:
        for representation in self.representations:
            representation.plant(outlook)
        for kept in outlook.kept.values():
            kept.enlist(self.world, outlook.patches)
        is_done = all(kept.is_listed for kept in outlook.kept.values())
        outlook.note(self._state(outlook) if is_done else _Planted())

    def _state(self, outlook: Outlook) -> _Planted:
        kept = [*outlook.kept.values()]
        counts = outlook.entity_changes, len(kept), len(outlook.shown), *(each.planted for each in kept)
        return _Planted((self, *kept, *outlook.shown.values()), counts)
