"""What every program knows of the land: its terrain, and its kinds of grass."""

import numpy as np
from numpy.typing import NDArray

from ...engine.declared.grass import GrassKind
from ...engine.declared.scene import Scene
from ...engine.terrain.record import Terrain
from ..frame.block import FRAME, GROUPS
from ..grow.record import GIVES, Growth
from ..grow.section import SECTIONS
from ..light.daylight import daylight
from ..light.materials import bloom, leaves_of, let_through, pigment, understorey, undertone
from ..light.shine import shine
from ..space.canopy import canopy_height


def frame_record(
    scene: Scene, growths: list[Growth], terrain: Terrain, patch: float, /, *, raw: bool = False
) -> NDArray[np.void]:
    """Return the block with all that holds for the whole scene, shape (1,); `aim` and `cast` fill in the rest.

    With `raw`, linear radiance is written in place of display colours.
    """
    record = np.zeros(1, FRAME)
    row = record[0]
    row["sun"][3], row["soil"][3] = raw, patch
    shine(record, scene.light, daylight(scene.light), list(scene.grass.values()))
    postures = growths[0].postures.shape
    row["terrain"] = (*terrain.origin, terrain.cell, postures.shape[2] - 1)
    row["field"] = (*terrain.size, postures.shape[1], postures.shape[0])
    crown, leaf, lying = (row[name].reshape(-1) for name in ("crown", "leaf", "lying"))
    low, tipped = (row[name].reshape(-1) for name in ("understorey", "undertone"))
    give = row["give"].reshape(GROUPS, GIVES, 4)
    for index, (kind, growth) in enumerate(zip(scene.grass.values(), growths, strict=True)):
        _write_kind(row, index, kind)
        leaves = leaves_of(kind, growth, patch)
        crown[index], leaf[index] = canopy_height(growth), leaves.side
        lying[index] = leaves.above / leaves.side
        low[index] = understorey(kind, crown[index])
        row["through"][index, 3] = bloom(kind, growth)
        tipped[index] = undertone(kind, row["through"][index, 3])
        give[index // 4, :, index % 4] = growth.postures.give
    return record


def _write_kind(row: np.void, index: int, kind: GrassKind) -> None:
    row["root"][index] = (*pigment(kind.root), kind.gloss)
    row["tip"][index] = (*pigment(kind.tip), kind.taper)
    row["through"][index, :3] = let_through(kind)
    section = SECTIONS[kind.profile]
    row["grain_s"][index, 3] = -1.0 if section.is_round else 1.0 - section.waist
