"""Writing changed values back into a YAML text: only what changed is touched, to the character."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import compress
from typing import Any

import yaml

from ...engine.scene import SceneError
from ...engine.scene.compose import read_document
from .values import yaml_text

Splice = tuple[int, int, str]
"""From which character to which another text is to stand."""


GONE = NEW = 0.55
"""What an item costs that goes, and one that comes: together more than any that becomes another one."""


@dataclass(slots=True, eq=False)
class Span:
    """A value's place in the text."""

    start: int
    """Its first character."""

    end: int
    """The one after its last."""

    column: int
    """How many characters stand before it on its line."""

    data: Any = None
    """The value itself."""

    flow: bool = False
    """Whether it stands in brackets or braces."""

    items: list["Span"] = field(default_factory=list)
    """The values of a mapping, in their order, or of a list."""

    keys: dict[str, "Span"] = field(default_factory=dict)
    """The keys of a mapping."""

    def value(self, key: str) -> "Span":
        """Return the value of a key of a mapping."""
        return self.items[list(self.keys).index(key)]


def spans(text: str, /) -> Span:
    """Return the spans of a text that `read_document` reads without a problem; raises what it raises."""
    data = read_document(text, file="").root.data
    events = [event for event in yaml.parse(text, Loader=yaml.CSafeLoader) if isinstance(event, _COUNT)]
    return _Spans(events).read(data)


_COUNT = (yaml.NodeEvent, yaml.CollectionEndEvent)


class _Spans:
    """Reads events one after the other; what they come to is known already."""

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
    """A text cannot be changed in this way; its text says why, and what to do."""


def rewritten(text: str, values: dict[str, Any], /) -> str:
    """Return a YAML text that reads as `values`: comments, order, quotes and spaces stay where nothing has changed.

    The text has to be one that `read_document` reads. Raises RewriteError where the change cannot be written.
    """
    splices = sorted(_changed(text, spans(text), values), key=lambda splice: splice[:2])
    result = text
    for start, end, new in reversed(splices):  # at one place, what comes first stands first
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
    """Return whether two values are the same to the digits that are written."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(value, other[key]) for key, value in one.items())
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return yaml_text(one) == yaml_text(other)


def _changed(text: str, span: Span, value: Any, key: Span | None = None) -> Iterator[Splice]:
    """Yield what has to be done for the text of a value, that of a `key` if it has one, to read as another."""
    if _same(span.data, value):
        return
    if isinstance(span.data, dict) and isinstance(value, dict) and span.keys.keys() & value.keys():
        yield from _mapping(text, span, value)
    elif isinstance(span.data, list) and isinstance(value, list) and span.items and value:
        yield from _list(text, span, value)
    else:
        yield from _replaced(text, span, value, key)


def _replaced(text: str, span: Span, value: Any, key: Span | None) -> Iterator[Splice]:
    new = yaml_text(value)
    if isinstance(value, str) and text[span.start : span.start + 1] == "'" and "'" not in value and value.isprintable():
        new = f"'{value}'"
    if key is not None and span.items and not span.flow:  # it stands on lines of its own, and comments beside its key
        colon = text.index(":", key.end) + 1
        yield colon, colon, " " + new
        yield _line_start(text, span.start), _line_end(text, span.end), ""
    else:
        end = span.start + len(text[span.start : span.end].rstrip())  # of a text on lines of its own, the last one's
        yield span.start, end, " " + new if text[span.start - 1 : span.start] in (":", "-") else new


def _mapping(text: str, span: Span, value: dict[str, Any]) -> Iterator[Splice]:
    for key, where in span.keys.items():
        if key in value:
            yield from _changed(text, span.value(key), value[key], where)
    starts = [each.start for each in span.keys.values()]
    for first, last in _runs([key not in value for key in span.keys]):
        yield _without(text, span, starts, first, last)
    new = [f"{yaml_text(key)}: {yaml_text(each)}" for key, each in value.items() if key not in span.keys]
    if new:
        yield _with(text, span, new)


def _list(text: str, span: Span, value: list[Any]) -> Iterator[Splice]:
    starts = [item.start if span.flow else _dash(text, item) for item in span.items]
    stays = _staying([item.data for item in span.items], value)
    for first, last in _runs([not each for each in stays]):
        yield _without(text, span, starts, first, last)
    for item, new in zip(compress(span.items, stays), value, strict=False):
        yield from _changed(text, item, new)
    added = [yaml_text(item) for item in value[sum(stays) :]]
    if added:
        yield _with(text, span, added if span.flow else [f"- {each}" for each in added])


def _runs(gone: list[bool]) -> Iterator[tuple[int, int]]:
    """Yield from which to which entry each run of those goes that are gone."""
    first = None
    for number, each in enumerate([*gone, False]):
        if each and first is None:
            first = number
        elif not each and first is not None:
            yield first, number
            first = None


def _dash(text: str, item: Span) -> int:
    return text.rindex("-", 0, item.start)


def _without(text: str, span: Span, starts: list[int], first: int, last: int) -> Splice:
    """Return what takes entries away, from the one numbered `first` to that before `last`."""
    if span.flow and last < len(starts):
        return starts[first], starts[last], ""
    if span.flow:
        return (span.items[first - 1].end if first else starts[0]), span.items[last - 1].end, ""
    line = _line_start(text, starts[first])
    if text[line : starts[first]].strip() and last < len(starts):  # it shares its line with a dash
        return starts[first], starts[last], ""
    return line, _line_end(text, span.items[last - 1].end), ""


def _with(text: str, span: Span, new: list[str]) -> Splice:
    """Return what adds entries after the last one."""
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
    """Return where the line after this one begins; a value that ends with its line has ended on it."""
    if at and text[at - 1] == "\n":
        return at
    found = text.find("\n", at)
    return len(text) if found < 0 else found + 1


def _staying(before: Sequence[Any], after: Sequence[Any], /) -> list[bool]:
    """Return for each item of a list whether it stays, if need be with other values, in the list that comes after.

    Those that stay are the first ones after, in their order, and what follows them there is new. Of all such ways it
    is the one with the fewest changes.
    """
    texts, others = [yaml_text(item) for item in before], [yaml_text(item) for item in after]
    same = next((n for n, pair in enumerate(zip(texts, others, strict=False)) if pair[0] != pair[1]), len(after))
    same = min(same, len(before))
    costs, ways = [[0.0]], list[list[bool]]()
    for item, text in zip(before[same:], texts[same:], strict=True):
        above, row, way = costs[-1], [costs[-1][0] + GONE], [False]
        for number in range(1, min(len(above), len(after) - same) + 1):
            there = same + number - 1
            stays = above[number - 1] + (0.0 if text == others[there] else _apart(item, after[there]))
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


def _apart(one: Any, other: Any) -> float:
    """Return how much two items differ, up to 1: mappings by their keys, all else a little."""
    if not (isinstance(one, dict) and isinstance(other, dict)):
        return 1.0 if isinstance(one, dict) or isinstance(other, dict) else 0.25
    common = one.keys() & other.keys()
    alike = sum(1.0 if one[key] == other[key] else 0.5 for key in common)
    return 1.0 - alike / max(len(one), len(other), 1)
