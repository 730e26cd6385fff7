"""Lamps and shades on the graphics card: the texture that `lib/listed.glsl` reads."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from math import cos, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Rows
from ...components.lamp import Lamp
from ...components.pose import Pose
from ...components.shade import Shade
from ...engine.gl.texture import by_texel
from ..around.outlook import Outlook
from ..frame.feature import TexturePart
from ..light.color import linear, luminance
from ..light.daylight import LEAF, LUX
from ..shadows.shades import shade_texels, shadow_capsules
from ..space.frustum import outside_planes
from .listed import MOST_ENTRIES, SIDE, Grid, grid_of

MOST = 256
"""Largest number of lamps in a frame, and of shades: lists hold their numbers as bytes."""

ROW = MOST
"""Texels in a row of the texture."""

CELLS_FROM = 3
"""First row of cells. Above it, each lamp has a column of three texels."""

LISTS_FROM = CELLS_FROM + SIDE * SIDE // (4 * ROW)
"""First row of lists."""

ROWS = LISTS_FROM + MOST_ENTRIES // (16 * ROW)
"""Number of rows for lamps. As many for shades follow."""

COUNT_BITS = 9
"""Low bits of a cell's word, which hold the length of its list; the bits above hold its start."""

GLSL = {
    "COUNT_BITS": COUNT_BITS,
    "LISTED_ROW": ROW,
    "CELLS_FROM": CELLS_FROM,
    "LISTS_FROM": LISTS_FROM,
    "SHADES_FROM": ROWS,
}

SHADOW_DISTANCE = 1000.0
"""Largest distance from the eye, along x and z, at which shadows of shades are drawn [m]."""

FADE_START = 2.0 / 3.0
"""Fraction of a cone's half angle at which its light begins to fade towards the edge."""

Lit = tuple[Lamp, Pose]
"""A lamp and its pose, which has a height."""


def lamp_texels(lamps: Sequence[Lit], /) -> Floats:
    """Return three texels for each lamp, shape (n, 3, 4).

    They hold position [m] and 1 / range² [1/m²]; radiance of a white leaf at 1 m and the slope of the cone's fade by
    the cosine of the angle to its axis; the axis, and the fade's value at a cosine of 0.
    """
    texels = np.zeros((len(lamps), 3, 4), np.float32)
    for row, (lamp, pose) in zip(texels, lamps, strict=True):
        inner, outer = (0.0, 0.0) if lamp.cone is None else (cos(FADE_START * lamp.cone), cos(lamp.cone))
        slope = 0.0 if lamp.cone is None else 1.0 / max(inner - outer, 1e-6)
        flat = cos(lamp.pitch)
        row[0] = pose.x, pose.y, pose.z, lamp.range**-2
        row[1, :3] = _evened(lamp.colour) * (lamp.candela * LUX * LEAF)
        row[1, 3] = slope
        row[2] = flat * sin(pose.yaw), sin(lamp.pitch), -flat * cos(pose.yaw), 1.0 - slope * inner
    return texels


@lru_cache(maxsize=4 * MOST)
def _evened(colour: str) -> Doubles:
    """Return a colour `#rrggbb` as linear light of luminance 1, shape (3,); many lamps have the same one."""
    light = linear(colour)
    return np.asarray(light / max(float(luminance(light)), 1e-3))


def visible_lamps(texels: Floats, sides: Doubles, eye: tuple[float, float, float], /) -> Floats:
    """Return the texels (n, 3, 4) of the lamps whose range reaches into the view frustum, at most `MOST`, in order.

    `sides` are the planes of the frustum. Of more lamps, those brightest at the eye are kept.
    """
    reach = texels[:, 0, 3] ** -0.5
    reaching = texels[outside_planes(texels[:, 0, :3].astype(np.float64), sides) <= reach]
    return reaching[_lowest_ranks(-reaching[:, 1, :3].sum(axis=1) / np.maximum(_squared_distances(reaching, eye), 1.0))]


def _squared_distances(texels: Floats, eye: tuple[float, float, float]) -> Floats:
    """Return squared distances from the eye (n,) [m²]."""
    return np.asarray(np.square(texels[:, 0, :3] - np.array(eye, np.float32)).sum(axis=1))


def _lowest_ranks(ranks: Floats) -> Rows:
    """Return the indices of the `MOST` lowest ranks, in rising order."""
    return np.sort(np.argsort(ranks, kind="stable")[:MOST])


