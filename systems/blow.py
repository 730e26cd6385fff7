"""Blowing: the winds of a frame, and their messages to receivers (paper, section 3.2)."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Floats
from .around.outlook import Outlook
from .around.receivers import Receiving
from .grow.record import Growth
from .space.cone import HALF_DIAGONAL
from .wind.blow import Blowing, ReceiverArrays, lone_receivers
from .wind.grass import grass_of


class Hear(Protocol):
    """A function that returns the messages to receivers."""

    def __call__(self, receivers: ReceiverArrays, /, *, time: float) -> Floats:
        """Return the messages (n, 2) to receivers at `time` [s]."""


WindsAt = Callable[[float], Sequence[Blowing]]
"""Returns the winds that act at a time [s], the strongest claim first."""


@dataclass(frozen=True, slots=True)
class Blown:
    """The winds of a frame."""

    winds: Sequence[Blowing] = ()
    """Winds that act, the strongest claim first."""

    time: float = 0.0
    """Time at which they act [s]."""

    heard: int = 0
    """Number of receivers of blades and strips that hear them."""


@dataclass(slots=True)
class Blow:
    """The system `wind`: notes the winds of the frame, and computes the messages that a game has asked for.

    All other messages are computed on the graphics card. Messages that a game has written since the frame before
    override those of the winds.
    """

    outlooks: Iterable[Outlook]
    now: WindsAt
    hear: Hear
    growths: Sequence[Growth]

    def run(self) -> None:
        """Blow for every viewer that looks."""
        for outlook in self.outlooks:
            time = outlook.viewer.time
            winds, heard = list(self.now(time)), 0
            for receiving in hearing(outlook):
                receiving.messages.blow(partial(self._messages, receiving, time))
                if not receiving.still:
                    heard += len(receiving.slots) * receiving.per_slot
            outlook.note(Blown(winds, time, heard))

    def _messages(self, receiving: Receiving, time: float, slots: NDArray[np.int64]) -> Floats:
        """Return the messages (n, 2) at `time` [s] to the receivers in some slots of a pool."""
        place = receiving.pool.places(slots).reshape(-1, 2)
        alone = lone_receivers(place, grass_of(self.growths, receiving.pool.kind(slots)))
        return self.hear(replace(alone, still=len(place) if receiving.still else 0), time=time)


def hearing(outlook: Outlook, /) -> list[Receiving]:
    """Return all receivers around a viewer, those without small oscillations last."""
    every = [receiving for kept in outlook.kept.values() for receiving in kept.receiving]
    return sorted(every, key=lambda receiving: receiving.still)


def receivers_shown(outlook: Outlook, growths: Sequence[Growth], /, *, patch: float, margin: float) -> ReceiverArrays:
    """Return the receivers shown whose messages winds without a twin have to compute, pool after pool.

    `patch` is a patch's side, and `margin` the distance that receivers may stand outside of their patch [m].
    """
    every = hearing(outlook)
    shown = [receiving.addressed for receiving in every]
    places = [receiving.pool.places(slots).reshape(-1, 2) for receiving, (_, slots) in zip(every, shown, strict=True)]
    rows = np.concatenate([rows for rows, _ in shown])
    counts = [np.full(len(slots), receiving.per_slot) for receiving, (_, slots) in zip(every, shown, strict=True)]
    kind = np.concatenate([receiving.pool.kind(slots) for receiving, (_, slots) in zip(every, shown, strict=True)])
    return ReceiverArrays(
        place=np.concatenate(places),
        grass=grass_of(growths, kind),
        patch=np.repeat(np.arange(len(rows)), np.concatenate(counts)),
        middle=outlook.patches.middle[rows].astype(np.float32),
        radius=HALF_DIAGONAL * (patch + 2.0 * margin),
        still=sum(len(place) for receiving, place in zip(every, places, strict=True) if receiving.still),
    )
