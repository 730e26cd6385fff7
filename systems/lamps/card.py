"""Lamps on the graphics card: the texture that `lib/lamps.glsl` reads."""

from collections.abc import Callable, Sequence
from math import cos, pi, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.lamp import Lamp
from ...components.pose import Pose
from ..around.outlook import Outlook
from ..frame.feature import Part
from ..light.color import linear, luminance
from ..light.daylight import LEAF
from ..light.sky import SUN
from ..space.frustum import beyond
from .listed import ROOM, SIDE, Listed, listed

MOST = 256
"""Lamps that shine in a frame at most: a list has a byte for each."""

ROW = MOST
"""Texels in a row of the texture."""

CELLS_FROM = 3
"""Its first row of cells; before it, each lamp has a column of three texels."""

LISTS_FROM = CELLS_FROM + SIDE * SIDE // (4 * ROW)
"""Its first row of lists."""

ROWS = LISTS_FROM + ROOM // (16 * ROW)

GLSL = {"LAMPS_ROW": ROW, "CELLS_FROM": CELLS_FROM, "LISTS_FROM": LISTS_FROM}

SUNLIT = 133_300.0
"""Illuminance that the sun gives before the air (Darula, Kittler and Gueymard, 2005) [lx]."""

RADIANCE = SUN / pi * LEAF / SUNLIT
"""Radiance of a white leaf that faces all ways, for each lux [1/lx]."""

FADES = 2.0 / 3.0
"""The part of a cone's half angle from which on its light fades towards the edge."""

Lit = tuple[Lamp, Pose]
"""A lamp, and where it is; its pose has a height."""


def stand(lamps: Sequence[Lit], /) -> Floats:
    """Return what shaders are told of lamps, shape (n, 3, 4).

    That is place [m] and 1 / range² [1/m²]; radiance of a white leaf a metre off, and the slope of the cone's edge;
    where it points to, and how much of its light there is square to that.
    """
    told = np.zeros((len(lamps), 3, 4), np.float32)
    for row, (lamp, pose) in zip(told, lamps, strict=True):
        colour = linear(lamp.colour)
        inner, outer = (0.0, 0.0) if lamp.cone is None else (cos(FADES * lamp.cone), cos(lamp.cone))
        slope = 0.0 if lamp.cone is None else 1.0 / max(inner - outer, 1e-6)
        flat = cos(lamp.pitch)
        row[0] = pose.x, pose.y, pose.z, lamp.range**-2
        row[1, :3] = colour / max(float(luminance(colour)), 1e-3) * (lamp.candela * RADIANCE)
        row[1, 3] = slope
        row[2] = flat * sin(pose.yaw), sin(lamp.pitch), -flat * cos(pose.yaw), 1.0 - slope * inner
    return told


def seen(told: Floats, sides: Doubles, eye: tuple[float, float, float], /) -> Floats:
    """Return what is told (n, 3, 4) of those lamps that shine on anything in the picture, at most `MOST`.

    `sides` are the planes of the picture. Of more, those count that are brightest at the eye, in the order they had.
    """
    reach = told[:, 0, 3] ** -0.5
    found = told[beyond(told[:, 0, :3].astype(np.float64), sides) <= reach]
    if len(found) > MOST:
        away = np.square(found[:, 0, :3] - np.array(eye, np.float32)).sum(axis=1)
        dim = np.argsort(-found[:, 1, :3].sum(axis=1) / np.maximum(away, 1.0), kind="stable")
        found = found[np.sort(dim[:MOST])]
    return found


def texels(told: Floats, lists: Listed, /) -> NDArray[np.uint32]:
    """Return the texture's rows that tell of lamps (n, 3, 4) and of the cells that they shine on, (rows, ROW, 4)."""
    used = LISTS_FROM + -(-len(lists.lamps) // (16 * ROW))
    rows = np.zeros((used, ROW, 4), np.uint32)
    rows[:CELLS_FROM, : len(told)] = told.transpose(1, 0, 2).view(np.uint32)
    rows[CELLS_FROM:LISTS_FROM].reshape(-1)[: len(lists.first)] = lists.first << 9 | lists.count
    rows[LISTS_FROM:].reshape(-1).view(np.uint8)[: len(lists.lamps)] = lists.lamps
    return rows


class LampPart(Part):
    """What one GL context holds of the lamps that shine."""

    def __init__(self, ctx: moderngl.Context, unit: int, shining: Callable[[], Sequence[Lit]]) -> None:
        self._unit, self._shining = unit, shining
        self.texture = ctx.texture((ROW, ROWS), 4, dtype="u4")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._sent: bytes | None = None

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that there are some."""
        record["lamps_grid"] = 0.0, 0.0, 1.0, 1.0

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Send those that shine on what a viewer sees, as bright as the picture is exposed."""
        record["lamps_grid"] = 0.0
        shining = self._shining()
        if not shining:
            return
        told = seen(stand(shining), outlook.viewer.sides, outlook.viewer.eye)
        if not len(told):
            return
        told[:, 1, :3] *= record["lamplight"][0]
        lists = listed(told[:, 0, ::2], told[:, 0, 3] ** -0.5)
        record["lamps_grid"] = *lists.corner, 1.0 / lists.cell, lists.side
        rows = texels(told, lists)
        if self._sent != rows.tobytes():
            self._sent = rows.tobytes()
            self.texture.write(rows, viewport=(0, 0, ROW, len(rows)))

    def use(self) -> None:
        """Bind it."""
        self.texture.use(self._unit)

    def release(self) -> None:
        """Give the texture back."""
        self.texture.release()
