"""Growths of grass kinds: postures, response, and patch models."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats

GIVES = 17
"""Number of message lengths at which a kind's give is tabulated, evenly spaced from 0 to 1."""

LENGTHS = np.linspace(0.0, 1.0, GIVES)
"""Message lengths at which a kind's give is tabulated, shape (GIVES,)."""


@dataclass(frozen=True, slots=True, eq=False)
class Postures:
    """Shapes of a blade by posture index (paper, section 3.2, figure 6)."""

    index: Floats
    """Posture index of each row, rising from -1 to 1 with 0 in the middle, shape (rows,)."""

    shape: Floats
    """Control points (along the bending direction, up) of a blade of length 1 that stands at the origin,
    shape (variants, rows, links + 1, 2). Variant 0 has even links; the others have random ones."""

    give: Floats = field(default_factory=lambda: np.linspace(0.0, 1.0, GIVES, dtype=np.float32))
    """Posture index to which messages of `LENGTHS` bend a blade, shape (GIVES,): less than the length for a stiff kind,
    more for a soft one, the same at stiffness 1."""

    def bent_by(self, length: NDArray[np.float64] | float, /) -> NDArray[np.float64]:
        """Return the posture indices to which messages of these lengths bend a blade, same shape."""
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

    A plant other than grass is several rows of the same root and rank: its stems, its leaves, and organs of its heads.
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
    """Lean of the blade at rest: bending direction times posture index, (x, z), shape (n, 2)."""

    variant: NDArray[np.int32]
    """Row of `Postures.shape` that the blade takes its shapes from, shape (n,)."""

    rank: Floats
    """Rank in [0, 1): the blade grows where the density is above it, shape (n,)."""

    organ: NDArray[np.int32] = field(default_factory=lambda: np.zeros(1, np.int32))
    """Index of its organ in `ORGANS`, shape (n,), or (1,) for all."""

    stem: Floats = field(default_factory=lambda: np.zeros(1, np.float32))
    """Length of the stem that it stands on, 0 for the ground [m], shape (n,), or (1,) for all. The stem is a row of its
    own, of variant 0, with the same root."""

    part: Floats = field(default_factory=lambda: np.ones(1, np.float32))
    """Place along its stem, from 0 at the root to 1 at the top, shape (n,), or (1,) for all."""

    stem_rest: Floats = field(default_factory=lambda: np.zeros((1, 2), np.float32))
    """Lean of its stem at rest, in the form of `rest`, shape (n, 2), or (1, 2) for all."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchModel:
    """One patch of grass: its blades, and what each representation has grown from them."""

    blades: Blades
    pictures: Mapping[str, tuple[Any, ...]]
    """Records that each representation has grown, by its name."""


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Growth:
    """All that is precomputed for one kind of grass."""

    postures: Postures
    response: Response
    models: tuple[PatchModel, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Form:
    """A present or future form of a kind of grass."""

    number: int
    """Index of the form: k for the present form of kind k, k plus the number of kinds for its future form."""

    kind: int
    growth: Growth


NOTHING: Mapping[int, Growth] = MappingProxyType({})
"""Growths to come where no kind is to become another."""


def forms_of(growths: Sequence[Growth], coming: Mapping[int, Growth], /) -> tuple[Form, ...]:
    """Return what all kinds are now, then what the kinds of `coming` are to become, by kind."""
    now = [Form(kind, kind, growth) for kind, growth in enumerate(growths)]
    return *now, *(Form(len(growths) + kind, kind, coming[kind]) for kind in sorted(coming))
