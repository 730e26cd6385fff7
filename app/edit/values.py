"""Values of a scene file as plain mappings and lists: reading, changing, and writing them as YAML."""

import json
import re
from typing import Any, Final

from ...engine.scene.compose import scalar

Way = tuple[str | int, ...]
"""The keys and indices from the root to a value, such as `("wind", 0, "position")`."""

DIGITS = 12
"""Largest number of digits written of a number."""

_WORDS = {None: "null", True: "true", False: "false"}
_PLAIN = re.compile(r"[A-Za-z_][\w./-]*")


class _Nothing:
    """Stands for the absence of a value in a file."""

    def __repr__(self) -> str:
        return "NOTHING"

    def __bool__(self) -> bool:
        return False


NOTHING: Final = _Nothing()


def value_at(values: Any, way: Way, /) -> Any:
    """Return the value at a way, or NOTHING."""
    for step in way:
        if isinstance(values, dict):
            values = values.get(step, NOTHING)
        elif isinstance(values, list) and isinstance(step, int) and 0 <= step < len(values):
            values = values[step]
        else:
            return NOTHING
    return values


def with_value(values: Any, way: Way, value: Any, /) -> Any:
    """Return a copy of values with another one at a way; missing mappings are made, and a list may grow by one.

    NOTHING removes the key, or the item from its list. Raises KeyError where the way does not exist.
    """
    if not way:
        return value
    step, rest = way[0], way[1:]
    if isinstance(step, int):
        return _with_item(values, step, rest, value)
    if values is NOTHING or values is None:
        values = {}
    if not isinstance(values, dict):
        raise KeyError(step)
    inner = with_value(values.get(step, NOTHING), rest, value) if rest else value
    if inner is NOTHING:
        return {key: kept for key, kept in values.items() if key != step}
    return values | {step: inner}


def _with_item(values: Any, step: int, rest: Way, value: Any) -> Any:
    items = [] if values is NOTHING or values is None else values
    if not isinstance(items, list) or not 0 <= step <= len(items):
        raise KeyError(step)
    inner = with_value(items[step] if step < len(items) else NOTHING, rest, value) if rest else value
    return [*items[:step], *([] if inner is NOTHING else [inner]), *items[step + 1 :]]


def yaml_text(value: Any, /) -> str:
    """Return a value as YAML on one line, such as `{ kind: gust, position: [0, 2.5], tip: "#d9c27a" }`."""
    if isinstance(value, dict):
        inner = ", ".join(f"{yaml_text(key)}: {yaml_text(each)}" for key, each in value.items())
        return f"{{ {inner} }}" if inner else "{}"
    if isinstance(value, list):
        return f"[{', '.join(map(yaml_text, value))}]"
    if isinstance(value, str):
        return value if is_plain(value) else json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        return format(value, f".{DIGITS}g")
    return _WORDS[value] if value is None or isinstance(value, bool) else str(value)


def is_plain(text: str, /) -> bool:
    """Return whether a text needs no quotes."""
    return _PLAIN.fullmatch(text) is not None and scalar(text) == text
