"""What marks a prairie's own entities among a game's."""

from dataclasses import dataclass
from typing import Protocol


class Owner(Protocol):
    """One object for all the entities of one prairie."""

    def note_gone(self, resident: "Resident", /) -> None:
        """Take note that an entity's mark has gone, and the entity with it."""


@dataclass(slots=True, eq=False, weakref_slot=True)
class Resident:
    """A component of every entity that a prairie created.

    A game that clears up among its entities leaves these alone; the prairie deletes them itself.
    """

    owner: Owner

    entity: int = 0
    """The entity that it marks."""

    def __del__(self) -> None:
        """Tell the owner: nobody but esper holds a mark, so it goes in the moment that its entity is deleted."""
        self.owner.note_gone(self)
