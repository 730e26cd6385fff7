"""How thin wood is drawn: none narrower than a pixel, and less of what would cover less of one."""

from typing import NamedTuple

import numpy as np

from ...components.arrays import Doubles

OPAQUE, FAINTEST = 0.8, 0.02
"""Coverage of a pixel from which on what is there is opaque, and below which it is left out."""

SOLID = 0.58
"""Coverage from which on that is so of twigs on cards, and of all of a tree in a shadow map.

From a half on, as much would be opaque as is covered in the mean, and soft edges of what sticks out would come
besides. Of needles it is more, as `solid_above` says.

Soft parts are drawn from near to far: fainter ones let little of what is behind come to the front."""

CLOSED = 0.9
"""Coverage from which on that is so of pictures of trees far off: most of a sparse crown covers a little less, and as
opaque would hide up to a tenth too much of the sky."""

THINNEST = 0.5
"""Half the width that a stem has at least [pixels]."""

AWAY = 0.15
"""How far off a stem counts as at least [m]."""

THINS = 0.35, 0.65
"""Coverage at which a stem is left out among leaves, and from which on it is drawn in full."""

FADES = 2.0, 4.0
"""Width from which on a stem's edges begin to fade, and from which on they do so over a whole pixel [pixels]."""

LEAFY = 0.95
"""Share of its leaves from which on a tree's thin stems are left out."""

FLAT = 1e-9
"""Determinant below which a matrix shows no perspective."""

SWAYS = 0.1
"""How much nearer or farther off the wind sways what is a tree's, of its reach."""

GLSL = {
    "OPAQUE": OPAQUE, "FAINTEST": FAINTEST, "THINNEST": THINNEST, "AWAY": AWAY, "THINS": THINS, "FADES": FADES,
}  # fmt: skip


class Parts(NamedTuple):
    """Which of the triangles of wood are drawn, of those of its distance, in their order."""

    solid: int
    """So many first ones may cover pixels wholly."""

    soft: int
    """So many first ones cover some pixels in part, at their edges."""


def nearest_ahead(clip: Doubles, middle: Doubles, eye: Doubles, reach: Doubles, /) -> Doubles:
    """Return how far ahead of the eye what is seen of trees lies at least, shape (n,) [m].

    `reach` is how far each goes from its middle, and how far aside (n, 2) [m]: no part of it is nearer than that leaves
    over of its distance along the ground, nor farther from straight ahead than a picture's corner.
    """
    ahead = middle @ clip[3, :3] + clip[3, 3] - reach[:, 0] * np.linalg.norm(clip[3, :3])
    rows = clip[[0, 1, 3], :3]
    if abs(np.linalg.det(rows)) < FLAT:
        return np.asarray(ahead)
    corners = np.linalg.solve(rows, np.array([[-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0], [1.0] * 4]))
    off = np.hypot(middle[:, 0] - eye[0], middle[:, 2] - eye[2]) - reach[:, 1]
    return np.asarray(np.maximum(ahead, off / np.linalg.norm(corners, axis=0).max()))


def parts(radii: Doubles, wide: float, foliage: float, /) -> Parts:
    """Return what is drawn of the wood of trees that have so many of their leaves, or more.

    `radii` are those of the model's triangles, as `Wood` has them; `wide` is the radius of one that is a pixel wide,
    where a tree is nearest [m of the model].
    """

    def so_thick(radius: float) -> int:
        return len(radii) - int(np.searchsorted(radii, radius))

    return Parts(so_thick(OPAQUE * wide), so_thick(THINS[0] * wide) if foliage >= LEAFY else len(radii))
