"""Geometry of bent blades: the one rule that blades, strips and carpet share, in numpy as on the GPU."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Doubles, Floats
from .organs import BLADE, GIVES, TONES, width_along
from .record import Blades, Postures
from .section import FLAT, Section

Side = tuple[float, float, float]
"""Unit vector to the viewer's right."""


def spine(blades: Blades, postures: Postures, message: ArrayLike, /, *, points: int) -> Floats:
    """Return points along bent blades, from root to tip at even steps, in the patch [m], shape (n, points, 3).

    `message` is the wind's, shape (n, 2) or (2,); the kind's give turns it into bending. To it, the lean at rest is
    added: total = bending + rest (1 - |bending|). The norm of the total, at most 1, is the posture index, its direction
    the bending direction. Shapes are interpolated linearly in the index and in the place along the blade.
    """
    blown = bending(postures, message)
    index, direction = posture_of(blades.rest, blown * GIVES[blades.organ][:, None])
    along, up = _look_up(postures, blades.variant, index, np.linspace(0.0, 1.0, points)[None])
    height = blades.height[:, None].astype(np.float64)
    place = np.empty((*along.shape, 3))
    place[:, :, 0] = blades.root[:, :1] + height * along * direction[:, :1]
    place[:, :, 1] = height * up
    place[:, :, 2] = blades.root[:, 1:] + height * along * direction[:, 1:]
    return (place + _on_stem(blades, postures, blown)[:, None]).astype(np.float32)


def _on_stem(blades: Blades, postures: Postures, blown: Doubles, /) -> Doubles:
    """Return the places of blades' feet on their stems, relative to their roots [m], shape (n, 3)."""
    index, direction = posture_of(np.broadcast_to(blades.stem_rest, blades.rest.shape), blown)
    place = np.broadcast_to(blades.part, blades.height.shape)[:, None].astype(np.float64)
    along, up = _look_up(postures, np.zeros_like(blades.variant), index, place)
    x, z = (along[:, 0] * direction[:, k] for k in (0, 1))
    return np.asarray(np.stack([x, up[:, 0], z], axis=1) * blades.stem[:, None].astype(np.float64))


def tone(blades: Blades, place: Doubles, /) -> Doubles:
    """Return the tones of points at places (points,) along blades, shape (n, points): 1 is the tip's colour."""
    low, high = TONES[np.broadcast_to(blades.organ, blades.height.shape)].T[:, :, None]
    return np.asarray(low + (high - low) * place[None])


def bending(postures: Postures, message: ArrayLike, /) -> Doubles:
    """Return the bending of a kind by messages: vectors along them as long as the posture index, same shape."""
    message = np.asarray(message, np.float64)
    length = np.linalg.norm(message, axis=-1, keepdims=True)
    return np.asarray(message / np.maximum(length, 1e-9) * postures.bent_by(length))


def posture_of(rest: ArrayLike, bending: ArrayLike, /) -> tuple[Doubles, Doubles]:
    """Return posture indices in [0, 1], shape (n,), and unit bending directions (x, z), shape (n, 2)."""
    rest, bending = np.asarray(rest, np.float64), np.asarray(bending, np.float64)
    left = np.maximum(1.0 - np.linalg.norm(bending, axis=-1, keepdims=True), 0.0)
    total = bending + rest * left
    index = np.linalg.norm(total, axis=-1)
    still = index < 1e-9
    direction = np.where(still[:, None], [1.0, 0.0], total / np.where(still, 1.0, index)[:, None])
    return np.minimum(index, 1.0), direction


WIDENS = 0.16
"""Fraction of a blade's length over which it widens from its waist at the ground."""

GLSL = {"WIDENS": WIDENS}


def profile(along: Doubles, taper: float, section: Section = FLAT, /) -> Doubles:
    """Return the relative width, 0 to 1, at places along a blade: it widens from its waist, then tapers."""
    waist = 1.0 - (1.0 - section.waist) * np.maximum(1.0 - along / WIDENS, 0.0)
    return np.asarray((1.0 - along) ** taper * waist)


