"""The land in the frame block: terrain, and kinds of grass."""

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
"""Fields of the frame block's record that hold one number per kind."""

OF_KIND = "root", "gloss", "tip", "taper", "through", "bloom", "narrowed", "head", "eyed", "eye_pigment"
"""Fields of the record's `kinds` that this module writes."""


@dataclass(frozen=True, slots=True, eq=False)
class Figures:
    """Figures of a kind's growth that take a while to compute."""

    crown: float
    """Height of the canopy [m]."""

    leaves: Leaves
    bloom: float
    head: Headed | None
    """Averages over its heads; None for a kind without heads."""

    give: Floats
    """Posture index by length of a message, as a table."""

    def toward(self, other: Self, fraction: float, /) -> Self:
        """Return the interpolation of these figures and others."""
        before, after = self.leaves, other.leaves
        return type(self)(
            self.crown + fraction * (other.crown - self.crown),
            Leaves(
                before.side + fraction * (after.side - before.side),
                before.above + fraction * (after.above - before.above),
            ),
            self.bloom + fraction * (other.bloom - self.bloom),
            self.head or other.head,
            self.give + np.float32(fraction) * (other.give - self.give),
        )


@while_it_lives
def _cached_figures(_growth: Growth, /) -> dict[tuple[object, ...], Figures]:
    """Return the cache of a growth's figures, which is kept with it, keyed by taper, profile and patch side."""
    return {}


def figures_of(kind: GrassKind, growth: Growth, patch: float, /) -> Figures:
    """Return the figures of a kind's growth; `patch` is a patch's side [m]."""
    cached, key = _cached_figures(growth), (kind.taper, kind.profile, patch)
    if key not in cached:
        leaves, blooms = leaves_of(kind, growth, patch), bloom(kind, growth)
        cached[key] = Figures(canopy_height(growth), leaves, blooms, headed(growth), growth.postures.give)
    return cached[key]


def figures_on(grown: Grown, /) -> list[Figures]:
    """Return the figures of each kind; those of a kind in transition are interpolated."""
    found, patch = list[Figures](), grown.ground.patch
    for number, (kind, growth) in enumerate(zip(grown.scene.grass.values(), grown.growths, strict=True)):
        figures = figures_of(kind, growth, patch)
        if number in grown.coming and grown.came:
            figures = figures.toward(figures_of(kind, grown.coming[number], patch), grown.came[number])
        found.append(figures)
    return found


def write_land(record: NDArray[np.void], grown: Grown, /) -> None:
    """Write the ground and its kinds of grass into the frame block's record (1,)."""
    row, patch, growths = record[0], grown.ground.patch, grown.growths
    terrain, postures = grown.ground.terrain, growths[0].postures.shape
    row["patch_side"], row["patches_per_metre"], row["tallest_grass"] = patch, 1.0 / patch, grown.tallest
    row["terrain_origin"], row["terrain_size"], row["terrain_cell"] = terrain.origin, terrain.size, terrain.cell
    row["posture_variants"], row["posture_rows"] = postures.shape[:2]
    row["posture_links"] = postures.shape[2] - 1
    for name in BY_KIND:
        row[name] = 0.0
    for name in OF_KIND:
        row["kinds"][name] = 0.0
    crown, leaf, lying = (row[name].reshape(-1) for name in ("crown", "leaf", "lying"))
    understorey_cover, tipped = (row[name].reshape(-1) for name in ("understorey", "undertone"))
    steepest, thins, bears = (row[name].reshape(-1) for name in ("steepest", "thins", "bears"))
    if grown.ground.density.slopes:
        steepest[: len(growths)], thins[: len(growths)] = bareness(grown.ground.density.slopes).T
    row["came"].reshape(-1)[: len(grown.came)] = grown.came
    give = row["give"].reshape(GROUPS, GIVES, 4)
    for index, (kind, figures) in enumerate(zip(grown.scene.grass.values(), figures_on(grown), strict=True)):
        _write_kind(row["kinds"][index], kind, figures)
        row["kinds"][index]["eyed"] = any_eyes([growths[index]]) + 2 * any_eyes(
            [grown.coming[index]] if index in grown.coming else []
        )
        crown[index], leaf[index] = figures.crown, figures.leaves.side
        lying[index] = figures.leaves.above / figures.leaves.side
        bears[index] = figures.head is not None
        understorey_cover[index] = understorey(kind, figures.crown)
        tipped[index] = undertone(kind, figures.bloom)
        give[index // 4, :, index % 4] = figures.give


def _write_kind(row: np.void, kind: GrassKind, figures: Figures) -> None:
    """Write a kind's row of the frame block."""
    row["root"], row["gloss"] = pigment(kind.root), kind.gloss
    row["tip"], row["taper"] = pigment(kind.tip), kind.taper
    row["through"], row["bloom"] = transmission(kind), figures.bloom
    section = SECTIONS[kind.profile]
    row["head"] = figures.head or 0.0
    row["eye_pigment"] = pigment(kind.tip if kind.head is None else kind.head.eye or kind.tip)
    row["narrowed"] = -1.0 if section.is_round else 1.0 - section.waist
