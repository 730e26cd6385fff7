"""Scenes that a program hands in as values; problems name the path of keys."""

from collections.abc import Mapping
from pathlib import PurePath
from reprlib import repr as shortened
from typing import Any

import numpy as np

from ...components.declaration import Declaration
from ...components.wind import WindPrimitive
from .compose import MOST_VALUES
from .document import Document, Node, Where, key_path
from .problem import Problem, SceneError
from .syntax import DEEPEST, TOO_DEEP


def values_document(values: Mapping[Any, Any] | Declaration, /) -> Document:
    """Return the values of a program as a document with paths of keys for positions, such as `grass.meadow.height`.

    Keys that are no text become its `problems`. Raises SceneError for values that are too many or too deep.
    """
    reading = _Reading()
    root = reading.node(values, ())
    return Document(None, [], root, reading.problems)


class _Reading:
    """Turns values into numbered nodes, so that problems can be sorted."""

    def __init__(self) -> None:
        self.problems: list[Problem] = []
        self._count = 0

    def node(self, value: Any, where: Where) -> Node:
        data = _plain(value)
        node = Node(self._count, 0, data)
        self._count += 1
        if len(where) >= DEEPEST:
            self._stop(where[:1], TOO_DEEP)
        if self._count > MOST_VALUES:
            self._stop(where[:1], f"more than {MOST_VALUES} values")
        if isinstance(data, dict):
            node.data = {}
            for key, inner in data.items():
                name = key if isinstance(key, str) and _is_unicode(key) else shortened(key)
                below = self.node(inner, (*where, name))
                if name != key:  # its value is read all the same, so that what is wrong in it is told too
                    problem = f"a key must be {'Unicode ' if isinstance(key, str) else ''}text, found {name}"
                    self.problems.append(Problem("", below.line + 1, 1, problem, key=key_path(where)))
                node.below[name] = node.keys[name] = below
                node.data[name] = below.data
        elif isinstance(data, list):
            node.below = {step: self.node(inner, (*where, step)) for step, inner in enumerate(data)}
            node.data = [below.data for below in node.below.values()]
        elif isinstance(data, str) and not _is_unicode(data):
            self.problems.append(self._problem(where, f"text must be Unicode, found {shortened(data)}"))
            node.data = data.encode(errors="replace").decode()
        return node

    def _problem(self, where: Where, message: str) -> Problem:
        return Problem("", self._count, 1, message, key=key_path(where))

    def _stop(self, where: Where, message: str) -> None:
        raise SceneError([*self.problems, self._problem(where, message)])


def _is_unicode(text: str) -> bool:
    """Return whether a text has no half of a surrogate pair: no file can hold one, neither a saved game."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _plain(value: Any) -> Any:
    """Return a value of a program's type as the type that a scene file gives; winds and arrays stay as they are."""
    match value:
        case Declaration() if not isinstance(value, WindPrimitive):
            return {name: getattr(value, name) for name in type(value).model_fields if name in value.model_fields_set}
        case Mapping():
            return dict(value)
        case tuple():
            return list(value)
        case np.generic():
            return value.item()
        case PurePath():
            return str(value)
    return value
