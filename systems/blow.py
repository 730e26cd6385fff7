"""Blowing: every receiver that is seen hears the winds (paper, section 3.2)."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .around.cone import HALF_DIAGONAL
from .around.outlook import Outlook
from .around.receivers import Receiving
from .around.representation import Kept
from .grow.record import Growth
from .wind.blow import ReceiverArrays
from .wind.grass import grass_of

Floats = NDArray[np.float32]


class Hear(Protocol):
    """What gives receivers their messages."""

    def __call__(self, receivers: ReceiverArrays, /, *, time: float) -> Floats:
        """Return the messages (n, 2) that receivers hear at a time [s]."""


@dataclass(slots=True)
class Blow:
    """The system `wind`: every receiver of what is shown hears the winds, all in one pass.

    What a game has written into messages since the frame before stands above what the wind says.
    """

    outlooks: Iterable[Outlook]
    hear: Hear
    growths: Sequence[Growth]
    patch: float
    """Side of a patch [m]."""

    margin: float
    """How far receivers may stand outside of their patch [m]."""

    def run(self) -> None:
        """Blow for every viewer that looks."""
        for outlook in self.outlooks:
            self._run(outlook)

    def _run(self, outlook: Outlook) -> None:
        kept: list[Kept] = list(outlook.kept.values())
        all_receiving = [receiving for each in kept for receiving in each.receiving]
        # Those that take no part in the small oscillations come last.
        order = sorted(all_receiving, key=lambda receiving: receiving.still)
        for receiving in order:
            receiving.letters.collect()
        heard = self.hear(self._receivers(outlook, order), time=outlook.viewer.time)
        outlook.heard = _deliver(order, heard)
        outlook.air = _mean(outlook, order)
        for receiving in order:
            receiving.letters.deliver()

    def _receivers(self, outlook: Outlook, order: list[Receiving]) -> ReceiverArrays:
        places = [receiving.pool.places(receiving.slots) for receiving in order]
        flat = [place.reshape(-1, 2) for place in places]
        rows = np.concatenate([receiving.rows for receiving in order])
        each = [
            np.full(len(receiving.slots), len(place) // max(len(receiving.slots), 1))
            for receiving, place in zip(order, flat, strict=True)
        ]
        kind = np.concatenate([receiving.pool.kind(receiving.slots) for receiving in order])
        return ReceiverArrays(
            place=np.concatenate(flat),
            grass=grass_of(self.growths, kind),
            patch=np.repeat(np.arange(len(rows)), np.concatenate(each)),
            middle=outlook.patches.middle[rows].astype(np.float32),
            radius=HALF_DIAGONAL * (self.patch + 2.0 * self.margin),
            still=sum(len(place) for receiving, place in zip(order, flat, strict=True) if receiving.still),
        )


def _deliver(order: list[Receiving], heard: Floats) -> int:
    """Put messages (n, 2) where their receivers are; return how many of them are not still."""
    start = moving = 0
    for receiving in order:
        message, slots = receiving.pool.message, receiving.slots
        end = start + len(slots) * int(np.prod(message.shape[1:-1]))
        if receiving.still:
            message[:] = 0.0  # the same view gives the same picture, wherever one looked before
        else:
            moving = end
        message[slots] = heard[start:end].reshape(len(slots), *message.shape[1:])
        start = end
    return moving


def _mean(outlook: Outlook, order: list[Receiving]) -> Floats:
    """Return the mean of what the patches in view hear in their middle, shape (2,): the coarsest comes last."""
    seen = outlook.patches.alive & outlook.patches.visible
    if not (order and seen.any()):
        return np.zeros(2, np.float32)
    return np.asarray(order[-1].pool.message[:, 0][seen].mean(axis=0), np.float32)
