"""Problems of scenes, with position, message and source line."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

MOST_PROBLEMS = 200
"""Greatest number of problems that are reported for one file."""

_WIDEST = 120


@dataclass(frozen=True, slots=True)
class Problem:
    """One fault of a scene; its text is `file:line:column: what`, the line, and a caret.

    For values that a program hands in, the text is `grass.meadow.height: what`; without a file, the message alone.
    """

    file: str
    """Name of the file, as the user gave it; empty where there is none."""

    line: int
    """Number of the line, from 1; without a file, the number of the value."""

    column: int
    """Column of the first character, from 1."""

    message: str
    """Message on the fault, in one sentence."""

    source_line: str = ""
    """The file's line; empty where there is none to show."""

    key: str = ""
    """Path of keys of a value that a program hands in, else empty."""

    def __str__(self) -> str:
        if self.key:
            return f"{printable(self.key)}: {printable(self.message)}"
        if not self.file:
            return printable(self.message)
        head = f"{printable(self.file)}:{self.line}:{self.column}: {printable(self.message)}"
        if not self.source_line:
            return head
        start = max(0, self.column - _WIDEST) and self.column - 1 - _WIDEST // 2
        shown = self.source_line[start : start + _WIDEST]
        before = shown[: self.column - 1 - start]
        pad = "".join("\t" if character == "\t" else " " for character in before)
        return f"{head}\n    {shown}\n    {pad}^"


def printable(text: str, /) -> str:
    """Return a text with the replacement character for each character that cannot be printed on one line."""
    return "".join(character if character.isprintable() else "\N{REPLACEMENT CHARACTER}" for character in text)


class SceneError(ValueError):
    """A scene cannot be read; `problems` holds every problem found, in the order of the file.

    Beyond `MOST_PROBLEMS`, one last problem counts the rest. `more` is the number of problems beyond those given.
    """

    def __init__(self, problems: Iterable[Problem], *, more: int = 0) -> None:
        ordered = sorted(problems, key=lambda problem: (problem.line, problem.column))
        self.problems = ordered[:MOST_PROBLEMS]
        more += len(ordered) - len(self.problems)
        if more:
            last = replace(self.problems[-1], message=f"and {more} more problems", source_line="")
            self.problems.append(last)
        super().__init__("\n".join(map(str, self.problems)))

    def __reduce__(self) -> tuple[Callable[[list[Problem]], "SceneError"], tuple[list[Problem]]]:
        """Return how to unpickle the error: from its problems."""
        return _unpickled, (self.problems,)


def _unpickled(problems: list[Problem]) -> SceneError:
    """Return an error with exactly these problems, the last of which may count others."""
    error = SceneError(problems[:MOST_PROBLEMS])
    error.problems = problems
    error.args = ("\n".join(map(str, problems)),)
    return error
