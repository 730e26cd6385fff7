"""Wind primitives: what every kind of wind is, the built-in ones and a stranger's alike."""

from abc import abstractmethod
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from .declaration import Declaration, DeclarationError

Floats = NDArray[np.float32]


class WindPrimitive(Declaration):
    """A wind as an object on the prairie (paper, section 3.3): a mask on the ground and an action inside it.

    A primitive keeps nothing between calls: `mask` and `action` are pure functions of places and a time, so
    that any machine computes the same wind at any time.
    """

    kind: str = Field(min_length=1)
    """Name of the primitive, as its plugin registers it."""

    priority: int = Field(0, ge=-1000, le=1000)
    """The highest priority at a place cancels the others (paper, section 3.3)."""

    start: float = Field(0.0, ge=0.0, le=36000.0)
    """When it begins [s]."""

    stop: float | None = Field(None, ge=0.0, le=36000.0)
    """When it ends [s]; without it, never."""

    @model_validator(mode="after")
    def _stop_after_start(self) -> "WindPrimitive":
        if self.stop is not None and self.stop <= self.start:
            raise DeclarationError(f"stop must be later than start, which is {self.start:g} s", "stop")
        return self

    @abstractmethod
    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return where it acts: weights in [0, 1], shape (n,), for ground positions (x, z) [m], shape (n, 2)."""

    @abstractmethod
    def action(self, place: Floats, /, *, time: float, seed: int) -> Floats:
        """Return the messages to receivers at ground positions (x, z) [m], both of shape (n, 2).

        A message is a vector along the bending direction whose norm is the posture index, in [0, 1].
        """


@dataclass(frozen=True, slots=True, eq=False)
class WindSource:
    """The component of a wind entity; the primitive is a field, so that any plugin's type is found."""

    primitive: WindPrimitive
    """The primitive itself."""

    name: str
    """How messages call it: its kind and its place in the scene."""


@dataclass(frozen=True, slots=True, eq=False)
class Receivers:
    """What collects the wind's messages for one patch in one representation (paper, section 3.2).

    One row per blade, or per vertical edge of a strip. The arrays are slices of one pool.
    """

    place: Floats
    """Ground position (x, z) [m], shape (n, 2)."""

    message: Floats
    """Bending direction times posture index, (x, z), shape (n, 2)."""
