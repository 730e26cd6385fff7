"""A take: the scene and the settings of a picture or a film."""

import re
from dataclasses import dataclass

from ...engine.declared.quality import LodName
from ...systems.overlay.layers import Layer

LARGEST = 16384
"""Longest side of a picture [pixels]."""

SAMPLES = 4
"""Width and height of a reference's supersampling, in samples per pixel."""


@dataclass(frozen=True, slots=True)
class Take:
    """A scene, and how it is drawn."""

    scene: str
    """Path or bundled name."""

    size: tuple[int, int]
    """Width and height [pixels]."""

    preset: str | None = None
    """Name of the quality preset; None for the scene's own quality."""

    lod: LodName = "auto"
    """Representation that is drawn everywhere, or `auto`."""

    reference: bool = False
    """Whether every blade is drawn in 3D, supersampled."""

    overlay: frozenset[Layer] = frozenset()
    """Layers drawn over the picture that show how it works."""


def parse_size(text: str, /) -> tuple[int, int]:
    """Return width and height [pixels] written as `WxH`; raises ValueError with a sentence that says what is wrong."""
    match = re.fullmatch(r"([0-9]{1,9})x([0-9]{1,9})", text.strip(), re.IGNORECASE)
    if match is None:
        raise ValueError(f"{text!r} is not a size like 1280x720")
    width, height = int(match[1]), int(match[2])
    if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
        raise ValueError(f"{text!r}: each side must be from 1 to {LARGEST} pixels")
    return width, height


def parse_frames(text: str, /) -> tuple[int, int | None]:
    """Return the first frame, and the one after the last, written as `A:B`, `A:` or `:B`; None is the film's end.

    Raises ValueError with a sentence that says what is wrong.
    """
    match = re.fullmatch(r"([0-9]{0,9}):([0-9]{0,9})", text.strip())
    if match is None:
        raise ValueError(f"{text!r} is not a range of frames like 100:130")
    first, end = int(match[1] or 0), int(match[2]) if match[2] else None
    if end is not None and end <= first:
        raise ValueError(f"{text!r}: there is no frame from {first} to before {end}")
    return first, end
