"""Blowing: which winds there are, for every receiver that is seen (paper, section 3.2)."""

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
from .wind.blow import Blowing, ReceiverArrays, places_alone
from .wind.grass import grass_of


class Hear(Protocol):
    """What gives receivers their messages."""

    def __call__(self, receivers: ReceiverArrays, /, *, time: float) -> Floats:
        """Return the messages (n, 2) that receivers hear at a time [s]."""


Now = Callable[[float], Sequence[Blowing]]
"""Gives the winds that act at a time [s], the strongest claim first."""


@dataclass(frozen=True, slots=True)
class Blown:
    """What blows in a frame."""

    winds: Sequence[Blowing] = ()
    """The winds that act, the strongest claim first."""

    at: float = 0.0
    """The instant that they were asked for [s]."""

    heard: int = 0
    """Receivers of blades and strips that heard them."""


@dataclass(slots=True)
class Blow:
    """The system `wind`: the winds of this frame, and what they tell those receivers that a game has asked for.

    The others hear them on the graphics card. What a game has written into messages since the frame before stands
    above what the wind says.
    """

    outlooks: Iterable[Outlook]
    now: Now
    hear: Hear
    growths: Sequence[Growth]

    def run(self) -> None:
        """Blow for every viewer that looks."""
        for outlook in self.outlooks:
            time = outlook.viewer.time
            winds, heard = list(self.now(time)), 0
            for receiving in hearing(outlook):
                receiving.letters.blow(partial(self._tell, receiving, time))
                if not receiving.still:
                    heard += len(receiving.slots) * receiving.per_slot
            outlook.note(Blown(winds, time, heard))

    def _tell(self, receiving: Receiving, time: float, slots: NDArray[np.int64]) -> Floats:
        """Return what the receivers of some slots of a pool hear, shape (n, 2)."""
        place = receiving.pool.places(slots).reshape(-1, 2)
        alone = places_alone(place, grass_of(self.growths, receiving.pool.kind(slots)))
        return self.hear(replace(alone, still=len(place) if receiving.still else 0), time=time)


def hearing(outlook: Outlook, /) -> list[Receiving]:
    """Return all receivers around a viewer; those that take no part in the small oscillations come last."""
    every = [receiving for kept in outlook.kept.values() for receiving in kept.receiving]
    return sorted(every, key=lambda receiving: receiving.still)


def receivers_shown(outlook: Outlook, growths: Sequence[Growth], /, *, patch: float, margin: float) -> ReceiverArrays:
    """Return all receivers that winds without a twin tell something, pool after pool.

    `patch` is a patch's side, and `margin` how far receivers may stand outside of it [m].
    """
    order = hearing(outlook)
    told = [receiving.told for receiving in order]
    places = [receiving.pool.places(slots).reshape(-1, 2) for receiving, (_, slots) in zip(order, told, strict=True)]
    rows = np.concatenate([rows for rows, _ in told])
    each = [np.full(len(slots), receiving.per_slot) for receiving, (_, slots) in zip(order, told, strict=True)]
    kind = np.concatenate([receiving.pool.kind(slots) for receiving, (_, slots) in zip(order, told, strict=True)])
    return ReceiverArrays(
        place=np.concatenate(places),
        grass=grass_of(growths, kind),
        patch=np.repeat(np.arange(len(rows)), np.concatenate(each)),
        middle=outlook.patches.middle[rows].astype(np.float32),
        radius=HALF_DIAGONAL * (patch + 2.0 * margin),
        still=sum(len(place) for receiving, place in zip(order, places, strict=True) if receiving.still),
    )
