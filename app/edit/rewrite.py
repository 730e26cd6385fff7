"""Writing changed values back into a YAML text, without touching any other character."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import compress
from typing import Any

import yaml

from ...engine.scene import SceneError
from ...engine.scene.compose import read_document
from .values import yaml_text

Splice = tuple[int, int, str]
"""A replacement: the index of its first character, the index after its last, and the new text."""

GONE = NEW = 0.55
"""Costs of removing and of adding an item: together more than the largest cost of altering one."""


@dataclass(slots=True, eq=False)
class Span:
    """The range of a value in the text."""

    start: int
    """Index of its first character."""

    end: int
    """Index after its last character."""

    column: int
    """Number of characters before it on its line."""

    data: Any = None
    """The value itself."""

    flow: bool = False
    """Whether it is in flow style, in brackets or braces."""

    items: list["Span"] = field(default_factory=list)
    """Values of a mapping or a list, in their order."""

    keys: dict[str, "Span"] = field(default_factory=dict)
    """Spans of a mapping's keys, by key."""

    def value(self, key: str) -> "Span":
        """Return the span of a mapping's value by its key."""
        return self.items[list(self.keys).index(key)]


def spans(text: str, /) -> Span:
    """Return the spans of a YAML text; raises what `read_document` raises for its problems."""
    data = read_document(text, file="").root.data
    events = [event for event in yaml.parse(text, Loader=yaml.CSafeLoader) if isinstance(event, _COUNT)]
    return _Spans(events).read(data)


_COUNT = (yaml.NodeEvent, yaml.CollectionEndEvent)


class _Spans:
    """Makes spans from YAML events in their order; their values are known already."""

    def __init__(self, events: list[Any]) -> None:
        self.events, self.at = events, 0

    def read(self, data: Any) -> Span:
        event = self._next()
        found = Span(event.start_mark.index, event.end_mark.index, event.start_mark.column, data)
        if isinstance(event, yaml.CollectionStartEvent):
            found.flow = bool(event.flow_style)
            self._fill(found, event)
        return found

    def _fill(self, found: Span, event: yaml.CollectionStartEvent) -> None:
        while not isinstance(self.events[self.at], yaml.CollectionEndEvent):
            if isinstance(event, yaml.SequenceStartEvent):
                found.items.append(self.read(found.data[len(found.items)]))
                continue
            key = self.events[self.at].value
            found.keys[key] = self.read(key)
            found.items.append(self.read(found.data[key]))
        closed = self._next()
        if found.flow:
            found.end = closed.end_mark.index
        elif found.items:
            found.end = found.items[-1].end  # libyaml lets it end after the comments that follow

    def _next(self) -> Any:
        self.at += 1
        return self.events[self.at - 1]


class RewriteError(ValueError):
    """A change that cannot be written; its text has the reason and the remedy."""


def rewritten(text: str, values: dict[str, Any], /) -> str:
    """Return a YAML text changed to read as `values`; comments, order, quotes and spaces of all else stay.

    `read_document` must be able to read the text. Raises RewriteError where the change cannot be written.
    """
    splices = sorted(_splices(text, spans(text), values), key=lambda splice: splice[:2])
    result = text
    for start, end, new in reversed(splices):  # from the back; of several at one index the first one stands first
        result = result[:start] + new + result[end:]
    try:
        read = read_document(result, file="").root.data
    except SceneError as error:
        raise RewriteError(_NOT_HERE) from error
    if not _same(read, values):
        raise RewriteError(_NOT_HERE)
    return result


_NOT_HERE = "what was changed is written once and used at several places (& and *): change it in the file itself"


