"""Morphing: drawing order of blades between their own places and their painted places (paper, section 4.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...around.outlook import Outlook
from ..strips.gather import lies_ahead
from ..strips.pool import is_reversed
from ..strips.representation import StripRepresentation
from .gather import Numbers, nearness
from .pool import BladePool
from .shown import Standing

AMONG = 0.02
"""Weight of a blade's own distance against its strip's: it orders the blades of one strip."""

DIAGONAL = 1.6
"""Distance added from one patch to the next farther one where blades lie on strips [patch sides]: more than any strip
distance within a patch, so that they are drawn patch after patch."""

HOME = 0.05
"""Morph up to which a blade may count as standing in its own place."""


def at_home(outlook: Outlook, shown: Standing, away: Floats, /) -> NDArray[np.bool_]:
    """Return a mask of the blades of morphing patches that count as standing in their own places, shape (m, blades).

    These are sorted among the standing blades around them, one by one: all in one frame, the order would flip along a
    whole border. The nearest come first, since morphing blades are drawn behind standing ones. `away` has the
    distances of their own places from the eye [m], shape (m, blades).
    """
    nearest, farthest = float(away.min(initial=np.inf)), float(away.max(initial=0.0))
    moved = outlook.appearance.morph[shown.rows][:, None] / np.float32(HOME)
    return np.asarray((away - nearest) / np.float32(max(farthest - nearest, 1e-6)) + moved <= 1.0)


def gather_morph(
    outlook: Outlook,
    pool: BladePool,
    strips: StripRepresentation,
    shown: Standing,
    /,
    *,
    away: Floats,
    left: Floats,
    home: NDArray[np.bool_],
) -> Numbers:
    """Return the numbers, as of `gather_blades`, of the blades of morphing patches in drawing order, shape (n,).

    The sort key goes with the morph from the distance of the blade's own place, far to near, to patch after patch and
    strip after strip, so that blades change places one by one. `away` has the distances of their own places from the
    eye [m], shape (m, blades), `left` the remaining cover of each patch's blades, shape (m,). Blades of the mask `home`
    (m, blades) are left out.
    """
    if not len(shown.rows):
        return np.zeros(0, np.uint32)
    patches, rows = outlook.patches, shown.rows
    ring, along = strips.ring_and_axis(outlook, rows)
    model, turn = patches.model[rows], patches.turn[rows]
    orientation = (along + turn) % 2
    counts = np.array([declared.strips for declared in strips.quality.strip_rings])[ring]
    plane = strips.stock.slices[ring, model, orientation]
    # Strips are counted from the far side, planes in the order of the model.
    backwards = is_reversed(orientation, along, turn) != lies_ahead(patches.cell[rows], outlook.viewer.centre, along)
    slices = np.where(backwards[:, None], counts[:, None] - 1 - plane, plane)
    side, moved = strips.quality.patch, outlook.appearance.morph[rows][:, None]
    behind = np.arange(len(rows), 0, -1)[:, None] * (DIAGONAL * side)
    on_strips = behind + (counts[:, None] - slices) * (side / counts[:, None]) + AMONG * away
    key = ((1.0 - moved) * away + moved * on_strips).astype(np.float32).reshape(-1)
    queue = np.argsort(nearness(key), kind="stable")
    count = pool.present.shape[1]
    numbers = ((shown.places * count).astype(np.uint32)[:, None] + np.arange(count, dtype=np.uint32)).reshape(-1)
    shows = (pool.present.take(shown.slots, axis=0) & (left > 0.0)[:, None] & ~home).reshape(-1)
    return np.asarray(numbers.take(queue[shows.take(queue)]), np.uint32)
