"""The values of a scene as a tree of nodes with positions."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from .problem import Problem

_LONGEST = 400

Where = Sequence[str | int]
"""Path from the root to a value, as in `("wind", 0, "kind")`."""


@dataclass(slots=True, eq=False)
class Node:
    """A value of the file."""

    line: int
    """Number of its line, from 0."""

    column: int
    """Column of its first character, from 0."""

    data: Any
    """Plain value: text, number, true, false, null, list or mapping."""

    start: int = 0
    """Index of its first character in the text."""

    end: int = 0
    """Index after its last character; a block ends where its last value does."""

    below: dict[str | int, "Node"] = field(default_factory=dict)
    """Values of a mapping by key, or of a list by index."""

    keys: dict[str, "Node"] = field(default_factory=dict)
    """Keys of a mapping."""

    depth: int = 1
    """Number of levels, itself included."""

    count: int = 1
    """Number of values, itself included, each as often as aliases repeat it."""

    flow: bool = False
    """Whether it is in flow style, in brackets or braces, or an alias."""


def noded(data: Any, old: Node, /) -> Node:
    """Return plain values as nodes with the positions of `old` nodes at the same paths, or of their nearest parents."""
    node = Node(old.line, old.column, data)
    if isinstance(data, dict):
        node.keys = {key: noded(key, old.keys.get(key, old)) for key in data}
    inner = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    node.below = {step: noded(value, old.below.get(step, old)) for step, value in inner}
    return node


@dataclass(frozen=True, slots=True, eq=False)
class Document:
    """The values of a scene, and the problems found while parsing."""

    file: str | None
    """Name of the file, as the user gave it; None for values that a program hands in."""

    lines: list[str]
    root: Node
    problems: list[Problem]

    def node(self, where: Where) -> Node:
        """Return the value at the path `where`; steps that the file does not have are skipped."""
        node = self.root
        for step in where:
            node = node.below.get(step, node)
        return node

    def problem(self, where: Where, message: str, *, at_key: bool = False) -> Problem:
        """Return a problem positioned at the value at the path `where`, or at its key."""
        node = self.node(where)
        if at_key and where:
            node = self.node(where[:-1]).keys.get(str(where[-1]), node)
        if self.file is None:
            return Problem("", node.line + 1, 1, _one_line(message), key=key_path(self._found(where)))
        return problem_at(self.file, self.lines, node.line, node.column, message)

    def _found(self, where: Where) -> Where:
        """Return those steps of a path that exist."""
        node, found = self.root, list[str | int]()
        for step in where:
            if step in node.below:
                node = node.below[step]
                found.append(step)
        return found


def key_path(where: Where, /) -> str:
    """Return a path as messages on a program's values write it: `wind[0].speed`."""
    return "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in where).lstrip(".") or "the scene"


def problem_at(file: str, lines: list[str], line: int, column: int, message: str) -> Problem:
    """Return a problem at a line and column, counted from 0; its message is cut to one line of a sensible length."""
    return Problem(file, line + 1, column + 1, _one_line(message), lines[line] if line < len(lines) else "")


def _one_line(message: str) -> str:
    text = " ".join(message.split())
    return text if len(text) <= _LONGEST else text[:_LONGEST] + "..."
