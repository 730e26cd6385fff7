"""The patches with blades in a frame: those of each ring, and those whose blades are morphing into strips."""

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
    """Row of each in the patch table, shape (m,)."""

    slots: Rows
    """Slot of each in the pool, shape (m,)."""

    places: Rows
    """Index of each among all patches with blades, shape (m,)."""

    cover: Floats
    """Cover of each patch's blades, in [0, 1], shape (m,)."""

    slide: Floats
    """Fraction of the way that the joints of each patch's blades have slid to those of the next ring, shape (m,)."""

    @classmethod
    def whole(cls, rows: Rows, slots: Rows, places: Rows | None = None) -> "Standing":
        """Return patches whose blades have full cover; without `places` these are all patches with blades."""
        index = np.arange(len(rows)) if places is None else places
        return cls(rows, slots, index, np.ones(len(rows), np.float32), np.zeros(len(rows), np.float32))


@dataclass(frozen=True, slots=True, eq=False)
class BladesShown:
    """All patches with blades in a frame."""

    standing: Standing
    """All of them, each once."""

    rings: list[Standing]
    """The patches of each ring whose blades stand at their roots."""

    morphing: Standing
    """The patches whose blades are morphing: on their way to their painted places, or back."""


def together(rings: list[Standing], /) -> Standing:
    """Return the patches of several rings in one record."""
    fields = ("rows", "slots", "places", "cover", "slide")
    return Standing(*(np.concatenate([getattr(ring, name) for ring in rings]) for name in fields))


def show_blades(outlook: Outlook, cover: Floats, /, *, level: int, side: int, rings: int) -> BladesShown:
    """Return the patches with blades in this frame, for the blades' `cover` on all patches (rows,).

    `level` is the number of the representation, `side` the number of patches along a side of its pool, `rings` the
    number of rings.
    """
    patches = outlook.patches
    near = patches.far_to_near((patches.shown & (cover > 0.0)).nonzero()[0])
    slots = window_rows(patches.cell.take(near, axis=0), side=side)
    morphs = outlook.appearance.morph[near] > 0.0
    still, morphing = (~morphs).nonzero()[0], morphs.nonzero()[0]
    ring, slide = _rings(patches, near[still], level)
    members = [(ring == number).nonzero()[0] for number in range(rings)]
    places = [still[member] for member in members]
    return BladesShown(
        standing=Standing.whole(near, slots),
        rings=[
            Standing(near[place], slots[place], place, cover[near[place]], slide[member])
            for member, place in zip(members, places, strict=True)
        ],
        morphing=Standing.whole(near[morphing], slots[morphing], morphing),
    )


def _rings(patches: PatchTable, rows: Rows, level: int) -> tuple[NDArray[np.int8], Floats]:
    """Return the ring that each patch's blades are drawn in, and `Standing.slide` towards the next, shape (n,) each."""
    now, before = patches.sublevel[level, rows], patches.sublevel_before[level, rows]
    progress = patches.sublevel_progress[level, rows]
    slide = np.where(now > before, progress, np.where(now < before, np.float32(1.0) - progress, np.float32(0.0)))
    done = progress >= 1.0
    return np.where(done, now, np.minimum(now, before)), np.where(done, np.float32(0.0), slide)
