"""Where a bent blade is: the one rule that blades, strips and carpet share, in numpy as on the GPU."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...components.arrays import Doubles, Floats
from .organs import BLADE, GIVES, TONES, width_along
from .record import Blades, Postures
from .section import FLAT, Section


def spine(blades: Blades, postures: Postures, message: ArrayLike, /, *, points: int) -> Floats:
    """Return points along bent blades, from root to tip at even steps, in the patch [m], shape (n, points, 3).

    `message` is the wind's, shape (n, 2) or (2,); it bends a kind as far as that gives way. Rest leans add to this by
    what it leaves over: total = bending + rest (1 - |bending|); its norm is the posture index, never above 1, its
    direction the bending direction. Shapes are looked up linearly in index and in the place along the blade.
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
    """Return the places on their stems that blades stand on, from their roots [m], shape (n, 3)."""
    index, direction = posture_of(np.broadcast_to(blades.stem_rest, blades.rest.shape), blown)
    place = np.broadcast_to(blades.part, blades.height.shape)[:, None].astype(np.float64)
    along, up = _look_up(postures, np.zeros_like(blades.variant), index, place)
    x, z = (along[:, 0] * direction[:, k] for k in (0, 1))
    return np.asarray(np.stack([x, up[:, 0], z], axis=1) * blades.stem[:, None].astype(np.float64))


def tone(blades: Blades, place: Doubles, /) -> Doubles:
    """Return how far points at places (points,) along blades have the tip's colour, shape (n, points)."""
    low, high = TONES[np.broadcast_to(blades.organ, blades.height.shape)].T[:, :, None]
    return np.asarray(low + (high - low) * place[None])


def bending(postures: Postures, message: ArrayLike, /) -> Doubles:
    """Return how messages bend a kind: vectors along them as long as the posture index, same shape as `message`."""
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
"""The part of a blade's length over which it widens from its waist at the ground."""

GLSL = {"WIDENS": WIDENS}


def profile(along: Doubles, taper: float, section: Section = FLAT, /) -> Doubles:
    """Return the width at places along a blade, 0 to 1, as a part of its own: it widens from the root, then tapers."""
    waist = 1.0 - (1.0 - section.waist) * np.maximum(1.0 - along / WIDENS, 0.0)
    return np.asarray((1.0 - along) ** taper * waist)


def widths(blades: Blades, along: Doubles, taper: float, section: Section = FLAT, /) -> Doubles:
    """Return how wide blades are at places (points,) along them [m], shape (n, points)."""
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
    side: tuple[float, float, float] | None = None,
) -> tuple[Floats, Floats]:
    """Return the left and right edge of bent blades [m], each of shape (n, points, 3).

    The half width follows `widths`, along the fixed horizontal axis across the face; of blades with a round section,
    along `side`, the unit vector to the right of whoever looks at them.
    """
    centre = spine(blades, postures, message, points=points)
    half = 0.5 * widths(blades, np.linspace(0.0, 1.0, points), taper, section)
    axis = across(blades)
    own = np.broadcast_to(blades.organ, blades.height.shape) == BLADE
    # As blunt as makes up for what the last piece cuts off.
    half[own, -1] = half[own, -2] * max((1.0 - taper) / (1.0 + taper), 0.0)
    if section.is_round and side is not None:
        axis = np.where(own[:, None], side, axis)
    out = half[:, :, None] * axis[:, None, :]
    return (centre - out).astype(np.float32), (centre + out).astype(np.float32)


def across(blades: Blades, /) -> Doubles:
    """Return the width axis of each blade, horizontal and across its face, shape (n, 3)."""
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
    """Return (along, up) of unit blades at indices (n,) and places (n or 1, points), each of shape (n, points)."""
    rows, knots = postures.shape.shape[1:3]
    row = (index + 1.0) * 0.5 * (rows - 1)
    below = np.clip(row.astype(np.int64), 0, rows - 2)
    knot = place * (knots - 1)
    before = np.clip(knot.astype(np.int64), 0, knots - 2)
    upper = (row - below)[:, None, None]
    table = postures.shape
    curve = table[variant, below] * (1.0 - upper) + table[variant, below + 1] * upper
    later = (knot - before)[:, :, None]
    blade = np.arange(len(variant))[:, None]
    point = curve[blade, before] * (1.0 - later) + curve[blade, before + 1] * later
    return point[:, :, 0], point[:, :, 1]


def highest_tip(centre: Floats, texel: float, /) -> float:
    """Return the height of the highest tip, rounded up to a texel [m]."""
    return float(np.ceil(np.float64(centre[:, :, 1].max()) / texel + 1e-6) * texel)
