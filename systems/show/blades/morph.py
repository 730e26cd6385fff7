"""Morphing: blades on their way between their own places and their painted places (paper, section 4.2)."""

import numpy as np
from numpy.typing import NDArray

from ...around.outlook import Outlook
from ..strips.gather import lies_ahead
from ..strips.representation import StripRepresentation
from ..strips.stand import falls
from .gather import Numbers, distances, nearness
from .pool import BladePool
from .shown import Standing

Floats = NDArray[np.float32]


def gather_morph(
    outlook: Outlook, pool: BladePool, strips: StripRepresentation, shown: Standing, /, *, left: Floats
) -> Numbers:
    """Return the numbers of the blades of patches that are on their way in this frame, in the order of drawing, (n,).

    Patch after patch, and in a patch strip after strip, as `gather_blades` counts them. `left` says how much each
    patch's blades still show, shape (m,).
    """
    if not len(shown.rows):
        return np.zeros(0, np.uint32)
    patches, rows = outlook.patches, shown.rows
    ring, along = strips.ring_and_axis(outlook, rows)
    model, turn = patches.model[rows], patches.turn[rows]
    own = (along + turn) % 2
    counts = np.array([each.strips for each in strips.quality.strip_rings])[ring]
    plane = strips.stock.slices[ring, model, own]
    # Strips are walked from the far side, planes in the order of the model.
    backwards = falls(own, along, turn) != lies_ahead(patches.cell[rows], outlook.viewer.centre, along)
    slices = np.where(backwards[:, None], counts[:, None] - 1 - plane, plane)
    away = nearness(distances(pool, shown.slots, (outlook.viewer.eye[0], outlook.viewer.eye[2])))
    # Patch after patch, in a patch slice after slice, far to near in a slice: one number says all of it.
    each = pool.present.shape[1]
    key = (np.arange(len(rows), dtype=np.uint64)[:, None] << 48) | (slices.astype(np.uint64) << 40)
    key |= (away.astype(np.uint64) << 24) | np.arange(each, dtype=np.uint64)
    queue = np.sort(key[pool.present.take(shown.slots, axis=0) & (left > 0.0)[:, None]])
    blade = (queue & np.uint64(0xFFFFFF)).astype(np.uint32)
    first = (shown.places * each).astype(np.uint32).take((queue >> np.uint64(48)).astype(np.intp))
    return np.asarray(first + blade, np.uint32)