def widths(blades: Blades, along: Doubles, taper: float, section: Section = FLAT, /) -> Doubles:
    """Return the widths of blades at places (points,) along them [m], shape (n, points)."""
    organ = np.broadcast_to(blades.organ, blades.height.shape)
    part = np.where((organ == BLADE)[:, None], profile(along, taper, section)[None], width_along(organ, along))
    return np.asarray(blades.width[:, None] * part)


def ribbon(
    blades: Blades,
    postures: Postures,
    message: ArrayLike,
    /,
    *,
    points: int,
    taper: float,
    section: Section = FLAT,
    side: Side | None = None,
) -> tuple[Floats, Floats]:
    """Return the left and right edge of bent blades [m], each of shape (n, points, 3).

    The half width follows `widths`, along the fixed horizontal axis across the face; with a round section, along
    `side`.
    """
    centre = spine(blades, postures, message, points=points)
    half = 0.5 * widths(blades, np.linspace(0.0, 1.0, points), taper, section)
    axis = across(blades)
    is_blade = np.broadcast_to(blades.organ, blades.height.shape) == BLADE
    # The tip is blunt, to make up for the area that the last straight segment cuts off.
    half[is_blade, -1] = half[is_blade, -2] * max((1.0 - taper) / (1.0 + taper), 0.0)
    if section.is_round and side is not None:
        axis = np.where(is_blade[:, None], side, axis)
    out = half[:, :, None] * axis[:, None, :]
    return (centre - out).astype(np.float32), (centre + out).astype(np.float32)


def sides_of(section: Section, /) -> tuple[Side | None, ...]:
    """Return the `side` of `ribbon` for views along z and along x; flat blades are the same in both, and need none."""
    return ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)) if section.is_round else (None,)


def across(blades: Blades, /) -> Doubles:
    """Return the unit width axis of each blade, horizontal and across its face, shape (n, 3)."""
    facing = blades.facing.astype(np.float64)
    return np.stack([-np.sin(facing), np.zeros_like(facing), np.cos(facing)], axis=1)


def segment_normals(blades: Blades, centre: Floats, /) -> Doubles:
    """Return the face normal of each segment of the blades along `centre`, shape (n, points - 1, 3).

    An upright blade's normal is (cos facing, 0, sin facing).
    """
    tangent = np.diff(centre.astype(np.float64), axis=1)
    normal = np.cross(tangent, across(blades)[:, None, :])
    return np.asarray(normal / np.linalg.norm(normal, axis=2, keepdims=True))


def _look_up(
    postures: Postures, variant: NDArray[np.int32], index: Doubles, place: Doubles, /
) -> tuple[Doubles, Doubles]:
    """Return (along, up) of blades of length 1 at indices (n,) and places (n or 1, points), shape (n, points) each."""
    rows, knots = postures.shape.shape[1:3]
    row = (index + 1.0) * 0.5 * (rows - 1)
    low_row = np.clip(row.astype(np.int64), 0, rows - 2)
    knot = place * (knots - 1)
    low_knot = np.clip(knot.astype(np.int64), 0, knots - 2)
    row_part = (row - low_row)[:, None, None]
    table = postures.shape
    curve = table[variant, low_row] * (1.0 - row_part) + table[variant, low_row + 1] * row_part
    knot_part = (knot - low_knot)[:, :, None]
    blade = np.arange(len(variant))[:, None]
    point = curve[blade, low_knot] * (1.0 - knot_part) + curve[blade, low_knot + 1] * knot_part
    return point[:, :, 0], point[:, :, 1]


def highest_tip(centre: Floats, texel: float, /) -> float:
    """Return the height of the highest tip, rounded up to whole texels [m]."""
    return float(np.ceil(np.float64(centre[:, :, 1].max()) / texel + 1e-6) * texel)
