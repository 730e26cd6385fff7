"""Parsing the bytes of a scene file to its values: YAML by the core schema of version 1.2, within limits."""

import re
from dataclasses import dataclass, replace
from typing import NoReturn

import yaml

from .document import Document, Node, problem_at
from .problem import Problem, SceneError
from .syntax import DEEPEST, TOO_DEEP, explain

MOST_BYTES = 2**20
"""Size of the largest scene file [bytes]."""

MOST_VALUES = 100_000
"""Greatest number of values, each counted as often as aliases repeat it."""

_TOO_BIG = f"a scene file may have {MOST_BYTES} bytes at most"
_UNPRINTABLE = re.compile("[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")

_NULL = frozenset(("", "~", "null", "Null", "NULL"))
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
_LONGEST = 64

Scalar = str | int | float | bool | None


def decode(data: bytes, *, file: str) -> str:
    """Return the text of a scene file, without its byte order mark. Raises SceneError unless it is UTF-8."""
    if len(data) > MOST_BYTES:
        raise SceneError([Problem(file, 1, 1, _TOO_BIG)])
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise SceneError([Problem(file, 1, 1, "the file is UTF-16; save it as UTF-8")])
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = data.removeprefix(b"\xef\xbb\xbf")[: error.start].decode("utf-8", "replace")
        message = f"byte 0x{error.object[error.start]:02x} is not UTF-8; save the file as UTF-8"
        raise SceneError([_after(before, file, message)]) from error


def read_document(text: str, *, file: str) -> Document:
    """Return the values of a YAML text.

    Duplicate keys, keys that are no text, merge keys and tags become its `problems`. Raises SceneError where reading
    cannot go on: broken YAML, control characters, recursion, more than the limits of this module.
    """
    if len(text) > MOST_BYTES:
        raise SceneError([Problem(file, 1, 1, _TOO_BIG)])
    stray = _UNPRINTABLE.search(text)
    if stray:
        message = f"the control character U+{ord(stray[0]):04X} cannot stand in a scene file"
        raise SceneError([_after(text[: stray.start()], file, message)])
    return _Composer(file, text.splitlines()).compose(text)


def _after(before: str, file: str, message: str) -> Problem:
    lines = (before + ".").splitlines()
    return Problem(file, len(lines), len(lines[-1]), message)


class _UnreadableError(Exception):
    """Reading cannot go on; the reason is the last of the problems."""


@dataclass(slots=True, eq=False)
class _Open:
    """A list or mapping whose end has not been parsed yet."""

    node: Node
    anchor: str | None
    key: Node | None = None


