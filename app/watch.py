"""Watching files for changes, without any thread."""

from collections.abc import Iterable
from pathlib import Path

from ..engine.scene import stamp_of


class Watch:
    """Some files, and what they were like when they were last looked at."""

    def __init__(self, paths: Iterable[Path]) -> None:
        self._stamps = {path: stamp_of(path) for path in paths}

    def changed(self) -> bool:
        """Return whether any of them has changed since it was last looked at.

        One that is missing has not: editors that replace a file leave none for a moment.
        """
        now = {path: stamp_of(path) or before for path, before in self._stamps.items()}
        changed = now != self._stamps
        self._stamps = now
        return changed

    def turn_to(self, paths: Iterable[Path]) -> None:
        """Watch these files from now on; what is known of those that were watched before still counts."""
        self._stamps = {path: self._stamps.get(path) or stamp_of(path) for path in paths}
