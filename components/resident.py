"""The mark of a prairie's own entities among a game's."""

from dataclasses import dataclass
from typing import Protocol


class Owner(Protocol):
    """The owner of all entities of one prairie."""

    def note_gone(self, resident: "Resident", /) -> None:
        """Record that an entity's mark is gone, and the entity with it."""


@dataclass(slots=True, eq=False, weakref_slot=True)
class Resident:
    """A component of every entity that a prairie created.

    A game that deletes its entities leaves those with this component alone; the prairie deletes them itself.
    """

    owner: Owner

    entity: int = 0
    """Entity that it marks."""

    def __del__(self) -> None:
        """Notify the owner: only esper refers to a mark, so it is freed as soon as its entity is deleted."""
        self.owner.note_gone(self)
