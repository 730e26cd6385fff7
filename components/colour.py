"""Colours as people write them."""

import re
from difflib import get_close_matches

from PIL import ImageColor

LONG, SHORT = "#[0-9a-fA-F]{6}", "#[0-9a-fA-F]{3}"


def hex_of(colour: object, /) -> object:
    """Return a colour by its name in CSS, such as `orange`, or written `#rgb`, as `#rrggbb`; anything else as it is."""
    if isinstance(colour, str) and (colour.lower() in ImageColor.colormap or re.fullmatch(SHORT, colour)):
        red, green, blue = ImageColor.getrgb(colour)[:3]
        return f"#{red:02x}{green:02x}{blue:02x}"
    return colour


def is_colour(colour: object, /) -> bool:
    """Return whether this is a colour `#rrggbb`."""
    return isinstance(colour, str) and re.fullmatch(LONG, colour) is not None


def nearest(text: str, /) -> str | None:
    """Return the colour that a text was perhaps meant to be."""
    if is_colour(f"#{text}"):
        return f"#{text}"
    return next(iter(get_close_matches(text.lower(), ImageColor.colormap, n=1)), None)
