"""Lamps and shades on the graphics card: the texture that `lib/listed.glsl` reads."""

from collections.abc import Callable, Sequence
from math import cos, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Rows
from ...components.lamp import Lamp
from ...components.pose import Pose
from ...components.shade import Shade
from ..around.outlook import Outlook
from ..frame.feature import TexturePart
from ..light.color import linear, luminance
from ..light.daylight import LEAF, LUX
from ..shadows.shades import fallen, told_of
from ..space.frustum import outside_planes
from .listed import ROOM, SIDE, Listed, listed

MOST = 256
"""Lamps that shine in a frame at most, and shades that count: a list has a byte for each."""

ROW = MOST
"""Texels in a row of the texture."""

CELLS_FROM = 3
"""Its first row of cells; before it, each lamp has a column of three texels."""

LISTS_FROM = CELLS_FROM + SIDE * SIDE // (4 * ROW)
"""Its first row of lists."""

ROWS = LISTS_FROM + ROOM // (16 * ROW)
"""Its rows for lamps; shades have as many below."""

COUNT_BITS = 9
"""Bits of a cell's word that count its list; those above tell where it begins."""

GLSL = {
    "COUNT_BITS": COUNT_BITS,
    "LISTED_ROW": ROW,
    "CELLS_FROM": CELLS_FROM,
    "LISTS_FROM": LISTS_FROM,
    "SHADES_FROM": ROWS,
}

AROUND = 1000.0
"""How far from the eye shadows of shades count, along x and z [m]."""

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
        row[1, :3] = colour / max(float(luminance(colour)), 1e-3) * (lamp.candela * LUX * LEAF)
        row[1, 3] = slope
        row[2] = flat * sin(pose.yaw), sin(lamp.pitch), -flat * cos(pose.yaw), 1.0 - slope * inner
    return told


def seen(told: Floats, sides: Doubles, eye: tuple[float, float, float], /) -> Floats:
    """Return what is told (n, 3, 4) of those lamps that shine on anything in the picture, at most `MOST`.

    `sides` are the planes of the picture. Of more, those count that are brightest at the eye, in the order they had.
    """
    reach = told[:, 0, 3] ** -0.5
    found = told[outside_planes(told[:, 0, :3].astype(np.float64), sides) <= reach]
    return found[_first(-found[:, 1, :3].sum(axis=1) / np.maximum(_away(found, eye), 1.0))]


def _away(told: Floats, eye: tuple[float, float, float]) -> Floats:
    """Return squared distances from the eye (n,) [m²]."""
    return np.asarray(np.square(told[:, 0, :3] - np.array(eye, np.float32)).sum(axis=1))


def _first(ranks: Floats) -> Rows:
    """Return where the lowest `MOST` of these are, in the order they have."""
    return np.sort(np.argsort(ranks, kind="stable")[:MOST])


def shading(
    told: Floats, sun: Floats, lowest: float, sides: Doubles, eye: tuple[float, float, float], /
) -> tuple[Floats, Listed] | None:
    """Return what is told (n, 3, 4) of those shades whose shadows are in the picture, and their lists; None for none.

    The ground is nowhere lower than `lowest` [m]. Of more than `MOST`, the nearest to the eye count.
    """
    ends, reach = fallen(told, sun, lowest)
    past = (ends @ sides[:, :3].T + sides[:, 3]).max(axis=1).min(axis=1) < -reach
    middle = np.array(eye)[::2]
    low, high = (np.clip(way(ends[..., ::2], axis=1), middle - AROUND, middle + AROUND) for way in (np.min, np.max))
    is_far = (ends[..., ::2].min(axis=1) > high + reach[:, None]).any(axis=1)
    is_far |= (ends[..., ::2].max(axis=1) < low - reach[:, None]).any(axis=1)
    here = np.flatnonzero(~(past | is_far))
    if not len(here):
        return None
    here = here[_first(_away(told[here], eye))]
    return told[here], listed(low[here], high[here], reach[here])


def texels(told: Floats, lists: Listed, /) -> NDArray[np.uint32]:
    """Return the texture's rows that tell of things (n, 3, 4) and of the cells that they reach, (rows, ROW, 4)."""
    used = LISTS_FROM + -(-len(lists.things) // (16 * ROW))
    rows = np.zeros((used, ROW, 4), np.uint32)
    rows[:CELLS_FROM, : len(told)] = told.transpose(1, 0, 2).view(np.uint32)
    rows[CELLS_FROM:LISTS_FROM].reshape(-1)[: len(lists.first)] = lists.first << COUNT_BITS | lists.count
    rows[LISTS_FROM:].reshape(-1).view(np.uint8)[: len(lists.things)] = lists.things
    return rows


class LampPart(TexturePart):
    """What one GL context holds of the lamps that shine, and of shades."""

    def __init__(
        self,
        ctx: moderngl.Context,
        unit: int,
        shining: Callable[[], Sequence[Lit]],
        shades: Callable[[], tuple[Sequence[Shade], float]],
    ) -> None:
        super().__init__(unit)
        self._shining, self._shades = shining, shades
        self.texture = ctx.texture((ROW, 2 * ROWS), 4, dtype="u4")
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self._sent = dict[int, bytes]()
        self._told: tuple[Sequence[Shade], Floats] = (), told_of(())

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Pretend that there are lamps: what draws for shades is what draws for shadow maps."""
        record["lamps_grid"], record["beside_sun"] = (0.0, 0.0, 1.0, 1.0), 1.0

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Send those that reach what a viewer sees, lamps as bright as the picture is exposed."""
        record["lamps_grid"] = record["shades_grid"] = 0.0
        self._send_lamps(outlook, record)
        self._send_shades(outlook, record)

    def _send_lamps(self, outlook: Outlook, record: NDArray[np.void]) -> None:
        shining = self._shining()
        if not shining:
            return
        told = seen(stand(shining), outlook.viewer.sides, outlook.viewer.eye)
        if not len(told):
            return
        told[:, 1, :3] *= record["lamplight"][0]
        place = told[:, 0, ::2]
        record["lamps_grid"] = self._write(told, listed(place, place, told[:, 0, 3] ** -0.5), 0)
        record["beside_sun"] = 1.0

    def _send_shades(self, outlook: Outlook, record: NDArray[np.void]) -> None:
        shades, lowest = self._shades()
        if not shades:
            return
        if self._told[0] != shades:
            self._told = shades, told_of(shades)
        found = shading(self._told[1], record["sun"][0], lowest, outlook.viewer.sides, outlook.viewer.eye)
        if found is not None:
            record["shades_grid"] = self._write(*found, ROWS)

    def _write(self, told: Floats, lists: Listed, top: int) -> tuple[float, ...]:
        """Write what is told of things from a row on; return how their cells lie."""
        rows = texels(told, lists)
        if self._sent.get(top) != rows.tobytes():
            self._sent[top] = rows.tobytes()
            self.texture.write(rows, viewport=(0, top, ROW, len(rows)))
        return (*lists.corner, 1.0 / lists.cell, lists.side)
