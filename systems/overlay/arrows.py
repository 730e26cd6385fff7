"""Arrows: the messages that receivers hold, read from their pools (paper, figure 10)."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.terrain.record import Terrain
from ...engine.terrain.sample import height_at, slope_at
from ..around.outlook import Outlook
from .marks import Marks, on_ground, stroked, together
from .paint import DARK, index_color

SPACING = 0.042
"""Distance between arrows 1 m away, seen from straight above [m]; farther off it grows, so that they look as dense."""

CLOSEST = 0.5
"""Least distance between arrows [m]."""

NEAREST = 1.0
"""Distance from the eye within which there are none [m]."""

GRAZING = 0.012
"""Sine of the least angle at which the ground may be seen and still has arrows."""

LONGEST = 0.08
"""Length of an arrow of index 1, as a part of its distance from the eye; where arrows stand closer, it is less."""

HEAD, SPREAD = 0.36, 0.45
"""Length of an arrow's head, as a part of the arrow's; half the head's width, as a part of its length."""


def felt(outlook: Outlook, /) -> tuple[Floats, Floats]:
    """Return places (x, z) [m] and messages of all receivers of grass that is shown, both of shape (n, 2)."""
    place, message = [], []
    for kept in outlook.kept.values():
        for receiving in kept.receiving:
            if receiving.still:
                continue
            grows = receiving.pool.grows(receiving.slots, outlook.patches.cell[receiving.rows])
            place.append(receiving.pool.places(receiving.slots).reshape(-1, 2)[grows])
            message.append(receiving.letters.messages(receiving.slots).reshape(-1, 2)[grows])
    return np.concatenate(place), np.concatenate(message)


def thinned(
    place: Floats, height: Floats, slope: Floats, /, *, eye: tuple[float, float, float]
) -> tuple[NDArray[np.intp], Floats]:
    """Return rows of places that are about evenly spread in the picture, and how long an arrow may be there [m].

    Places are ground positions (n, 2) [m], with the ground's height (n,) [m] and slope (n, 2) there. The ground is
    parted into squares, larger ones where it is farther off or seen at a more grazing angle; of each the place nearest
    its middle is taken. So the same receivers stay chosen while the eye stays about where it is.
    """
    ray = np.array(eye, np.float32) - np.stack([place[:, 0], height, place[:, 1]], axis=1)
    away = np.maximum(np.sqrt((ray * ray).sum(axis=1)), np.float32(1e-3))
    facing = ray[:, 1] - ray[:, 0] * slope[:, 0] - ray[:, 2] * slope[:, 1]
    sine = facing / (away * np.sqrt(1.0 + (slope * slope).sum(axis=1)))
    wanted = SPACING * away / np.sqrt(np.maximum(sine, GRAZING))
    level = np.maximum(np.round(np.log2(wanted / CLOSEST)), 0.0)
    apart = (CLOSEST * np.exp2(level)).astype(np.float32)
    square = np.floor(place / apart[:, None])
    off_middle = np.abs(place / apart[:, None] - square - 0.5).max(axis=1)
    rows = np.flatnonzero((away > NEAREST) & (sine > GRAZING))
    key = np.stack([level, *square.T], axis=1)[rows].astype(np.int64)
    order = np.lexsort((off_middle[rows], *key.T))
    fresh = (np.diff(key[order], axis=0, prepend=-(2**31)) != 0).any(axis=1)
    chosen = rows[order[fresh]]
    return chosen, np.minimum(apart, np.float32(LONGEST) * away)[chosen]


def arrows(
    place: Floats, message: Floats, longest: Floats, terrain: Terrain, /, *, eye: tuple[float, float, float]
) -> Marks:
    """Return arrows on the ground from places (n, 2) along messages (n, 2): the index is their length and colour.

    `longest` is the length of an arrow of index 1 [m], shape (n,). Their heads are turned to the eye: on ground that is
    seen at a grazing angle, flat ones would be mere lines.
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
    """Return what receivers feel, as arrows: a readable part of them, the nearer the more."""
    place, message = felt(outlook)
    height, slope = height_at(terrain, place), slope_at(terrain, place)
    rows, longest = thinned(place, height, slope, eye=outlook.viewer.eye)
    return arrows(place[rows], message[rows], longest, terrain, eye=outlook.viewer.eye)
