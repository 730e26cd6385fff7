"""What other people's code raises, told in one line."""

LONGEST = 200
"""Most characters told of what an error says."""


def said(error: BaseException, /) -> str:
    """Return what an error is and says, in one line."""
    name, text = type(error).__name__, words_of(error)
    return f"{name}: {text[:LONGEST]}" if text else name


def words_of(error: BaseException, /) -> str:
    """Return what an error says, in one line; saying it is other people's code too, and may fail as well."""
    try:
        return " ".join(str(error).split())
    except Exception:  # noqa: BLE001 - it may raise anything
        return ""
