"""Morphing: blades on their way between their own places and their painted places (paper, section 4.2)."""

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats
from ...around.outlook import Outlook
from ..strips.gather import lies_ahead
from ..strips.pool import falls
from ..strips.representation import StripRepresentation
from .gather import Numbers, far_first
from .pool import BladePool
from .shown import Standing

AMONG = 0.02
"""How much their own distances count among blades that lie on one strip, of the distances between strips."""

DIAGONAL = 1.6
"""How much farther away than the next patch one counts where blades lie on strips, in sides: farther than any on it."""

HOME = 0.05
"""Part of the way from its own place up to which a blade may count as standing there."""


def at_home(outlook: Outlook, shown: Standing, away: Floats, /) -> NDArray[np.bool_]:
    """Return which blades of patches that are on their way are in their own places, as good as, shape (m, blades).

    They take their turn among those that stand around them one by one: all in one frame, what hides what would change
    along a whole border. The nearest come first, since what is still on its way is drawn behind what stands.
    `away` is how far their own places are from the eye, of the same shape.
    """
    assert outlook.appearance is not None
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
    """Return the numbers of the blades of patches that are on their way in this frame, in the order of drawing, (n,).

    They are counted as `gather_blades` does. Those that lie on strips come patch after patch and strip after strip,
    those in their own places from far to near; in between, they change places one by one. `away` is how far their own
    places are from the eye, shape (m, blades), and `left` how much each patch's blades still show, shape (m,). Those at
    `home` (m, blades) are left out.
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
    assert outlook.appearance is not None
    side, moved = strips.quality.patch, outlook.appearance.morph[rows][:, None]
    behind = np.arange(len(rows), 0, -1)[:, None] * (DIAGONAL * side)
    on_strips = behind + (counts[:, None] - slices) * (side / counts[:, None]) + AMONG * away
    queue = far_first(((1.0 - moved) * away + moved * on_strips).astype(np.float32).reshape(-1))
    each = pool.present.shape[1]
    numbers = ((shown.places * each).astype(np.uint32)[:, None] + np.arange(each, dtype=np.uint32)).reshape(-1)
    shows = (pool.present.take(shown.slots, axis=0) & (left > 0.0)[:, None] & ~home).reshape(-1)
    return np.asarray(numbers.take(queue[shows.take(queue)]), np.uint32)
