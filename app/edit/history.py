"""What is edited, and every state that it was in: undo and redo of everything."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ...engine.terrain.density import Picture

MOST_STEPS = 500
"""Most steps that can be undone."""


@dataclass(frozen=True, slots=True, eq=False)
class Draft:
    """A scene as it is being edited; no part of it is ever changed in place."""

    values: dict[str, Any]
    """What its file says."""

    pictures: Mapping[str, Picture] = field(default_factory=dict)
    """The density maps that have been painted, by the names that the scene calls them."""


class History:
    """The drafts of a scene one after the other, and which of them counts."""

    def __init__(self, draft: Draft) -> None:
        self._drafts = [draft]
        self._at = 0
        self._saved: Draft | None = draft
        self._subject: object = None

    @property
    def now(self) -> Draft:
        """The draft that counts."""
        return self._drafts[self._at]

    @property
    def is_saved(self) -> bool:
        """Whether the draft that counts is what was saved last."""
        return self.now is self._saved

    @property
    def can_undo(self) -> bool:
        """Whether there is a draft before."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether a draft was undone."""
        return self._at + 1 < len(self._drafts)

    def change(self, draft: Draft, *, subject: object) -> None:
        """Go on with another draft; changes of one subject in a row are one step, until `rest`."""
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
        """Go on to what was undone; return whether there was something."""
        return self._go(1, possible=self.can_redo)

    def save(self) -> None:
        """Remember that the draft that counts is saved."""
        self._saved = self.now
        self.rest()

    def _go(self, way: int, *, possible: bool) -> bool:
        self.rest()
        self._at += way * possible
        return possible
