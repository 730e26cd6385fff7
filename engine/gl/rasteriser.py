"""What draws: a graphics card, or the processor itself."""

import os
from collections.abc import Callable

import moderngl

from .functions import functions_of
from .limits import limits_of

SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader", "basic render", "gdi generic", "noop")
"""Parts of the names of renderers that are no graphics cards, in small letters."""


def is_software(renderer: str, /) -> bool:
    """Return whether a renderer of this name, as GL tells it, is no graphics card."""
    return any(name in renderer.lower() for name in SOFTWARE)


AS_CARD = "TALLGRASS_AS_CARD"
"""Set to 1 in the environment, all is drawn by the ways of a card: to see and to count what cards do."""


def draws_in_software(ctx: moderngl.Context, /) -> bool:
    """Return whether a context is drawn in without a graphics card."""
    return os.environ.get(AS_CARD) != "1" and is_software(limits_of(functions_of(ctx)).renderer)


MOST_SAMPLES = 4.0
"""How many samples along a pixel's footprint a sampler takes at most: as many as parts are read without one. A card
takes two clocks for each, so that eight would cost the least cards more than all else that the ground's pixels ask."""


def anisotropy(ctx: moderngl.Context, /) -> float:
    """Return how many samples along a pixel's footprint samplers are to take; 1 where that is not at hand, or slow."""
    return 1.0 if draws_in_software(ctx) else max(min(MOST_SAMPLES, float(ctx.max_anisotropy)), 1.0)


def early_flush(ctx: moderngl.Context, /) -> Callable[[], None]:
    """Return what lets a software rasteriser begin with all that has been drawn so far, while more is got ready.

    Left to itself it begins when a frame is whole, and its threads wait until then. A card needs no such hint, and one
    that draws by tiles would have to go over them again: there it does nothing.
    """
    return functions_of(ctx).glFlush if draws_in_software(ctx) else _nothing


def _nothing() -> None:
    pass