def visible_shades(
    texels: Floats, sun: Floats, lowest: float, sides: Doubles, eye: tuple[float, float, float], /
) -> tuple[Floats, Grid] | None:
    """Return the texels (n, 3, 4) of the shades whose shadows reach into the frustum, and their cells; None for none.

    `lowest` is the height of the lowest ground [m]. Of more than `MOST` shades, the nearest to the eye are kept.
    """
    ends, reach = shadow_capsules(texels, sun, lowest)
    outside = (ends @ sides[:, :3].T + sides[:, 3]).max(axis=1).min(axis=1) < -reach
    middle = np.array(eye)[::2]
    low, high = (
        np.clip(end(ends[..., ::2], axis=1), middle - SHADOW_DISTANCE, middle + SHADOW_DISTANCE)
        for end in (np.min, np.max)
    )
    is_far = (ends[..., ::2].min(axis=1) > high + reach[:, None]).any(axis=1)
    is_far |= (ends[..., ::2].max(axis=1) < low - reach[:, None]).any(axis=1)
    visible = np.flatnonzero(~(outside | is_far))
    if not len(visible):
        return None
    visible = visible[_lowest_ranks(_squared_distances(texels[visible], eye))]
    return texels[visible], grid_of(low[visible], high[visible], reach[visible])


def texture_rows(texels: Floats, grid: Grid, /) -> NDArray[np.uint32]:
    """Return the texture's rows for lamps or shades (n, 3, 4) and their cells and lists, shape (rows, ROW, 4)."""
    used = LISTS_FROM + -(-len(grid.things) // (16 * ROW))
    rows = np.zeros((used, ROW, 4), np.uint32)
    rows[:CELLS_FROM, : len(texels)] = texels.transpose(1, 0, 2).view(np.uint32)
    rows[CELLS_FROM:LISTS_FROM].reshape(-1)[: len(grid.first)] = grid.first << COUNT_BITS | grid.count
    rows[LISTS_FROM:].reshape(-1).view(np.uint8)[: len(grid.things)] = grid.things
    return rows


class LampPart(TexturePart):
    """Holds the texture of lamps and shades in one GL context."""

    def __init__(
        self,
        ctx: moderngl.Context,
        unit: int,
        shining: Callable[[], Sequence[Lit]],
        shades: Callable[[], tuple[Sequence[Shade], float]],
    ) -> None:
        super().__init__(unit)
        self._shining, self._shades = shining, shades
        self.texture = by_texel(ctx.texture((ROW, 2 * ROWS), 4, dtype="u4"))
        self._uploaded = dict[int, bytes]()
        self._shade_texels: tuple[Sequence[Shade], Floats] = (), shade_texels(())

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Set a grid of lamps; shades use the programs of shadow maps."""
        record["lamps_grid"], record["beside_sun"] = (0.0, 0.0, 1.0, 1.0), 1.0

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Upload the lamps, exposed, and shades that affect a viewer's picture."""
        record["lamps_grid"] = record["shades_grid"] = 0.0
        self._send_lamps(outlook, record)
        self._send_shades(outlook, record)

    def _send_lamps(self, outlook: Outlook, record: NDArray[np.void]) -> None:
        """Upload the visible lamps, scaled by the exposure of lamplight, and write their grid."""
        shining = self._shining()
        if not shining:
            return
        texels = visible_lamps(lamp_texels(shining), outlook.viewer.sides, outlook.viewer.eye)
        if not len(texels):
            return
        texels[:, 1, :3] *= record["lamplight"][0]
        place = texels[:, 0, ::2]
        record["lamps_grid"] = self._write(texels, grid_of(place, place, texels[:, 0, 3] ** -0.5), 0)
        record["beside_sun"] = 1.0

    def _send_shades(self, outlook: Outlook, record: NDArray[np.void]) -> None:
        """Upload the visible shades and write their grid."""
        shades, lowest = self._shades()
        if not shades:
            return
        if self._shade_texels[0] != shades:
            self._shade_texels = shades, shade_texels(shades)
        viewer = outlook.viewer
        visible = visible_shades(self._shade_texels[1], record["sun"][0], lowest, viewer.sides, viewer.eye)
        if visible is not None:
            record["shades_grid"] = self._write(*visible, ROWS)

    def _write(self, texels: Floats, grid: Grid, top: int) -> tuple[float, ...]:
        """Upload lamps or shades from a row on, if they have changed; return their grid as the frame block holds it."""
        rows = texture_rows(texels, grid)
        if self._uploaded.get(top) != rows.tobytes():
            self._uploaded[top] = rows.tobytes()
            self.texture.write(rows, viewport=(0, top, ROW, len(rows)))
        return (*grid.corner, 1.0 / grid.cell, grid.side)
