"""The organs of plants: their widths, their tones between the kind's two colours, and how far wind bends them."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from .record import Blades, Growth

GIVEN = 5
"""Number of places along an organ, evenly from root to tip, at which its width is given."""

KNOTS = 2 * GIVEN - 1
"""Number of places at which its width is known: those, and one between each two. Between these it is linear."""


@dataclass(frozen=True, slots=True)
class Organ:
    """One sort of organ; each organ is a ribbon."""

    widths: tuple[float, ...]
    """Relative width at `GIVEN` places from root to tip; empty for a blade, which tapers as its kind declares."""

    tones: tuple[float, float]
    """Tone at its root and at its tip: 0 is the kind's colour `root`, 1 its colour `tip`."""

    gives: float = 1.0
    """Bending by the wind, relative to a blade's; it also moves with its stem."""

    teeth: int = 0
    """Number of teeth of its outline on either side, such as florets or the leaves of a twig. They are drawn where they
    are large enough to be seen; far off, and wherever it is painted, it has their mean width."""

    ligules: int = 0
    """Number of narrow petals of many lengths that it stands for, as in a dandelion; seen from as near as teeth."""

    dyed: tuple[float, float] = (-2.0, -1.0)
    """Places along it up to which it has the full colour of its head's eye, and from which on none of it."""


BLADE, STEM, LEAF, FROND, PETAL, EYE, BUD, RAY, TUFT, WITHERED, FLORETS, SPRIG, STRAP = range(13)
BLOTCHED, DISC, STAMENS, CAPSULE, TWIN = range(13, 18)

ORGANS: Final = (
    Organ((), (0.0, 1.0)),
    Organ((1.0, 0.9, 0.8, 0.75, 0.7), (0.0, 0.06)),
    Organ((0.35, 0.85, 1.0, 0.75, 0.05), (0.0, 0.08)),
    Organ((0.25, 0.9, 1.0, 0.7, 0.05), (0.1, 0.9)),
    Organ((0.3, 0.75, 1.0, 1.0, 0.1), (0.62, 1.0), 0.35),
    Organ((0.7, 1.0, 1.0, 0.9, 0.5), (0.2, 0.4), 0.35),
    Organ((0.6, 1.0, 0.95, 0.7, 0.15), (0.0, 0.3), 0.35),
    Organ((0.06, 0.06, 0.07, 0.9, 0.6), (0.1, 1.0), 0.35),
    Organ((0.7, 1.0, 0.9, 0.6, 0.1), (0.8, 1.0), 0.8, teeth=16),
    Organ((0.5, 0.75, 0.65, 0.4, 0.05), (0.75, 1.0), 0.7),
    Organ((0.5, 0.9, 1.0, 0.8, 0.2), (0.7, 1.0), teeth=6),
    Organ((0.35, 0.8, 1.0, 0.85, 0.3), (0.0, 0.1), teeth=6),
    Organ((0.3, 0.7, 0.95, 1.0, 0.6), (0.7, 1.0), 0.35, ligules=5),
    Organ((0.3, 0.75, 1.0, 1.0, 0.1), (0.9, 1.0), 0.35, dyed=(0.2, 0.48)),
    Organ((0.5, 0.85, 1.0, 1.0, 0.7), (1.0, 1.0), 0.35, dyed=(1.0, 2.0)),
    Organ((0.3, 0.65, 0.95, 1.0, 0.5), (1.0, 1.0), 0.35, dyed=(1.0, 2.0)),
    Organ((0.45, 0.8, 1.0, 1.0, 0.8), (0.02, 0.12), 0.35),
    Organ((0.3, 0.7, 0.95, 1.0, 0.6), (0.7, 1.0), 0.35, ligules=2),
)
"""Sorts of organs, by the numbers above. `LEAF` belongs to a plant with a head, whose colour is the tip's, `FROND` to
one without. `EYE` is the middle of an open head, `RAY` a ray of an umbel with florets at its end, `TUFT` a branch of a
plume with its spikelets, a centimetre apart as on a reed's. `WITHERED` grass is as pale as tips, thinner, and stiffer.
`FLORETS` are several of a spike, one above another; a `SPRIG` is a shrub's short twig with its leaves. The wind bends
both as far as their stems, so that they stay close. `STRAP` is a group of narrow petals side by side, in discs of many
petals, as of dandelions. Heads with an eye of its own colour have `BLOTCHED` petals about `STAMENS` and a `CAPSULE`, as
poppies; with many petals, these are `TWIN`, two broad ones side by side, about a `DISC` of florets, as a daisy's."""

