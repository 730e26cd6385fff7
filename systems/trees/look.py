"""The viewpoint that trees are chosen for."""

from collections.abc import Sequence
from math import dist, inf, sqrt
from sys import float_info
from typing import NamedTuple

import numpy as np

from ...components.arrays import Doubles, Ints


class Look(NamedTuple):
    """The viewpoint and projection that trees are chosen for."""

    eye: Doubles
    """[m]."""

    sides: Doubles
    """Planes of the frustum, as `Viewer` has them."""

    clip: Doubles
    """Matrix from places to clip space, (4, 4)."""

    focal: float
    """Focal length [pixels]."""

    reach: float
    """Distance up to which grass is drawn from far to near [m]."""

    patch: float
    """Side of a patch of grass [m]."""

    centre: Ints
    """Cell that the viewer stands in, (2,)."""

    detail_eyes: Sequence[Doubles | tuple[float, float, float]] = ()
    """Eyes that level of detail is chosen for: the nearest one counts. Without any, `eye` does."""

    leaves_from: float | None = None
    """Height of their own pictures from which all trees are drawn leaf by leaf, and lower ones as pictures [pixels];
    None lets the size of leaves decide."""

    live: bool = True
    """Whether what was chosen for a viewpoint near by may serve; else a picture does not depend on those before it."""

    held: bool = False
    """Whether what was chosen last serves, as it was drawn then."""

    @property
    def is_usual(self) -> bool:
        """Whether level of detail is that of this viewpoint and trees may stay chosen: not in films and references."""
        return self.live and self.leaves_from is None and not self.detail_eyes


class Slack(NamedTuple):
    """Changes of a viewpoint within which what was chosen for it serves the new one, too."""

    moves: float
    """Of the eye, and of the reach of grass [m]."""

    shifts: float
    """Of a picture's sides where the eye was [m]."""

    turns: float
    """Of the normals of a picture's sides, unit vectors: about the angle [rad]."""

    zooms: float
    """Of the focal length, relative to it."""

    def used(self, before: Look, now: Look, /) -> float:
        """Return the greatest part of these changes that there is from one viewpoint to another."""
        if not (before.is_usual and now.is_usual):
            return inf
        change = now.sides - before.sides
        shift, turn = change[:, :3] @ before.eye + change[:, 3], np.einsum("ij,ij->i", change[:, :3], change[:, :3])
        return max(
            dist(now.eye, before.eye) / self.moves, abs(now.reach - before.reach) / self.moves,
            float(np.abs(shift).max()) / self.shifts, sqrt(turn.max()) / self.turns,
            abs(now.focal - before.focal) / (self.zooms * max(before.focal, float_info.min)),
        )  # fmt: skip

    def beside(self, distance: Doubles, /) -> Doubles:
        """Return how far outside one picture things in the other may be, by their distance from the eye [m]."""
        return np.asarray(self.turns * distance + self.shifts)
