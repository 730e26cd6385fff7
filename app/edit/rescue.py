"""A copy of what is not saved, kept beside the scene until it is: a program may end at any time."""

import logging
from glob import escape
from itertools import count
from pathlib import Path

from .editor import Editor
from .history import Draft

INTERVAL = 10.0
"""Time between two copies [s]."""

log = logging.getLogger("tallgrass")


def rescued(scene: Path, folder: Path, /) -> list[str]:
    """Return the names of copies of a scene that were left in a folder."""
    return sorted(each.name for each in folder.glob(f"{escape(scene.stem)}-rescued*{scene.suffix}"))


class Rescue:
    """Keeps a copy of an editor's draft while it is not saved; a draft that cannot be written is left out."""

    def __init__(self) -> None:
        self._files: list[Path] = []
        """Files of the copy, the scene first."""
        self._draft: Draft | None = None
        """The draft of the copy, or the last one that could not be written."""
        self._age = 0.0

    def step(self, editor: Editor, dt: float) -> None:
        """Copy the draft if it is another one, `INTERVAL` after the last time; `dt` has passed [s]."""
        self._age += dt
        if self._age >= INTERVAL:
            self.keep(editor)

    def keep(self, editor: Editor) -> Path | None:
        """Copy the draft at once, or drop the copy if it is saved; return the copy of the scene, if there is one."""
        self._age, now = 0.0, editor.history.now
        if editor.history.is_saved:
            self.drop()
        elif self._draft is not now:
            self._draft = now
            try:
                self._files = editor.copy(self._name(editor.pen.folder, editor.pen.path))
            except (ValueError, OSError) as error:
                log.debug("no copy is kept", exc_info=error)
        return self._files[0] if self._files else None

    def drop(self) -> None:
        """Delete the copy: it is saved, or given up."""
        for file in self._files:
            file.unlink(missing_ok=True)
        self._files, self._draft = [], None

    def _name(self, folder: Path, scene: Path) -> str:
        """Return the name of the copy: of the one there is, or else one that no file has."""
        if self._files:
            return self._files[0].name
        names = (f"{scene.stem}-rescued{f'-{number}' * (number > 1)}{scene.suffix}" for number in count(1))
        return next(name for name in names if not (folder / name).exists())
