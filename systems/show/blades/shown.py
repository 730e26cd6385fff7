"""Which patches have blades in a frame, in which ring, and which of them are on their way to their strips."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....components.arrays import Floats, Rows
from ...around.outlook import Outlook
from ...around.patches import PatchTable
from ...space.window import window_rows


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """Patches with blades, far to near."""

    rows: Rows
    """Rows of the patch table, shape (m,)."""

    slots: Rows
    """Slots of the pool, shape (m,)."""

    places: Rows
    """Place of each among all patches with blades, shape (m,)."""

    fade: Floats
    """How much of each shows, in [0, 1], shape (m,)."""

    slide: Floats
    """How far the joints of each one's blades have slid together to those of the next ring, shape (m,)."""

    @classmethod
    def whole(cls, rows: Rows, slots: Rows, places: Rows | None = None) -> "Standing":
        """Return patches whose blades show wholly; without `places` they are all patches with blades."""
        where = np.arange(len(rows)) if places is None else places
        return cls(rows, slots, where, np.ones(len(rows), np.float32), np.zeros(len(rows), np.float32))


@dataclass(frozen=True, slots=True, eq=False)
class BladesShown:
    """All patches with blades in a frame."""

    standing: Standing
    """Each once."""

    rings: list[Standing]
    """By ring, those whose blades stand in their own places."""

    morphing: Standing
    """Those whose blades are on their way to their painted places, or back."""


def together(rings: list[Standing], /) -> Standing:
    """Return the patches of several rings as one."""
    fields = ("rows", "slots", "places", "fade", "slide")
    return Standing(*(np.concatenate([getattr(ring, name) for ring in rings]) for name in fields))


def show_blades(outlook: Outlook, cover: Floats, /, *, level: int, side: int, rings: int) -> BladesShown:
    """Return the patches with blades that a viewer is shown, where `cover` (rows,) says how much they cover.

    `level` is the number of the representation, `side` that of patches along a side of its pool.
    """
    patches = outlook.patches
    assert outlook.appearance is not None
    near = patches.far_to_near((patches.shown & (cover > 0.0)).nonzero()[0])
    slots = window_rows(patches.cell.take(near, axis=0), side=side)
    moving = outlook.appearance.morph[near] > 0.0
    still, changing = (~moving).nonzero()[0], moving.nonzero()[0]
    ring, slide = _rings(patches, near[still], level)
    chosen = [(ring == number).nonzero()[0] for number in range(rings)]
    places = [still[each] for each in chosen]
    return BladesShown(
        standing=Standing.whole(near, slots),
        rings=[
            Standing(near[place], slots[place], place, cover[near[place]], slide[each])
            for each, place in zip(chosen, places, strict=True)
        ],
        morphing=Standing.whole(near[changing], slots[changing], changing),
    )


def _rings(patches: PatchTable, rows: Rows, level: int) -> tuple[NDArray[np.int8], Floats]:
    """Return the ring that each patch's blades are drawn in, and how far they have become those of the next."""
    now, before = patches.sublevel[level, rows], patches.sublevel_before[level, rows]
    progress = patches.sublevel_progress[level, rows]
    slide = np.where(now > before, progress, np.where(now < before, np.float32(1.0) - progress, np.float32(0.0)))
    over = progress >= 1.0
    return np.where(over, now, np.minimum(now, before)), np.where(over, np.float32(0.0), slide)
