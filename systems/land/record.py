"""What every program knows of the land: its terrain, and its kinds of grass."""

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ..frame.block import GROUPS
from ..grow.record import GIVES
from ..grow.section import SECTIONS
from ..light.materials import bloom, leaves_of, let_through, pigment, understorey, undertone
from ..space.canopy import canopy_height
from ..space.grown import Grown

OF_KINDS = ("crown", "leaf", "lying", "understorey", "undertone", "root", "tip", "through", "give")
"""The fields of the frame's record that have a figure for each kind."""


def write_land(record: NDArray[np.void], grown: Grown, /) -> None:
    """Write into the frame's record (1,) what the ground is, and what its kinds of grass are."""
    row, patch, growths = record[0], grown.ground.patch, grown.growths
    terrain, postures = grown.ground.terrain, growths[0].postures.shape
    row["soil"][3], row["zenith"][3] = patch, grown.tallest
    row["terrain"] = (*terrain.origin, terrain.cell, postures.shape[2] - 1)
    row["field"] = (*terrain.size, postures.shape[1], postures.shape[0])
    for name in OF_KINDS:
        row[name] = 0.0
    crown, leaf, lying = (row[name].reshape(-1) for name in ("crown", "leaf", "lying"))
    low, tipped = (row[name].reshape(-1) for name in ("understorey", "undertone"))
    give = row["give"].reshape(GROUPS, GIVES, 4)
    for index, (kind, growth) in enumerate(zip(grown.scene.grass.values(), growths, strict=True)):
        _write_kind(row, index, kind)
        leaves = leaves_of(kind, growth, patch)
        crown[index], leaf[index] = canopy_height(growth), leaves.side
        lying[index] = leaves.above / leaves.side
        low[index] = understorey(kind, crown[index])
        row["through"][index, 3] = bloom(kind, growth)
        tipped[index] = undertone(kind, row["through"][index, 3])
        give[index // 4, :, index % 4] = growth.postures.give


def _write_kind(row: np.void, index: int, kind: GrassKind) -> None:
    row["root"][index] = (*pigment(kind.root), kind.gloss)
    row["tip"][index] = (*pigment(kind.tip), kind.taper)
    row["through"][index, :3] = let_through(kind)
    section = SECTIONS[kind.profile]
    row["grain_s"][index, 3] = -1.0 if section.is_round else 1.0 - section.waist
