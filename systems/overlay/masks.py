"""Masks of winds on the ground, with their soft edges (paper, figure 7)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...components.arrays import Floats
from ...components.wind import Extent
from ...engine.terrain.record import Terrain
from ..wind.blow import Blowing
from ..wind.quarantine import Quarantine, QuarantinedError
from .contour import contour, sampled
from .marks import Marks, filled, on_ground, stroked, together
from .paint import DARK, Color, wind_color

EDGE_WEIGHT, FULL_WEIGHT = 0.004, 0.98
"""Weights of a mask at its outer outline and at its core's."""

FILL = 0.30
"""Opacity of a mask's tint at full weight."""


@dataclass(frozen=True, slots=True, eq=False)
class Masked:
    """One wind's mask on the ground at one instant; positions are the world's (x, z) [m]."""

    kind: str
    """Kind of the wind."""

    color: Color
    """Display colour."""

    strength: float
    """Strength of the wind as it sets in, in (0, 1]."""

    everywhere: bool
    """Whether the mask has no edge; then it is not drawn."""

    corners: Floats
    """Triangles that cover the mask, shape (n, 3, 2)."""

    weight: Floats
    """Weights at the triangles' corners, shape (n, 3)."""

    edge: Floats
    """Segments of the outline, shape (m, 2, 2)."""

    core: Floats
    """Segments of the outline of the part with full weight, shape (k, 2, 2)."""


def masked(
    winds: Sequence[Blowing], quarantine: Quarantine, /, *, time: float, around: tuple[float, float], far: float
) -> list[Masked]:
    """Return the masks of winds within `far` [m] of a place (x, z), the weakest claim first."""
    masks = []
    for wind in reversed(winds):
        try:
            mask = _masked(wind, quarantine, time, np.array([around], np.float32), far)
        except QuarantinedError:
            continue
        if mask is not None:
            masks.append(mask)
    return masks


def _masked(wind: Blowing, quarantine: Quarantine, time: float, around: Floats, far: float) -> Masked | None:
    """Return one wind's mask, None if it lies farther away; raise QuarantinedError where the wind fails."""
    pose, none = wind.pose, np.zeros((0, 3, 2), np.float32)
    make = partial(Masked, wind.primitive.kind, wind_color(wind.primitive), wind.strength)
    if wind.extent is None:
        return make(everywhere=True, corners=none, weight=none[..., 0], edge=none, core=none)

    def ask(place: Floats) -> Floats:
        mask = partial(wind.primitive.mask, place, time=time)
        return quarantine.ask_for(wind.source, "mask", mask, shape=(len(place),))

    x, z = pose.inside(around)[0].tolist()
    grid = sampled(ask, wind.extent, Extent(x - far, x + far, z - far, z + far))
    if grid is None:
        return None

    def placed(local: Floats) -> Floats:
        world = pose.outside(local.reshape(-1, 2)) + np.array([pose.x, pose.z], np.float32)
        return world.reshape(local.shape).astype(np.float32)

    outer, inner = contour(grid, EDGE_WEIGHT), contour(grid, FULL_WEIGHT)
    return make(
        everywhere=False,
        corners=placed(outer.corners), weight=outer.weight, edge=placed(outer.edge), core=placed(inner.edge),
    )  # fmt: skip


def mask_marks(masks: Sequence[Masked], terrain: Terrain, /) -> Marks:
    """Return marks of masks on the ground: tinted by weight, with an outline and a thin one around full weight."""
    return together(*(_marks(mask, terrain) for mask in masks if not mask.everywhere))


def _marks(mask: Masked, terrain: Terrain) -> Marks:
    """Return the marks of one mask."""
    color = np.zeros((*mask.weight.shape, 4), np.float32)
    color[..., :3], color[..., 3] = mask.color, FILL * mask.strength * mask.weight
    edge, core = on_ground(terrain, mask.edge), on_ground(terrain, mask.core)
    return together(
        filled(on_ground(terrain, mask.corners), color),
        stroked(core[:, 0], core[:, 1], (*mask.color, 0.55 * mask.strength), width=1.3),
        stroked(edge[:, 0], edge[:, 1], (*DARK, 0.45 * mask.strength), width=5.0),
        stroked(edge[:, 0], edge[:, 1], (*mask.color, 0.95 * mask.strength), width=2.6),
    )
