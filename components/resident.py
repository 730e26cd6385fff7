"""What marks a prairie's own entities among a game's."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, eq=False)
class Resident:
    """A component of every entity that a prairie created, one object for all those of one prairie.

    A game that clears up among its entities leaves these alone; the prairie deletes them itself.
    """
