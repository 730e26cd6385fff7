"""Errors of other people's code as one line of text."""

LONGEST = 200
"""Greatest number of characters of an error's message."""


def said(error: BaseException, /) -> str:
    """Return an error's class and message in one line."""
    name, text = type(error).__name__, words_of(error)
    return f"{name}: {text[:LONGEST]}" if text else name


def words_of(error: BaseException, /) -> str:
    """Return an error's message in one line; its `__str__` is other people's code too, and may fail as well."""
    try:
        return " ".join(str(error).split())
    except Exception:  # noqa: BLE001 - it may raise anything
        return ""
