"""The error of unusable maps."""

from pathlib import Path


class MapError(ValueError):
    """A terrain or density map cannot be used; the message is one sentence that names its file and says what is wrong.

    An array that a program hands in has no file.
    """

    def __init__(self, path: Path | None, problem: str) -> None:
        super().__init__(problem if path is None else f"{path.name}: {problem}")
