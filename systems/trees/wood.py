"""Thin stems: at least a pixel wide, and of lower coverage instead."""

from typing import NamedTuple

import numpy as np

from ...components.arrays import Doubles

OPAQUE, FAINTEST = 0.8, 0.02
"""Coverage from which on a pixel is opaque, and below which it is discarded."""

SOLID = 0.58
"""Coverage from which on twigs on cards, and everything in a shadow map, are opaque.

From a half on, as much would be opaque as is covered in the mean, but the soft edges of what sticks out come on top.
Needles have a higher limit, from `solid_above`.

Soft parts are drawn from near to far: fainter ones let little of what is behind come to the front."""

CLOSED = 0.9
"""Coverage from which on pictures far off are opaque: most of a sparse crown covers a little less, and as opaque would
hide up to a tenth too much of the sky."""

THINNEST = 0.5
"""Least half width of a stem [pixels]."""

AWAY = 0.15
"""Least distance of a stem [m]: nearer ones count as so far."""

THINS = 0.35, 0.65
"""Coverage below which a stem among leaves is left out, and from which on it is drawn in full."""

LEAFY_FAINTEST, CROWN_DEPTH = 0.25, 4.0
"""Coverage below which a stem of a tree in full leaf is left out where it is nearest to the eye, and the optical depth
of its leaves: all other stems are fainter, and leaves hide them. Without leaves it is `FAINTEST`."""

FADES = 2.0, 4.0
"""Width from which on a stem's edges are soft, and from which on they are soft over a whole pixel [pixels]."""

FOLIAGES = 64
"""Steps of the share of leaves that `FAINTEST_STEM` is listed for."""

FLAT = 1e-9
"""Determinant below which a matrix has no perspective."""

SWAYS = 0.1
"""Greatest displacement by the wind, relative to a tree's reach."""

GLSL = {
    "OPAQUE": OPAQUE, "FAINTEST": FAINTEST, "THINNEST": THINNEST, "AWAY": AWAY, "THINS": THINS, "FADES": FADES,
}  # fmt: skip


class Parts(NamedTuple):
    """Triangles of `Wood` that are drawn."""

    solid: int
    """Index after the last triangle of `whole` that may cover whole pixels."""

    soft: int
    """Index after the last triangle of `edges` that may cover a part of a pixel."""

    solid_from: int = 0
    """Index of the first of these of `whole`."""

    soft_from: int = 0
    """Index of the first of these of `edges`."""


def nearest_ahead(clip: Doubles, middle: Doubles, eye: Doubles, reach: Doubles, /) -> Doubles:
    """Return the least depth of what is seen of trees, shape (n,) [m].

    `reach` holds half the height and the radius of each tree's upright bounding cylinder (n, 2) [m]. A part in the
    picture is at most a picture's corner away from straight ahead, so its depth is bounded by the distance along the
    ground, too.
    """
    forward = clip[3, :3]
    nearer = reach @ (abs(forward[1]), np.hypot(*forward[::2]))
    ahead = middle @ forward + clip[3, 3] - nearer
    rows = clip[[0, 1, 3], :3]
    if abs(np.linalg.det(rows)) < FLAT:
        return np.asarray(ahead)
    corners = np.linalg.solve(rows, np.array([[-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0], [1.0] * 4]))
    distance = np.hypot(middle[:, 0] - eye[0], middle[:, 2] - eye[2]) - reach[:, 1]
    return np.asarray(np.maximum(ahead, distance / np.linalg.norm(corners, axis=0).max()))


def _faintest_stems() -> list[float]:
    """Return the coverage of a stem below which `wood.vert` makes it too faint to be drawn, by the share of leaves.

    There are `FOLIAGES` equal steps from 0 to 1.
    """
    cover, foliage = np.linspace(0.0, 1.0, 513), np.linspace(0.0, 1.0, FOLIAGES + 1)[:, None]
    part = np.clip((cover - THINS[0]) / (THINS[1] - THINS[0]), 0.0, 1.0)
    drawn = cover * (1.0 - foliage + foliage * part * part * (3.0 - 2.0 * part))
    least = np.maximum(LEAFY_FAINTEST * np.exp(CROWN_DEPTH * (foliage - 1.0)), FAINTEST)
    faint: list[int] = (drawn < least).sum(axis=1).tolist()
    return [float(cover[max(count - 1, 0)]) for count in faint]


FAINTEST_STEM = _faintest_stems()


def parts(whole: Doubles, edges: Doubles, pixel_radius: float, foliage: float, /) -> Parts:
    """Return the triangles drawn of trees with at least a share of `foliage` of their leaves.

    `whole` and `edges` are the `radii` of these faces of `Wood`; `pixel_radius` is that of a stem a pixel wide at the
    nearest tree [m of the model].
    """

    def count(radii: Doubles, radius: float) -> int:
        return len(radii) - int(radii.searchsorted(radius))

    faintest = FAINTEST_STEM[int(FOLIAGES * min(foliage, 1.0))]
    return Parts(count(whole, OPAQUE * pixel_radius), count(edges, faintest * pixel_radius))
