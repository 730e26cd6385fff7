"""Where each value of a YAML text stands in it: from which character to which."""

from dataclasses import dataclass, field
from typing import Any

import yaml

from ...engine.scene.compose import read_document


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
