"""Telling software rasterisers from graphics cards, and what depends on that."""

import os
from collections.abc import Callable

import moderngl

from .functions import functions_of
from .limits import limits_of

SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader", "basic render", "gdi generic", "noop")
"""Lower-case parts of the names of software renderers."""


def is_software(renderer: str, /) -> bool:
    """Return whether a renderer, by its GL name, is a software rasteriser."""
    return any(name in renderer.lower() for name in SOFTWARE)


AS_CARD = "TALLGRASS_AS_CARD"
"""Environment variable; where it is 1, a software rasteriser draws as a card does, to test and measure that."""


def draws_in_software(ctx: moderngl.Context, /) -> bool:
    """Return whether a context has a software rasteriser."""
    return os.environ.get(AS_CARD) != "1" and is_software(limits_of(functions_of(ctx)).renderer)


MOST_SAMPLES = 4.0
"""Greatest anisotropy of samplers: the number of samples that shaders take themselves without one.

A card takes two clocks for each sample: with eight, the slowest cards would take longer for them than for all else in
the ground's pixels.
"""


def anisotropy(ctx: moderngl.Context, /) -> float:
    """Return the anisotropy of samplers; 1 where it is not available, or slow."""
    return 1.0 if draws_in_software(ctx) else max(min(MOST_SAMPLES, float(ctx.max_anisotropy)), 1.0)


def early_flush(ctx: moderngl.Context, /) -> Callable[[], None]:
    """Return a function that makes a software rasteriser start on the commands so far, while more are prepared.

    It would start only at the end of the frame, and its threads idle until then. For a card the function does nothing:
    it needs no flush, and a tile-based one would process its tiles twice.
    """
    return functions_of(ctx).glFlush if draws_in_software(ctx) else lambda: None
