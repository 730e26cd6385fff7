"""Masks on the ground: where each wind acts, how softly it sets in (paper, figure 7)."""

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

BEGINS, WHOLE = 0.004, 0.98
"""Weights at which a mask is taken to begin, and to be there wholly."""

FILL = 0.30
"""Opacity of the ground where a mask is there wholly."""


@dataclass(frozen=True, slots=True, eq=False)
class Masked:
    """One wind's mask on the ground at one instant; all places are the world's (x, z) [m]."""

    kind: str
    color: Color
    """What it is shown in."""

    strength: float
    """How far the wind has set in, in (0, 1]."""

    everywhere: bool
    """Whether it has no edge; then nothing is drawn of it."""

    corners: Floats
    """Triangles of the ground on which it acts, shape (n, 3, 2)."""

    weight: Floats
    """At their corners, shape (n, 3)."""

    edge: Floats
    """Its outline in pieces, shape (m, 2, 2)."""

    core: Floats
    """The outline of where it is there wholly, shape (k, 2, 2)."""


def masked(
    winds: Sequence[Blowing], quarantine: Quarantine, /, *, time: float, around: tuple[float, float], far: float
) -> list[Masked]:
    """Return the masks of winds, the weakest claim first, as far as they lie within `far` [m] of a place (x, z)."""
    found = []
    for wind in reversed(winds):
        try:
            one = _masked(wind, quarantine, time, np.array([around], np.float32), far)
        except QuarantinedError:
            continue
        if one is not None:
            found.append(one)
    return found


def _masked(wind: Blowing, quarantine: Quarantine, time: float, around: Floats, far: float) -> Masked | None:
    pose, none = wind.pose, np.zeros((0, 3, 2), np.float32)
    made = partial(Masked, wind.primitive.kind, wind_color(wind.primitive), wind.strength)
    if wind.extent is None:
        return made(everywhere=True, corners=none, weight=none[..., 0], edge=none, core=none)

    def ask(place: Floats) -> Floats:
        mask = partial(wind.primitive.mask, place, time=time)
        return quarantine.ask_for(wind.source, "mask", mask, shape=(len(place),))

    x, z = pose.inside(around)[0].tolist()
    grid = sampled(ask, wind.extent, Extent(x - far, x + far, z - far, z + far))
    if grid is None:
        return None

    def placed(own: Floats) -> Floats:
        world = pose.outside(own.reshape(-1, 2)) + np.array([pose.x, pose.z], np.float32)
        return world.reshape(own.shape).astype(np.float32)

    outer, inner = contour(grid, BEGINS), contour(grid, WHOLE)
    return made(
        everywhere=False,
        corners=placed(outer.corners), weight=outer.weight, edge=placed(outer.edge), core=placed(inner.edge),
    )  # fmt: skip


def mask_marks(masks: Sequence[Masked], terrain: Terrain, /) -> Marks:
    """Return masks on the ground: tinted as they weigh, outlined where they begin and where they are whole."""
    return together(*(_marks(mask, terrain) for mask in masks if not mask.everywhere))


def _marks(mask: Masked, terrain: Terrain) -> Marks:
    color = np.zeros((*mask.weight.shape, 4), np.float32)
    color[..., :3], color[..., 3] = mask.color, FILL * mask.strength * mask.weight
    edge, core = on_ground(terrain, mask.edge), on_ground(terrain, mask.core)
    return together(
        filled(on_ground(terrain, mask.corners), color),
        stroked(core[:, 0], core[:, 1], (*mask.color, 0.55 * mask.strength), width=1.3),
        stroked(edge[:, 0], edge[:, 1], (*DARK, 0.45 * mask.strength), width=5.0),
        stroked(edge[:, 0], edge[:, 1], (*mask.color, 0.95 * mask.strength), width=2.6),
    )
