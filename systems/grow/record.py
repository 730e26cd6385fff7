"""What is grown from a grass kind: postures, response, and patch models."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats

GIVES = 17
"""Lengths of messages, evenly spaced from 0 to 1, for which it is known how far a kind gives way."""

LENGTHS = np.linspace(0.0, 1.0, GIVES)
"""These lengths, shape (GIVES,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Postures:
    """Shapes of a blade by posture index (paper, section 3.2, figure 6)."""

    index: Floats
    """Posture index of each row, rising from -1 to 1 with 0 in the middle, shape (rows,)."""

    shape: Floats
    """Control points (along the bending direction, up) of a blade of length 1 that stands at the origin,
    shape (variants, rows, links + 1, 2). Variant 0 has even links; the others have random ones."""

    give: Floats = field(default_factory=lambda: np.linspace(0.0, 1.0, GIVES, dtype=np.float32))
    """Posture index that messages of evenly spaced lengths from 0 to 1 bend a blade to, shape (GIVES,): a stiff kind
    gives way less than the message says, a soft one more, and one of stiffness 1 as far."""

    def bent_by(self, length: NDArray[np.float64] | float, /) -> NDArray[np.float64]:
        """Return the posture indices that messages of these lengths bend a blade to, of the same shape."""
        return np.asarray(np.interp(length, LENGTHS, self.give))


@dataclass(frozen=True, slots=True, eq=False)
class Response:
    """Posture index over time, relative to a constant wind's final index (paper, section 3.3, figure 8)."""

    step: float
    """Time between samples [s]."""

    rise: Floats
    """Index after the wind starts, from 0 past 1 and back to 1, shape (samples,)."""

    fall: Floats
    """Index after the wind stops, from 1 past 0 and back to 0, shape (samples,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Blades:
    """The blades of one patch model, one row per blade (paper, section 2.2).

    A plant other than grass is several rows of the same root and rank: its stem, its leaves, what its head is made of.
    """

    root: Floats
    """Root in the patch, (x, z) in [0, patch) [m], shape (n, 2)."""

    height: Floats
    """Length of the blade [m], shape (n,)."""

    width: Floats
    """Width at the root [m], shape (n,)."""

    facing: Floats
    """Azimuth of the blade's face normal, from +x towards +z [rad], shape (n,)."""

    rest: Floats
    """The blade's own lean: bending direction times posture index at rest, (x, z), shape (n, 2)."""

    variant: NDArray[np.int32]
    """Row of `Postures.shape` that the blade takes its shapes from, shape (n,)."""

    rank: Floats
    """Order of disappearance in [0, 1): a blade is there where the density exceeds it, shape (n,)."""

    organ: NDArray[np.int32] = field(default_factory=lambda: np.zeros(1, np.int32))
    """What it is, a number of `ORGANS`, shape (n,), or (1,) for all."""

    stem: Floats = field(default_factory=lambda: np.zeros(1, np.float32))
    """Length of the stem that it stands on, 0 for the ground [m], shape (n,), or (1,) for all. The stem is a row of its
    own, of variant 0, with the same root."""

    part: Floats = field(default_factory=lambda: np.ones(1, np.float32))
    """Where along its stem it stands, from 0 at the root to 1 at the top, shape (n,), or (1,) for all."""

    stem_rest: Floats = field(default_factory=lambda: np.zeros((1, 2), np.float32))
    """The lean of its stem, as `rest` is its own, shape (n, 2), or (1, 2) for all."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchModel:
    """One patch of grass: its blades, and what each representation has grown from them."""

    blades: Blades
    pictures: Mapping[str, tuple[Any, ...]]
    """By representation, the records that it has grown, in its own order."""


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Growth:
    """All that is precomputed for one kind of grass."""

    postures: Postures
    response: Response
    models: tuple[PatchModel, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Form:
    """What one kind of grass has grown to, or is to become."""

    number: int
    """Which form it is: that of kind k is k, and what it is to become is k plus as many as there are kinds."""

    kind: int
    growth: Growth


NOTHING: Mapping[int, Growth] = MappingProxyType({})
"""Where no kind is to become anything else."""


def forms_of(growths: Sequence[Growth], coming: Mapping[int, Growth] = NOTHING, /) -> tuple[Form, ...]:
    """Return the forms of all kinds, and after them what some are to become, by kind."""
    own = [Form(kind, kind, growth) for kind, growth in enumerate(growths)]
    return *own, *(Form(len(growths) + kind, kind, coming[kind]) for kind in sorted(coming))
