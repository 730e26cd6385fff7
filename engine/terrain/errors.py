"""What is wrong with a map."""

from pathlib import Path


class MapError(ValueError):
    """A terrain or density map cannot be used; the message is one sentence that names it and says what is wrong."""

    def __init__(self, path: Path, problem: str) -> None:
        super().__init__(f"{path.name}: {problem}")