class _Composer:
    """Builds nodes from libyaml's events without recursion, so that no nesting can overflow the stack."""

    def __init__(self, file: str, lines: list[str]) -> None:
        self.file, self.lines = file, lines
        self.problems: list[Problem] = []
        self.open: list[_Open] = []
        self.anchors: dict[str, Node | None] = {}
        self.root: Node | None = None
        self.count = 0

    def compose(self, text: str) -> Document:
        try:
            for event in yaml.parse(text, Loader=yaml.CSafeLoader):
                self._take(event)
        except yaml.MarkedYAMLError as error:
            self._report(*explain(error, self.lines))
        except _UnreadableError:
            pass
        else:
            if self.root is not None:
                return Document(self.file, self.lines, self.root, self.problems)
            self._report(0, 0, "the file is empty; a scene begins with 'tallgrass: 2'")
        raise SceneError(self.problems)

    def _take(self, event: yaml.Event) -> None:
        match event:
            case yaml.ScalarEvent():
                self._place(self._scalar(event), event.anchor)
            case yaml.AliasEvent():
                self._place(self._alias(event), None)
            case yaml.MappingStartEvent() | yaml.SequenceStartEvent():
                self._begin(event)
            case yaml.MappingEndEvent() | yaml.SequenceEndEvent():
                ended = self.open.pop()
                if ended.node.flow:
                    ended.node.end = _range(event)[1]
                self._place(ended.node, ended.anchor)
            case yaml.DocumentStartEvent() if self.root is not None:
                self._stop(event, "a scene file holds one document; leave out the second '---'")

    def _scalar(self, event: yaml.ScalarEvent) -> Node:
        node = self._node(event, event.value)
        self._refuse_tag(event)
        if event.implicit[0]:
            try:
                node.data = scalar(event.value)
            except ValueError as error:
                self._report(node.line, node.column, str(error))
        return node

    def _alias(self, event: yaml.AliasEvent) -> Node:
        name = event.anchor
        if name not in self.anchors:
            self._stop(event, f"there is no anchor '&{name}' before this alias")
        node = self.anchors[name]
        if node is None:
            self._stop(event, f"the alias '*{name}' stands inside what it repeats")
        self._limit(event, node.depth, node.count)
        start, end = _range(event)
        return replace(node, start=start, end=end, flow=True)

    def _begin(self, event: yaml.MappingStartEvent | yaml.SequenceStartEvent) -> None:
        node = self._node(event, {} if isinstance(event, yaml.MappingStartEvent) else [])
        node.flow = bool(event.flow_style)
        self._refuse_tag(event)
        if event.anchor:
            self.anchors[event.anchor] = None
        self.open.append(_Open(node, event.anchor))

    def _node(self, event: yaml.NodeEvent, data: object) -> Node:
        self._limit(event, 1, 1)
        return Node(*_place(event), data, *_range(event))

    def _limit(self, event: yaml.Event, depth: int, count: int) -> None:
        self.count += count
        if len(self.open) + depth > DEEPEST:
            self._stop(event, TOO_DEEP)
        if self.count > MOST_VALUES:
            self._stop(event, f"more than {MOST_VALUES} values, counting what aliases repeat")

    def _place(self, node: Node, anchor: str | None) -> None:
        if anchor:
            self.anchors[anchor] = node
        if not self.open:
            self.root = node
            return
        parent = self.open[-1]
        if isinstance(parent.node.data, list):
            self._put(parent.node, len(parent.node.data), node)
        elif parent.key is None:
            parent.key = node
        else:
            self._put_pair(parent.node, parent.key, node)
            parent.key = None

    def _put_pair(self, parent: Node, key: Node, value: Node) -> None:
        name = key.data if isinstance(key.data, str) else str(key.data)
        if key.data != name:  # its value is read all the same, so that what is wrong in it is told too
            self._report(key.line, key.column, "a key must be text; write it in quotes")
        if name == "<<":
            self._report(key.line, key.column, "merge keys ('<<') are not read; write the keys out")
        elif name in parent.keys:
            first = parent.keys[name]
            self._report(key.line, key.column, f"duplicate key '{name}', first at {first.line + 1}:{first.column + 1}")
        else:
            parent.keys[name] = key
            self._put(parent, name, value)

    def _put(self, parent: Node, step: str | int, node: Node) -> None:
        parent.below[step] = node
        parent.depth = max(parent.depth, node.depth + 1)
        parent.count += node.count
        if not parent.flow:
            parent.end = node.end  # libyaml lets it end after the comments that follow
        if isinstance(step, int):
            parent.data.append(node.data)
        else:
            parent.data[step] = node.data

    def _refuse_tag(self, event: yaml.ScalarEvent | yaml.CollectionStartEvent) -> None:
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            message = f"the tag '{tag}' is not read; leave it out, values are plain text and numbers"
            self._report(*_place(event), message)

    def _report(self, line: int, column: int, message: str) -> None:
        self.problems.append(problem_at(self.file, self.lines, line, column, message))

    def _stop(self, event: yaml.Event, message: str) -> NoReturn:
        self._report(*_place(event), message)
        raise _UnreadableError


def _place(event: yaml.Event) -> tuple[int, int]:
    mark = event.start_mark
    return (mark.line, mark.column) if mark else (0, 0)


def _range(event: yaml.Event) -> tuple[int, int]:
    first, last = event.start_mark, event.end_mark
    return (first.index, last.index) if first and last else (0, 0)


def scalar(text: str, /) -> Scalar:
    """Return the value of an unquoted scalar: 1e3 is a number, 017 is 17, and on, off, yes and no are text.

    Raises ValueError for a number of more than 64 characters.
    """
    if text in _NULL:
        return None
    if text in _BOOL:
        return _BOOL[text]
    if text[0] not in "+-.0123456789" or not (_FLOAT.fullmatch(text) or _BASED.fullmatch(text)):
        return text
    if len(text) > _LONGEST:
        raise ValueError(f"a number of {len(text)} characters is too long")
    if _BASED.fullmatch(text):
        return int(text, 0)
    return int(text) if _INT.fullmatch(text) else float(re.sub(r"\.(?=[in])", "", text.lower()))
