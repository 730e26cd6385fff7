"""What marks a prairie's own entities among a game's."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Resident:
    """A component of every entity that a prairie created.

    A game that clears up among its entities leaves these alone; the prairie deletes them itself.
    """

    owner: object
    """One object for all the entities of one prairie."""
