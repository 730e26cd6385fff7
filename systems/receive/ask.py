"""Asking all receivers that are seen: on the graphics card, but for winds and messages that only the CPU knows."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.terrain.sample import height_at, own_density_at
from ..around.outlook import Outlook
from ..around.receivers import Pool, Receiving
from ..space.ground import Ground
from .received import Received


def numbers_of(outlook: Outlook, first: Mapping[str, Sequence[int]], /) -> NDArray[np.intp]:
    """Return the numbers on the graphics card of all receivers shown, those that are still last, shape (n,).

    `first` gives the numbers of the first receivers of each representation's pools.
    """
    parts: list[tuple[bool, NDArray[np.intp]]] = []
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            own = receiving.slots if receiving.still else np.arange(len(receiving.slots) * receiving.each)
            parts.append((receiving.still, start + own))
    return np.concatenate([own for _, own in sorted(parts, key=lambda part: part[0])])


def write_messages(received: Received, outlook: Outlook, first: Mapping[str, Sequence[int]], ground: Ground, /) -> None:
    """Send what a game has written into messages of receivers that are shown, in place of what they have heard."""
    for name, kept in outlook.kept.items():
        for receiving, start in zip(kept.receiving, first[name], strict=True):
            if receiving.letters.busy and not receiving.still:
                _write(received, receiving, start, ground)


def _write(received: Received, receiving: Receiving, start: int, ground: Ground) -> None:
    for slot, message in receiving.letters.written():
        for place in np.flatnonzero(receiving.slots == slot).tolist():
            received.write(start + place * receiving.each, _texels(receiving.pool, slot, message, ground))


def _texels(pool: Pool, slot: int, message: Floats, ground: Ground) -> Floats:
    """Return the texels (n, 4) of a slot's receivers with these messages (n, 2)."""
    at = np.array([slot])
    place = np.ascontiguousarray(pool.places(at).reshape(-1, 2))
    dense = own_density_at(ground.density, pool.kind(at), place)
    return np.column_stack([message, height_at(ground.terrain, place), dense]).astype(np.float32)
