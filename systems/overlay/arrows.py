"""Arrows: messages of receivers, read from their pools (paper, figure 10)."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import height_at, slope_at
from ..around.outlook import Outlook
from .marks import Marks, on_ground, stroked, together
from .paint import DARK, index_color

SPACING = 0.042
"""Spacing of arrows 1 m below the eye [m]; it grows with distance, so that their density in the picture is even."""

CLOSEST = 0.5
"""Smallest spacing of arrows [m]."""

NEAREST = 1.0
"""Distance from the eye within which there are no arrows [m]."""

GRAZING = 0.012
"""Sine of the smallest angle between line of sight and ground at which there are arrows."""

LONGEST = 0.08
"""Length of an arrow of index 1, relative to its distance from the eye; it is at most the spacing."""

HEAD, SPREAD = 0.36, 0.45
"""Length of an arrow's head, relative to the arrow's; half the head's width, relative to the head's length."""


def messages_of_shown(outlook: Outlook, /) -> tuple[Floats, Floats]:
    """Return positions (x, z) [m] and messages of all receivers of shown grass, both of shape (n, 2)."""
    place, message = [], []
    for kept in outlook.kept.values():
        for receiving in kept.receiving:
            if receiving.still:
                continue
            grows = receiving.pool.grows(receiving.slots, outlook.patches.cell[receiving.rows])
            place.append(receiving.pool.places(receiving.slots).reshape(-1, 2)[grows])
            message.append(receiving.messages.current(receiving.slots).reshape(-1, 2)[grows])
    return np.concatenate(place), np.concatenate(message)


def evenly_spread(
    place: Floats, height: Floats, slope: Floats, /, *, eye: tuple[float, float, float]
) -> tuple[NDArray[np.intp], Floats]:
    """Choose places spread evenly in the picture; return their rows, and the largest length of an arrow there [m].

    Places are ground positions (n, 2) [m], with the ground's height (n,) [m] and slope (n, 2). The ground is divided
    into squares, larger ones with distance and at grazing angles. In each square, the place nearest its middle is
    chosen, so that the choice stays while the eye hardly moves.
    """
    ray = np.array(eye, np.float32) - np.stack([place[:, 0], height, place[:, 1]], axis=1)
    distance = np.maximum(np.sqrt((ray * ray).sum(axis=1)), np.float32(1e-3))
    height_over_slope = ray[:, 1] - ray[:, 0] * slope[:, 0] - ray[:, 2] * slope[:, 1]
    sine = height_over_slope / (distance * np.sqrt(1.0 + (slope * slope).sum(axis=1)))
    target_spacing = SPACING * distance / np.sqrt(np.maximum(sine, GRAZING))
    level = np.maximum(np.round(np.log2(target_spacing / CLOSEST)), 0.0)
    spacing = (CLOSEST * np.exp2(level)).astype(np.float32)
    square = np.floor(place / spacing[:, None])
    off_middle = np.abs(place / spacing[:, None] - square - 0.5).max(axis=1)
    rows = np.flatnonzero((distance > NEAREST) & (sine > GRAZING))
    key = np.stack([level, *square.T], axis=1)[rows].astype(np.int64)
    order = np.lexsort((off_middle[rows], *key.T))
    is_first = (np.diff(key[order], axis=0, prepend=-(2**31)) != 0).any(axis=1)
    chosen = rows[order[is_first]]
    return chosen, np.minimum(spacing, np.float32(LONGEST) * distance)[chosen]


def arrows(
    place: Floats, message: Floats, longest: Floats, terrain: Terrain, /, *, eye: tuple[float, float, float]
) -> Marks:
    """Return arrows on the ground from places (n, 2) along messages (n, 2), with length and colour by the index.

    `longest` is the length of an arrow of index 1 [m], shape (n,). Heads face the eye: on ground seen at a grazing
    angle, flat ones would look like lines.
    """
    foot, tip = on_ground(terrain, place), on_ground(terrain, place + message * longest[:, None])
    run = tip - foot
    aside = np.cross(run, np.asarray(eye, np.float32) - tip)
    wide = np.linalg.norm(run, axis=1) / np.maximum(np.linalg.norm(aside, axis=1), 1e-6)
    aside *= (HEAD * SPREAD * wide)[:, None].astype(np.float32)
    barb = tip - np.float32(HEAD) * run
    starts, ends = np.concatenate([foot, barb + aside, barb - aside]), np.concatenate([tip, tip, tip])
    color = np.ones((3 * len(place), 4), np.float32)
    color[:, :3] = np.tile(index_color(np.hypot(message[:, 0], message[:, 1])), (3, 1))
    return together(
        stroked(starts, ends, (*DARK, 0.5), width=4.6),
        stroked(starts, ends, color, width=2.2),
    )


def arrow_marks(outlook: Outlook, terrain: Terrain, /) -> Marks:
    """Return arrows for the messages of a readable selection of receivers."""
    place, message = messages_of_shown(outlook)
    height, slope = height_at(terrain, place), slope_at(terrain, place)
    rows, longest = evenly_spread(place, height, slope, eye=outlook.viewer.eye)
    return arrows(place[rows], message[rows], longest, terrain, eye=outlook.viewer.eye)
