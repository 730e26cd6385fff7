"""Blowing: primitives send their messages to the receivers (paper, sections 3.2 and 3.3)."""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ...components.wind import WindSource

Floats = NDArray[np.float32]


def blowing(sources: Iterable[WindSource], /, *, time: float) -> list[WindSource]:
    """Return the sources that act at `time` [s], the strongest claim last: by priority, then by name."""
    now = [
        source
        for source in sources
        if source.primitive.start <= time and (source.primitive.stop is None or time < source.primitive.stop)
    ]
    return sorted(now, key=lambda source: (source.primitive.priority, source.name))


def messages(sources: list[WindSource], place: Floats, /, *, time: float, seed: int) -> Floats:
    """Return the message that each receiver at `place` (n, 2) ends up with, shape (n, 2).

    `sources` rise in their claim: at a place, the last one whose mask holds it cancels the others (paper, section
    3.3). Where no mask reaches, the message is 0: the grass is at rest.
    """
    heard = np.zeros((len(place), 2), np.float32)
    for source in sources:
        inside = source.primitive.mask(place, time=time) > 0.0
        if inside.all():
            heard = source.primitive.action(place, time=time, seed=seed)
        elif inside.any():
            heard[inside] = source.primitive.action(place[inside], time=time, seed=seed)
    return heard
