"""Plain scalars by the core schema of YAML 1.2: null, true, false, numbers, and text for all the rest."""

import re

_NULL = frozenset(("", "~", "null", "Null", "NULL"))
_BOOL = {"true": True, "True": True, "TRUE": True, "false": False, "False": False, "FALSE": False}
_INT = re.compile(r"[-+]?[0-9]+")
_BASED = re.compile(r"0o[0-7]+|0x[0-9a-fA-F]+")
_FLOAT = re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?|[-+]?\.(inf|Inf|INF)|\.(nan|NaN|NAN)")
_LONGEST = 64

Scalar = str | int | float | bool | None


def scalar(text: str, /) -> Scalar:
    """Return what an unquoted scalar means: 1e3 is a number, 017 is 17, and on, off, yes and no are text.

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
