"""The organs of plants: how wide each is along itself, where on its kind's ramp of pigment, and how it gives way."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from .record import Blades, Growth

KNOTS = 5
"""Places along an organ, evenly from root to tip, at which its width is known."""


@dataclass(frozen=True, slots=True)
class Organ:
    """What all organs of one sort have in common; each is a ribbon."""

    widths: tuple[float, ...]
    """Width at `KNOTS` places from root to tip, relative to its own; none for a blade: it tapers as its kind says."""

    tones: tuple[float, float]
    """Where its root and its tip are on the way from the kind's colour `root`, 0, to its colour `tip`, 1."""

    gives: float = 1.0
    """How far the wind bends it by itself, of how far it bends a blade; what it stands on carries it besides."""

    teeth: int = 0
    """How many small things stand along either side of it, as florets do, or the leaves of a twig: teeth of its
    outline, which are drawn where they are seen. Far off and wherever it is painted it has their mean width."""

    ligules: int = 0
    """How many narrow petals it really is, side by side and of many lengths, as in a dandelion: likewise."""

    dyed: tuple[float, float] = (-2.0, -1.0)
    """Up to which part of it, from its root, it has the colour of its head's eye, and from which on none of that."""


BLADE, STEM, LEAF, FROND, PETAL, EYE, BUD, RAY, TUFT, WITHERED, FLORETS, SPRIG, STRAP = range(13)
BLOTCHED, DISC, STAMENS, CAPSULE = range(13, 17)

ORGANS: Final = (
    Organ((), (0.0, 1.0)),
    Organ((1.0, 0.9, 0.8, 0.75, 0.7), (0.0, 0.06)),
    Organ((0.35, 0.85, 1.0, 0.75, 0.05), (0.0, 0.08)),
    Organ((0.25, 0.9, 1.0, 0.7, 0.05), (0.1, 0.9)),
    Organ((0.3, 0.75, 1.0, 0.95, 0.4), (0.62, 1.0), 0.35),
    Organ((0.7, 1.0, 1.0, 0.9, 0.5), (0.2, 0.4), 0.35),
    Organ((0.6, 1.0, 0.95, 0.7, 0.15), (0.0, 0.3), 0.35),
    Organ((0.06, 0.06, 0.07, 0.9, 0.6), (0.1, 1.0), 0.35),
    Organ((0.7, 1.0, 0.9, 0.6, 0.1), (0.8, 1.0), 0.8),
    Organ((0.5, 0.75, 0.65, 0.4, 0.05), (0.75, 1.0), 0.7),
    Organ((0.5, 0.9, 1.0, 0.8, 0.2), (0.7, 1.0), teeth=6),
    Organ((0.35, 0.8, 1.0, 0.85, 0.3), (0.0, 0.1), teeth=6),
    Organ((0.3, 0.7, 0.95, 1.0, 0.6), (0.7, 1.0), 0.35, ligules=10),
    Organ((0.3, 0.75, 1.0, 0.95, 0.4), (0.9, 1.0), 0.35, dyed=(0.2, 0.48)),
    Organ((0.5, 0.85, 1.0, 1.0, 0.7), (1.0, 1.0), 0.35, dyed=(1.0, 2.0)),
    Organ((0.3, 0.65, 0.95, 1.0, 0.5), (1.0, 1.0), 0.35, dyed=(1.0, 2.0)),
    Organ((0.45, 0.8, 1.0, 1.0, 0.8), (0.02, 0.12), 0.35),
)
"""By number. `LEAF` belongs to a plant with a head, whose colour is the tip's, and `FROND` to one without. `EYE` is the
middle of an open head, `RAY` one of an umbel's, whose florets are its end; plumes are made of `TUFT`. `WITHERED` grass
is as pale as tips are, thinner, and stiffer. `FLORETS` are some of a spike's, one above another, and a `SPRIG`
a shrub's short twig with its leaves. Both give way as what they stand on does, and so stay close to it. `STRAP` is
what a disc of many petals is made of: some narrow ones beside one another, as in dandelions and daisies. Heads with an
eye of a colour of its own have `BLOTCHED` petals about `STAMENS` and a `CAPSULE`, as poppies do; if they have many
petals, these stand about a `DISC` of florets, as a daisy's."""

HEADS: Final = (PETAL, EYE, BUD, RAY, TUFT, FLORETS, STRAP, BLOTCHED, DISC, STAMENS, CAPSULE)
"""Those that heads are made of."""

AT_TIPS: Final = (PETAL, EYE, BUD, RAY, STRAP, BLOTCHED, DISC, STAMENS, CAPSULE)
"""Those of them that stand on the tip of a stem, over one another."""

LEAVES: Final = (LEAF, FROND, WITHERED)
"""Those that have a rib in their middle, as blades have."""

TONES: Final = np.array([organ.tones for organ in ORGANS])
"""By organ: tone at its root and at its tip, shape (organs, 2)."""

TEETH: Final = np.array([organ.teeth for organ in ORGANS])
"""By organ: how many teeth either side of it has, shape (organs,)."""

LIGULES: Final = np.array([organ.ligules for organ in ORGANS])
"""By organ: how many narrow petals it is, shape (organs,)."""

GIVES: Final = np.array([organ.gives for organ in ORGANS])
"""By organ: how far the wind bends it by itself, shape (organs,)."""

DYED: Final = np.array([organ.dyed for organ in ORGANS])
"""By organ: up to where it has the colour of its head's eye, and from where on none of that, shape (organs, 2)."""

WIDTHS: Final = np.array([organ.widths or (0.0,) * KNOTS for organ in ORGANS])
"""By organ: width at `KNOTS` places; that of a blade is no row of it, shape (organs, KNOTS)."""


def width_along(organ: NDArray[np.int32], place: Doubles, /) -> Doubles:
    """Return the width of organs other than blades (n,) at places (points,) along them, shape (n, points)."""
    at = place * (KNOTS - 1)
    low = np.clip(at.astype(np.int64), 0, KNOTS - 2)
    part = at - low
    return np.asarray(WIDTHS[organ][:, low] * (1.0 - part) + WIDTHS[organ][:, low + 1] * part)


def eyed_along(organ: NDArray[np.int32], place: Doubles, /) -> Doubles:
    """Return how far organs (n,) have the colour of their head's eye at places (points,), shape (n, points)."""
    to, none = DYED[organ].T[:, :, None]
    return np.asarray(np.clip((none - place) / (none - to), 0.0, 1.0))


def has_eyes(blades: Blades, /) -> bool:
    """Return whether the heads of blades have an eye of a colour of its own: each of these has a disc or a capsule."""
    return bool(np.isin(blades.organ, (DISC, CAPSULE)).any())


def any_eyes(growths: Iterable[Growth], /) -> bool:
    """Return whether the heads of any kind have eyes."""
    return any(has_eyes(growth.models[0].blades) for growth in growths)


def bears_heads(growth: Growth, /) -> bool:
    """Return whether a kind bears heads."""
    return any(np.isin(model.blades.organ, HEADS).any() for model in growth.models)


def any_heads(growths: Iterable[Growth], /) -> bool:
    """Return whether any kind bears heads."""
    return any(map(bears_heads, growths))
