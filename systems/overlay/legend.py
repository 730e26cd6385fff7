"""The legend of the overlay's colours, painted into an image."""

from collections.abc import Callable, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from ...components.arrays import Bytes
from ..show.representation import Representation
from .layers import Layer
from .masks import Masked
from .paint import BRIGHT, DARK, Color, index_color, ring_shades

SWATCH = 2.6
"""Width of a swatch, relative to the size of the letters."""

BACKGROUND_OPACITY = 205
"""Opacity of the background, out of 255."""

Bounds = tuple[int, int, int, int]
"""Left, top, right and bottom of a swatch [pixels]."""

Colors = tuple[Color, ...]


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the legend."""

    draw: Callable[[ImageDraw.ImageDraw, Bounds, Colors], None] | None
    """Draws its swatch; None for a line without one, whose text has the colour."""

    colors: Colors
    text: str


def entries(
    layers: AbstractSet[Layer], masks: Sequence[Masked], representations: Sequence[Representation], /
) -> list[Entry]:
    """Return the entries for the shown layers, winds by rising claim."""
    lines = _mask_entries(layers, masks)
    if "arrows" in layers:
        shades = index_color(np.linspace(0.0, 1.0, 12, dtype=np.float32))
        lines.append(Entry(_draw_areas, _as_colors(shades), "posture index, 0 to 1"))
    if layers & {"levels", "weights", "map"}:
        lines += _level_entries(representations)
    if "weights" in layers:
        colors = tuple(color for each in representations[1::-1] for color in _as_colors(ring_shades(each.color)))
        lines.append(Entry(_draw_inside, colors, "two at once: the finer's share"))
    if "map" in layers:
        lines.append(Entry(None, (BRIGHT,), "map: dim outside the view cone"))
    return lines


def _mask_entries(layers: AbstractSet[Layer], masks: Sequence[Masked]) -> list[Entry]:
    """Return the entries for winds: outlines of those with an edge, names of those that blow everywhere."""
    edged = dict.fromkeys((mask.kind, mask.color) for mask in masks if not mask.everywhere)
    endless = dict.fromkeys((mask.kind, mask.color) for mask in masks if mask.everywhere)
    outlines = [Entry(_draw_outline, (color,), f"where the {kind} acts") for kind, color in edged]
    if "masks" not in layers:
        return outlines if "map" in layers else []
    names = [Entry(None, (color,), f"{kind}: everywhere") for kind, color in endless]
    return [*names, *outlines, *[Entry(None, (BRIGHT,), "thin line: with full weight")] * bool(outlines)]


def _level_entries(representations: Sequence[Representation]) -> list[Entry]:
    """Return the entries for representations and their rings."""
    return [
        Entry(
            _draw_areas,
            _as_colors(ring_shades(each.color, each.rings())),
            f"{each.label}, near to far" if each.rings() > 1 else each.label,
        )
        for each in representations
    ]


@lru_cache(maxsize=8)
def legend(lines: tuple[Entry, ...], size: int, /) -> Bytes:
    """Return the legend as an image (h, w, 4) of display colours and opacity, top row first.

    `size` is that of the letters [pixels].
    """
    font = ImageFont.load_default(size)
    high, gap = round(1.5 * size), round(0.7 * size)
    swatch = round(SWATCH * size)
    wide = max(round(font.getlength(entry.text)) for entry in lines) + swatch + 3 * gap
    image = Image.new("RGBA", (wide, high * len(lines) + gap), (*_as_bytes(DARK), BACKGROUND_OPACITY))
    draw = ImageDraw.Draw(image)
    for number, entry in enumerate(lines):
        top = gap // 2 + number * high
        box = (gap, top + round(0.25 * size), gap + swatch, top + round(1.25 * size))
        if entry.draw is not None:
            entry.draw(draw, box, entry.colors)
        ink = entry.colors[0] if entry.draw is None else BRIGHT
        draw.text((2 * gap + swatch, top + high // 2), entry.text, (*_as_bytes(ink), 255), font, anchor="lm")
    return np.asarray(image)


def _as_colors(shades: NDArray[np.float32]) -> tuple[Color, ...]:
    return tuple((float(r), float(g), float(b)) for r, g, b in shades)


def _as_bytes(color: Color) -> tuple[int, int, int]:
    """Return a colour as bytes."""
    red, green, blue = (round(255 * channel) for channel in color)
    return red, green, blue


def _draw_areas(draw: ImageDraw.ImageDraw, box: Bounds, colors: Colors) -> None:
    """Draw colours side by side."""
    left, top, right, bottom = box
    sides = np.linspace(left, right, len(colors) + 1).round().astype(int).tolist()
    for color, a, b in zip(colors, sides[:-1], sides[1:], strict=True):
        draw.rectangle((a, top, b - 1, bottom), (*_as_bytes(color), 255))


def _draw_outline(draw: ImageDraw.ImageDraw, box: Bounds, colors: Colors) -> None:
    """Draw a tinted box with an outline."""
    line = max(2, (box[3] - box[1]) // 6)
    red, green, blue = (0.3 * mark + 0.7 * paper for mark, paper in zip(colors[0], DARK, strict=True))
    draw.rectangle(box, (*_as_bytes((red, green, blue)), 255), (*_as_bytes(colors[0]), 255), line)


def _draw_inside(draw: ImageDraw.ImageDraw, box: Bounds, colors: Colors) -> None:
    """Draw a square with one colour inside the other."""
    left, top, right, bottom = box
    side = bottom - top
    left += (right - left - side) // 2
    draw.rectangle((left, top, left + side, bottom), (*_as_bytes(colors[0]), 255), (255, 255, 255, 255))
    inset = side // 4
    draw.rectangle((left + inset, top + inset, left + side - inset, bottom - inset), (*_as_bytes(colors[1]), 255))
