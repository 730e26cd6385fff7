"""Watching files for changes, without any thread."""

from collections.abc import Iterable
from pathlib import Path

from ..engine.scene import stamp_of


class Watch:
    """Files to watch, and their state at the last check."""

    def __init__(self, paths: Iterable[Path]) -> None:
        self._stamps = {path: stamp_of(path) for path in paths}

    def changed(self) -> bool:
        """Return whether any file has changed since the last check.

        A missing file counts as unchanged: editors that replace a file remove it for a moment.
        """
        now = {path: stamp_of(path) or before for path, before in self._stamps.items()}
        changed = now != self._stamps
        self._stamps = now
        return changed

    def turn_to(self, paths: Iterable[Path]) -> None:
        """Watch these files from now on; the known states of files that were watched before stay."""
        self._stamps = {path: self._stamps.get(path) or stamp_of(path) for path in paths}
