"""Colours as people write them."""

import re
from collections.abc import Collection
from difflib import get_close_matches

LONG, SHORT = "#[0-9a-fA-F]{6}", "#[0-9a-fA-F]{3}"


def hex_of(colour: object, /) -> object:
    """Return a colour, by its CSS name such as `orange` or written `#rgb`, as `#rrggbb`; anything else unchanged."""
    if not isinstance(colour, str) or is_colour(colour):
        return colour
    if re.fullmatch(SHORT, colour):
        return "#" + "".join(2 * digit for digit in colour[1:])
    if colour.lower() not in _names():
        return colour
    from PIL import ImageColor  # noqa: PLC0415 - as below

    red, green, blue = ImageColor.getrgb(colour)[:3]
    return f"#{red:02x}{green:02x}{blue:02x}"


def is_colour(colour: object, /) -> bool:
    """Return whether a value is a colour `#rrggbb`."""
    return isinstance(colour, str) and re.fullmatch(LONG, colour) is not None


def nearest(text: str, /) -> str | None:
    """Return the colour that a text resembles, or None."""
    if is_colour(f"#{text}"):
        return f"#{text}"
    return next(iter(get_close_matches(text.lower(), _names(), n=1)), None)


def _names() -> Collection[str]:
    from PIL import ImageColor  # noqa: PLC0415 - slow to import: `tallgrass --help` should not wait for it

    return ImageColor.colormap.keys()
