"""The legend: which colour is what, written and painted into one image."""

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
"""Width of a swatch, of the size of the letters."""

PAPER = 205
"""Opacity of the paper, of 255."""


@dataclass(frozen=True, slots=True)
class Entry:
    """One line of the legend."""

    form: str
    """How its colours are shown: `areas` side by side, an `outline`, a `ramp`, one `inside` the other, or `none`."""

    colors: tuple[Color, ...]
    text: str


def entries(
    parts: AbstractSet[Layer], masks: Sequence[Masked], representations: Sequence[Representation], /
) -> list[Entry]:
    """Return what there is to be told of the parts that are shown, the winds by rising claim."""
    lines = _of_masks(parts, masks)
    if "arrows" in parts:
        shades = index_color(np.linspace(0.0, 1.0, 12, dtype=np.float32))
        lines.append(Entry("ramp", _colors(shades), "posture index, 0 to 1"))
    if parts & {"levels", "weights", "map"}:
        lines += _of_levels(representations)
    if "weights" in parts:
        colors = tuple(color for each in representations[1::-1] for color in _colors(ring_shades(each.color)))
        lines.append(Entry("inside", colors, "two at once: the finer's share"))
    if "map" in parts:
        lines.append(Entry("none", (BRIGHT,), "map: dim outside the view cone"))
    return lines


def _of_masks(parts: AbstractSet[Layer], masks: Sequence[Masked]) -> list[Entry]:
    edged = dict.fromkeys((mask.kind, mask.color) for mask in masks if not mask.everywhere)
    endless = dict.fromkeys((mask.kind, mask.color) for mask in masks if mask.everywhere)
    outlines = [Entry("outline", (color,), f"where the {kind} acts") for kind, color in edged]
    if "masks" not in parts:
        return outlines if "map" in parts else []
    names = [Entry("none", (color,), f"{kind}: everywhere") for kind, color in endless]
    return [*names, *outlines, *[Entry("none", (BRIGHT,), "thin line: with full weight")] * bool(outlines)]


def _of_levels(representations: Sequence[Representation]) -> list[Entry]:
    return [
        Entry(
            "areas",
            _colors(ring_shades(each.color, each.rings())),
            f"{each.label}, near to far" if each.rings() > 1 else each.label,
        )
        for each in representations
    ]


@lru_cache(maxsize=8)
def legend(lines: tuple[Entry, ...], size: int, /) -> Bytes:
    """Return the legend in letters of a size [pixels], on dark paper: display colours and opacity, (h, w, 4).

    The top row is first.
    """
    font = ImageFont.load_default(size)
    high, gap = round(1.5 * size), round(0.7 * size)
    swatch = round(SWATCH * size)
    wide = max(round(font.getlength(entry.text)) for entry in lines) + swatch + 3 * gap
    image = Image.new("RGBA", (wide, high * len(lines) + gap), (*_bytes(DARK), PAPER))
    draw = ImageDraw.Draw(image)
    for number, entry in enumerate(lines):
        top = gap // 2 + number * high
        box = (gap, top + round(0.25 * size), gap + swatch, top + round(1.25 * size))
        _FORMS[entry.form](draw, box, entry.colors)
        ink = entry.colors[0] if entry.form == "none" else BRIGHT
        draw.text((2 * gap + swatch, top + high // 2), entry.text, (*_bytes(ink), 255), font, anchor="lm")
    return np.asarray(image)


def _colors(shades: NDArray[np.float32]) -> tuple[Color, ...]:
    return tuple((float(r), float(g), float(b)) for r, g, b in shades)


def _bytes(color: Color) -> tuple[int, int, int]:
    red, green, blue = (round(255 * channel) for channel in color)
    return red, green, blue


Box = tuple[int, int, int, int]
Colors = tuple[Color, ...]


def _areas(draw: ImageDraw.ImageDraw, box: Box, colors: Colors) -> None:
    left, top, right, bottom = box
    sides = np.linspace(left, right, len(colors) + 1).round().astype(int).tolist()
    for color, a, b in zip(colors, sides[:-1], sides[1:], strict=True):
        draw.rectangle((a, top, b - 1, bottom), (*_bytes(color), 255))


def _outline(draw: ImageDraw.ImageDraw, box: Box, colors: Colors) -> None:
    line = max(2, (box[3] - box[1]) // 6)
    red, green, blue = (0.3 * mark + 0.7 * paper for mark, paper in zip(colors[0], DARK, strict=True))
    draw.rectangle(box, (*_bytes((red, green, blue)), 255), (*_bytes(colors[0]), 255), line)


def _inside(draw: ImageDraw.ImageDraw, box: Box, colors: Colors) -> None:
    left, top, right, bottom = box
    side = bottom - top
    left += (right - left - side) // 2
    draw.rectangle((left, top, left + side, bottom), (*_bytes(colors[0]), 255), (255, 255, 255, 255))
    inset = side // 4
    draw.rectangle((left + inset, top + inset, left + side - inset, bottom - inset), (*_bytes(colors[1]), 255))


def _nothing(draw: ImageDraw.ImageDraw, box: Box, colors: Colors) -> None:
    del draw, box, colors


_FORMS: dict[str, Callable[[ImageDraw.ImageDraw, Box, Colors], None]] = {
    "areas": _areas,
    "ramp": _areas,
    "outline": _outline,
    "inside": _inside,
    "none": _nothing,
}
