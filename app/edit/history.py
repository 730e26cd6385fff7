"""The draft of a scene and its history: undo and redo."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ...engine.terrain.density import Picture

MOST_STEPS = 500
"""Largest number of steps that can be undone."""


@dataclass(frozen=True, slots=True, eq=False)
class Draft:
    """A scene as it is being edited; no part of it is ever changed in place."""

    values: dict[str, Any]
    """Values of its file."""

    pictures: Mapping[str, Picture] = field(default_factory=dict)
    """Painted density maps, by their names in the scene."""


class History:
    """The drafts of a scene in their order, and the current one."""

    def __init__(self, draft: Draft) -> None:
        self._drafts = [draft]
        self._at = 0
        self._saved: Draft | None = draft
        self._subject: object = None

    @property
    def now(self) -> Draft:
        """The current draft."""
        return self._drafts[self._at]

    @property
    def is_saved(self) -> bool:
        """Whether the current draft was saved last."""
        return self.now is self._saved

    @property
    def can_undo(self) -> bool:
        """Whether there is an earlier draft."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is an undone draft."""
        return self._at + 1 < len(self._drafts)

    def change(self, draft: Draft, *, subject: object) -> None:
        """Make another draft the current one; successive changes of one subject are one step, until `rest`."""
        joins = subject is not None and subject == self._subject and self.can_undo and not self.can_redo
        kept = self._drafts[: self._at + (not joins)]
        self._drafts = [*kept[-MOST_STEPS:], draft]
        self._at, self._subject = len(self._drafts) - 1, subject

    def rest(self) -> None:
        """Let the next change be a step of its own: the slider or the mouse was let go."""
        self._subject = None

    def undo(self) -> bool:
        """Go back a step; return whether there was one."""
        return self._go(-1, possible=self.can_undo)

    def redo(self) -> bool:
        """Go to the step that was undone; return whether there was one."""
        return self._go(1, possible=self.can_redo)

    def save(self) -> None:
        """Note that the current draft is saved."""
        self._saved = self.now
        self.rest()

    def _go(self, step: int, *, possible: bool) -> bool:
        self.rest()
        self._at += step * possible
        return possible