HEADS: Final = (PETAL, EYE, BUD, RAY, TUFT, FLORETS, STRAP, BLOTCHED, DISC, STAMENS, CAPSULE, TWIN)
"""Organs of heads."""

AT_TIPS: Final = (PETAL, EYE, BUD, RAY, STRAP, BLOTCHED, DISC, STAMENS, CAPSULE, TWIN)
"""Organs of heads that stand together on the tip of a stem."""

LEAVES: Final = (LEAF, FROND, WITHERED)
"""Organs with a midrib, as blades have."""

TONES: Final = np.array([organ.tones for organ in ORGANS])
"""Tones of each organ at its root and at its tip, shape (organs, 2)."""

TEETH: Final = np.array([organ.teeth for organ in ORGANS])
"""Number of teeth on either side of each organ, shape (organs,)."""

LIGULES: Final = np.array([organ.ligules for organ in ORGANS])
"""Number of narrow petals that each organ stands for, shape (organs,)."""

GIVES: Final = np.array([organ.gives for organ in ORGANS])
"""Bending of each organ by the wind, relative to a blade's, shape (organs,)."""

DYED: Final = np.array([organ.dyed for organ in ORGANS])
"""Places along each organ where its eye's colour begins to fade, and where it ends, shape (organs, 2)."""

_BETWEEN: Final = np.array([-1.0, 9.0, 9.0, -1.0]) / 16.0
"""Weights of four places for the square of the width between the inner two (Catmull and Rom, A class of local
interpolating splines, 1974)."""


def _widths(number: int, /) -> Doubles:
    """Return the relative width of an organ at `KNOTS` places.

    Organs on the tips of stems are round in outline, as ellipses are, whose squared width is a parabola; but for rays,
    which are stalks.
    """
    given = np.array(ORGANS[number].widths or (0.0,) * GIVEN)
    if number not in AT_TIPS or number == RAY:
        return np.asarray(np.interp(np.linspace(0.0, 1.0, KNOTS), np.linspace(0.0, 1.0, GIVEN), given))
    square = given * given
    ends = 2.0 * square[0] - square[1], *square, 2.0 * square[-1] - square[-2]
    widths = np.empty(KNOTS)
    widths[::2], widths[1::2] = given, np.sqrt(np.convolve(ends, _BETWEEN, "valid"))
    return np.asarray(widths.clip(0.0, 1.0))


WIDTHS: Final = np.array([_widths(number) for number in range(len(ORGANS))])
"""Relative width of each organ at `KNOTS` places, shape (organs, KNOTS); the row of blades is unused."""


def width_along(organ: NDArray[np.int32], place: Doubles, /) -> Doubles:
    """Return the relative width of organs other than blades (n,) at places (points,) along them, shape (n, points)."""
    knot = place * (KNOTS - 1)
    low = np.clip(knot.astype(np.int64), 0, KNOTS - 2)
    fraction = knot - low
    return np.asarray(WIDTHS[organ][:, low] * (1.0 - fraction) + WIDTHS[organ][:, low + 1] * fraction)


def eyed_along(organ: NDArray[np.int32], place: Doubles, /) -> Doubles:
    """Return the fraction of the eye's colour of organs (n,) at places (points,), shape (n, points)."""
    fades, ends = DYED[organ].T[:, :, None]
    return np.asarray(np.clip((ends - place) / (ends - fades), 0.0, 1.0))


def has_eyes(blades: Blades, /) -> bool:
    """Return whether heads have an eye of its own colour, as all with a disc or a capsule do."""
    return bool(np.isin(blades.organ, (DISC, CAPSULE)).any())


def any_eyes(growths: Iterable[Growth], /) -> bool:
    """Return whether the heads of any kind have an eye of its own colour."""
    return any(has_eyes(growth.models[0].blades) for growth in growths)


def bears_heads(growth: Growth, /) -> bool:
    """Return whether a kind bears heads."""
    return any(np.isin(model.blades.organ, HEADS).any() for model in growth.models)


def any_heads(growths: Iterable[Growth], /) -> bool:
    """Return whether any kind bears heads."""
    return any(map(bears_heads, growths))
