"""What every program knows of the land: its terrain, and its kinds of grass."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.declared.grass import GrassKind
from ...engine.memo import while_it_lives
from ...engine.terrain.sample import bareness
from ..frame.block import GROUPS
from ..grow.headed import Headed, headed
from ..grow.organs import any_eyes
from ..grow.record import GIVES, Growth
from ..grow.section import SECTIONS
from ..light.materials import Leaves, bloom, leaves_of, pigment, transmission, understorey, undertone
from ..space.canopy import canopy_height
from ..space.grown import Grown

BY_KIND = "came", "crown", "leaf", "lying", "understorey", "undertone", "steepest", "thins", "bears", "give"
"""The fields of the frame's record that have a figure for each kind."""

OF_KIND = "root", "gloss", "tip", "taper", "through", "bloom", "narrowed", "head", "eyed", "eye_pigment"
"""What is written here of each of its kinds."""


@dataclass(frozen=True, slots=True, eq=False)
class Figures:
    """What takes a while to find out about what was grown of a kind."""

    crown: float
    """Height of the canopy [m]."""

    leaves: Leaves
    bloom: float
    head: Headed | None
    """What its heads are like, if it bears any."""

    give: Floats
    """How far it gives way, by length of a message."""

    def toward(self, other: Self, part: float, /) -> Self:
        """Return figures at a part of the way to another's."""
        one, after = self.leaves, other.leaves
        return type(self)(
            self.crown + part * (other.crown - self.crown),
            Leaves(one.side + part * (after.side - one.side), one.above + part * (after.above - one.above)),
            self.bloom + part * (other.bloom - self.bloom),
            self.head or other.head,
            self.give + np.float32(part) * (other.give - self.give),
        )


@while_it_lives
def _known(growth: Growth, /) -> dict[tuple[object, ...], Figures]:
    """Return what has been found out about what was grown of a kind, by what the kind says of how it is drawn."""
    del growth
    return {}


def figures_of(kind: GrassKind, growth: Growth, patch: float, /) -> Figures:
    """Return what there is to be told of what was grown of a kind; `patch` is a patch's side [m]."""
    known, key = _known(growth), (kind.taper, kind.profile, patch)
    if key not in known:
        leaves, blooms = leaves_of(kind, growth, patch), bloom(kind, growth)
        known[key] = Figures(canopy_height(growth), leaves, blooms, headed(growth), growth.postures.give)
    return known[key]


def figures_on(grown: Grown, /) -> list[Figures]:
    """Return the figures of each kind, as far as it has become what it is to be."""
    found, patch = list[Figures](), grown.ground.patch
    for number, (kind, growth) in enumerate(zip(grown.scene.grass.values(), grown.growths, strict=True)):
        own = figures_of(kind, growth, patch)
        if number in grown.coming and grown.came:
            own = own.toward(figures_of(kind, grown.coming[number], patch), grown.came[number])
        found.append(own)
    return found


def write_land(record: NDArray[np.void], grown: Grown, /) -> None:
    """Write into the frame's record (1,) what the ground is, and what its kinds of grass are."""
    row, patch, growths = record[0], grown.ground.patch, grown.growths
    terrain, postures = grown.ground.terrain, growths[0].postures.shape
    row["patch_side"], row["patches_a_metre"], row["tallest_grass"] = patch, 1.0 / patch, grown.tallest
    row["terrain_origin"], row["terrain_size"], row["terrain_cell"] = terrain.origin, terrain.size, terrain.cell
    row["posture_variants"], row["posture_rows"] = postures.shape[:2]
    row["posture_links"] = postures.shape[2] - 1
    for name in BY_KIND:
        row[name] = 0.0
    for name in OF_KIND:
        row["kinds"][name] = 0.0
    crown, leaf, lying = (row[name].reshape(-1) for name in ("crown", "leaf", "lying"))
    low, tipped = (row[name].reshape(-1) for name in ("understorey", "undertone"))
    steepest, thins, bears = (row[name].reshape(-1) for name in ("steepest", "thins", "bears"))
    if grown.ground.density.slopes:
        steepest[: len(growths)], thins[: len(growths)] = bareness(grown.ground.density.slopes).T
    row["came"].reshape(-1)[: len(grown.came)] = grown.came
    give = row["give"].reshape(GROUPS, GIVES, 4)
    for index, (kind, own) in enumerate(zip(grown.scene.grass.values(), figures_on(grown), strict=True)):
        _write_kind(row["kinds"][index], kind, own)
        row["kinds"][index]["eyed"] = any_eyes([growths[index]]) + 2 * any_eyes(
            [grown.coming[index]] if index in grown.coming else []
        )
        crown[index], leaf[index] = own.crown, own.leaves.side
        lying[index] = own.leaves.above / own.leaves.side
        bears[index] = own.head is not None
        low[index] = understorey(kind, own.crown)
        tipped[index] = undertone(kind, own.bloom)
        give[index // 4, :, index % 4] = own.give


def _write_kind(row: np.void, kind: GrassKind, own: Figures) -> None:
    row["root"], row["gloss"] = pigment(kind.root), kind.gloss
    row["tip"], row["taper"] = pigment(kind.tip), kind.taper
    row["through"], row["bloom"] = transmission(kind), own.bloom
    section = SECTIONS[kind.profile]
    row["head"] = own.head or 0.0
    row["eye_pigment"] = pigment(kind.tip if kind.head is None else kind.head.eye or kind.tip)
    row["narrowed"] = -1.0 if section.is_round else 1.0 - section.waist
