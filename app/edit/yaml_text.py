"""A value as a scene file writes it."""

import json
import re
from typing import Any

from ...engine.scene.scalars import scalar

DIGITS = 12
"""Most digits of a number that are written."""

_PLAIN = re.compile(r"[A-Za-z_][\w./-]*")


def yaml_text(value: Any, /) -> str:
    """Return a value on one line, as the house writes it: `{ kind: gust, position: [0, 2.5], tip: "#d9c27a" }`."""
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


_WORDS = {None: "null", True: "true", False: "false"}


def is_plain(text: str, /) -> bool:
    """Return whether a text needs no quotes."""
    return _PLAIN.fullmatch(text) is not None and scalar(text) == text
