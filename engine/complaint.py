"""What other people's code raises, told in one line."""

LONGEST = 200
"""Most characters told of what an error says."""


def said(error: BaseException, /) -> str:
    """Return what an error is and says, in one line; saying it is other people's code too, and may fail as well."""
    try:
        text = " ".join(str(error).split())
    except Exception:  # noqa: BLE001 - it may raise anything
        text = ""
    name = type(error).__name__
    return f"{name}: {text[:LONGEST]}" if text else name
