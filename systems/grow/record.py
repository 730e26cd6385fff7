"""What is grown from a grass kind: postures, response, and patch models from the finest to the coarsest."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
Bytes = NDArray[np.uint8]


@dataclass(frozen=True, slots=True, eq=False)
class Postures:
    """Shapes of a blade by posture index (paper, section 3.2, figure 6)."""

    index: Floats
    """Posture index of each row, rising from -1 to 1 with 0 in the middle, shape (rows,)."""

    shape: Floats
    """Control points (along the bending direction, up) of a blade of length 1 that stands at the origin,
    shape (variants, rows, links + 1, 2). Variant 0 has even links; the others have random ones."""


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
    """The blades of one patch model, one row per blade (paper, section 2.2)."""

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


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """The blades of one patch model drawn on vertical strips, in both orientations (paper, section 2.1).

    Orientation 0 has strips along x, stacked in z; orientation 1 has strips along z, stacked in x.
    """

    plane: Floats
    """Distance of each strip's plane from the patch's edge [m], shape (strips,)."""

    texels: Bytes
    """Coverage-premultiplied meaning of each texel, bottom row first, shape (2, strips, h, w, 4): place along
    the blade, face normal x and z (each as 0.5 + 0.5 n), coverage."""

    rank: Bytes
    """Rank of the blade at each texel, not premultiplied, shape (2, strips, h, w)."""

    height: float
    """Height of the texture [m]."""

    margin: float
    """How far the texture reaches beyond the patch at either end [m]."""

    slice: NDArray[np.int32]
    """Strip that each blade is painted on, shape (2, n)."""

    targets: Floats
    """Texture coordinates (u, v) of each blade's control points: the morph's targets (paper, section 4.2),
    shape (2, n, points, 2)."""


@dataclass(frozen=True, slots=True, eq=False)
class Carpet:
    """Images of an endless field of one patch model from several viewing angles (paper, section 2.2).

    An image holds, for each point of the plane at mid-height, what a ray through it meets first.
    """

    slope: Floats
    """Tangent of the viewing elevation of each row of images, rising, shape (slopes,)."""

    texels: Bytes
    """Coverage-premultiplied meaning of each texel, shape (slopes, 4, r, r, 4): place along the blade, height
    as a fraction of `height`, face normal along the view (0.5 + 0.5 n), coverage. The four viewing directions
    are -z, +x, +z, -x in this order; rows go along z, columns along x."""

    height: float
    """Height of the canopy [m]."""

    offset: float
    """Height of the plane above the ground [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchModel:
    """One patch of grass in all three representations, grown from the finest to the coarsest."""

    blades: Blades
    strips: tuple[Strips, ...]
    """From the nearest ring to the farthest: fewer strips, coarser texels."""

    carpet: Carpet


@dataclass(frozen=True, slots=True, eq=False)
class Growth:
    """All that is precomputed for one kind of grass."""

    postures: Postures
    response: Response
    models: tuple[PatchModel, ...]
