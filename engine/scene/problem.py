"""Problems of scenes: where, what, and the line itself."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

MOST_PROBLEMS = 200
"""Most problems told of one file."""

_WIDEST = 120


@dataclass(frozen=True, slots=True)
class Problem:
    """One thing wrong in a scene; its text is `file:line:column: what`, the line, and a caret.

    Of values that a program hands in, it is `grass.meadow.height: what`; where there is no file, the sentence alone.
    """

    file: str
    """The file, as the person called it; empty where there is none."""

    line: int
    """From 1; without a file, the number of the value."""

    column: int
    """From 1, in characters."""

    message: str
    """What is wrong, in one sentence."""

    source_line: str = ""
    """The line as it stands in the file; empty where there is none to show."""

    key: str = ""
    """The path of keys that leads to it, of a value that a program hands in."""

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
    """Return a text with a mark for each character that cannot be printed on one line."""
    return "".join(character if character.isprintable() else "\N{REPLACEMENT CHARACTER}" for character in text)


class SceneError(ValueError):
    """A scene cannot be read; `problems` holds every problem found, in the order of the file.

    Of very many problems it holds the first `MOST_PROBLEMS`, and one that counts the rest. To make one, `more` says how
    many there are beside those given.
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
        """Go from one process to another as the problems that it holds."""
        return _again, (self.problems,)


def _again(problems: list[Problem]) -> SceneError:
    """Return an error with just these problems, of which the last may count others."""
    error = SceneError(problems[:MOST_PROBLEMS])
    error.problems = problems
    error.args = ("\n".join(map(str, problems)),)
    return error