def _same(one: Any, other: Any) -> bool:
    """Return whether two values are equal in the digits that are written."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(value, other[key]) for key, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return yaml_text(one) == yaml_text(other)


def _splices(text: str, span: Span, value: Any, key: Span | None = None) -> Iterator[Splice]:
    """Yield the splices that make the text of `span` read as `value`; `key` is the span of its key in a mapping."""
    if _same(span.data, value):
        return
    if isinstance(span.data, dict) and isinstance(value, dict) and span.keys.keys() & value.keys():
        yield from _mapping(text, span, value)
    elif isinstance(span.data, list) and isinstance(value, list) and span.items and value:
        yield from _list(text, span, value)
    else:
        yield from _replacement(text, span, value, key)


def _replacement(text: str, span: Span, value: Any, key: Span | None) -> Iterator[Splice]:
    new = yaml_text(value)
    if isinstance(value, str) and text[span.start : span.start + 1] == "'" and "'" not in value and value.isprintable():
        new = f"'{value}'"
    if key is not None and span.items and not span.flow:  # a block: comments may stand beside its key
        colon = text.index(":", key.end) + 1
        yield colon, colon, " " + new
        yield _line_start(text, span.start), _line_end(text, span.end), ""
    else:
        end = span.start + len(text[span.start : span.end].rstrip())  # a block text spans its last line break
        yield span.start, end, " " + new if text[span.start - 1 : span.start] in (":", "-") else new


def _mapping(text: str, span: Span, value: dict[str, Any]) -> Iterator[Splice]:
    for key, where in span.keys.items():
        if key in value:
            yield from _splices(text, span.value(key), value[key], where)
    starts = [each.start for each in span.keys.values()]
    for first, last in _runs([key not in value for key in span.keys]):
        yield _removal(text, span, starts, first, last)
    new = [f"{yaml_text(key)}: {yaml_text(each)}" for key, each in value.items() if key not in span.keys]
    if new:
        yield _addition(text, span, new)


def _list(text: str, span: Span, value: list[Any]) -> Iterator[Splice]:
    starts = [item.start if span.flow else _dash(text, item) for item in span.items]
    stays = _staying([item.data for item in span.items], value)
    for first, last in _runs([not each for each in stays]):
        yield _removal(text, span, starts, first, last)
    for item, new in zip(compress(span.items, stays), value, strict=False):
        yield from _splices(text, item, new)
    added = [yaml_text(item) for item in value[sum(stays) :]]
    if added:
        yield _addition(text, span, added if span.flow else [f"- {each}" for each in added])


def _runs(gone: list[bool]) -> Iterator[tuple[int, int]]:
    """Yield the runs of entries that are gone, each as its first index and the index after its last."""
    first = None
    for number, each in enumerate([*gone, False]):
        if each and first is None:
            first = number
        elif not each and first is not None:
            yield first, number
            first = None


def _dash(text: str, item: Span) -> int:
    return text.rindex("-", 0, item.start)


def _removal(text: str, span: Span, starts: list[int], first: int, last: int) -> Splice:
    """Return the splice that removes the entries from `first` to the one before `last`."""
    if span.flow and last < len(starts):
        return starts[first], starts[last], ""
    if span.flow:
        return (span.items[first - 1].end if first else starts[0]), span.items[last - 1].end, ""
    line = _line_start(text, starts[first])
    if text[line : starts[first]].strip() and last < len(starts):  # it shares its line with a dash
        return starts[first], starts[last], ""
    return line, _line_end(text, span.items[last - 1].end), ""


def _addition(text: str, span: Span, new: list[str]) -> Splice:
    """Return the splice that appends entries."""
    end = span.items[-1].end
    if span.flow:
        return end, end, "".join(f", {each}" for each in new)
    newline = "\r\n" if "\r\n" in text else "\n"
    first = span.start if span.keys else _dash(text, span.items[0])
    indent = " " * (first - _line_start(text, first))
    lines = newline.join(indent + each for each in new)
    place = _line_end(text, end)
    return place, place, lines + newline if text[:place].endswith("\n") else newline + lines


def _line_start(text: str, at: int) -> int:
    return text.rfind("\n", 0, at) + 1


def _line_end(text: str, at: int) -> int:
    """Return the index at which the next line begins; it is `at` itself right after a line break."""
    if at and text[at - 1] == "\n":
        return at
    found = text.find("\n", at)
    return len(text) if found < 0 else found + 1


def _staying(before: Sequence[Any], after: Sequence[Any], /) -> list[bool]:
    """Return for each item of a list whether it stays in the list `after`, perhaps with altered values.

    The items that stay become the first ones of `after`, in their order; all that follow are new. Of all such choices
    this one has the least cost of changes (dynamic programming over both lists).
    """
    texts, others = [yaml_text(item) for item in before], [yaml_text(item) for item in after]
    same = next((n for n, pair in enumerate(zip(texts, others, strict=False)) if pair[0] != pair[1]), len(after))
    same = min(same, len(before))
    costs, ways = [[0.0]], list[list[bool]]()
    for item, text in zip(before[same:], texts[same:], strict=True):
        above, row, way = costs[-1], [costs[-1][0] + GONE], [False]
        for number in range(1, min(len(above), len(after) - same) + 1):
            there = same + number - 1
            stays = above[number - 1] + (0.0 if text == others[there] else _difference(item, after[there]))
            goes = above[number] + GONE if number < len(above) else stays + GONE
            row.append(min(stays, goes))
            way.append(stays <= goes)
        costs.append(row)
        ways.append(way)
    kept = min(range(len(costs[-1])), key=lambda number: costs[-1][number] - NEW * number)
    stay = []
    for way in reversed(ways):
        stay.append(way[kept])
        kept -= way[kept]
    return [True] * same + stay[::-1]


def _difference(one: Any, other: Any) -> float:
    """Return the difference of two items, 0 to 1: mappings by their keys, two other values 0.25."""
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return 1.0 if isinstance(one, dict) or isinstance(other, dict) else 0.25
    common = one.keys() & other.keys()
    alike = sum(1.0 if one[key] == other[key] else 0.5 for key in common)
    return 1.0 - alike / max(len(one), len(other), 1)
