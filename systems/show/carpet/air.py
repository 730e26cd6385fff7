"""The wind's messages at the middles of the patches around the viewer, as a texture that wraps round, and beyond."""

from math import ceil, cos, floor, pi, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ....components.viewer import Viewer
from ....engine.gl.shaders import program, set_uniform
from ....engine.gl.stream import release_all
from ....engine.gl.texture import interpolated
from ..hearing import VERTEX, Hearing
from ..representation import Canvas

FAR_SIDE, FAR_LEVELS = 96, 2
"""Texels along a side of each window beyond the patch table; number of these windows. Texels of the first one are two
patches wide, and those of each next one twice as wide: so messages are about as fine as the carpet's mesh, whose
spacing grows with distance, too."""

GLSL = {"FAR_SIDE": FAR_SIDE, "FAR_LEVELS": FAR_LEVELS}

MESH = 0.12
"""Greatest spacing of the carpet's mesh, as a part of the distance: so far beside the picture are vertices of what is
seen [rad]."""

QUARTER = 0.5 * pi
"""A quarter of a turn [rad]."""

BESIDE = 3
"""Texels beside what is seen that are computed, too: of interpolation, and as windows move by whole texels."""


def reach_of(cone: tuple[float, float], /) -> tuple[float, float, float, float]:
    """Return how far the unit vectors of a view cone reach along (-x, -z, x, z), each at least 0.

    They reach farthest at its two ends, or where they lie along an axis.
    """
    middle, half = cone[0], min(cone[1] + MESH, pi)
    first, last = ceil((middle - half) / QUARTER), floor((middle + half) / QUARTER)
    rays = middle - half, middle + half, *[quarter * QUARTER for quarter in range(first, last + 1)]
    x, z = [sin(ray) for ray in rays], [-cos(ray) for ray in rays]
    return max(0.0, -min(x)), max(0.0, -min(z)), max(0.0, *x), max(0.0, *z)


def seen_within(on: tuple[float, float], reach: tuple[float, float, float, float], /) -> tuple[int, int, int, int]:
    """Return the rectangle (x, z, width, depth) of a far window's texels that may be seen.

    The eye is `on` the window, (x, z) [texels], and sees as far as `reach_of` says.
    """
    (x, z), far = on, 2.0 * FAR_SIDE
    left, right = max(floor(x - far * reach[0]) - BESIDE, 0), min(ceil(x + far * reach[2]) + BESIDE, FAR_SIDE)
    first, last = max(floor(z - far * reach[1]) - BESIDE, 0), min(ceil(z + far * reach[3]) + BESIDE, FAR_SIDE)
    return left, first, max(right - left, 0), max(last - first, 0)


class Air:
    """The messages on the rows of the patch table, and what is read farther away: coarser ones, and their mean."""

    def __init__(self, canvas: Canvas, side: int, patch: float) -> None:
        ctx, high = canvas.ctx, FAR_LEVELS * FAR_SIDE
        self.units, self.side, self._patch = canvas.units, side, patch
        self.texture = ctx.texture((side, side), 2, dtype="f4")
        self.far = interpolated(ctx.texture((FAR_SIDE, high + 1), 2, dtype="f4"))
        """Windows one above another; the last row begins with the mean message."""
        self._target, self._far_target = ctx.framebuffer([self.texture]), ctx.framebuffer([self.far])
        self.hearing = Hearing(canvas, "systems/show/carpet/receivers.frag", {}, lambda _: None)
        self.hearing_far = Hearing(canvas, "systems/show/carpet/far.frag", {}, lambda _: None)
        self._program = program(ctx, VERTEX, "systems/show/carpet/mean.frag")
        self._program["air"] = canvas.units["air"]
        self._array = ctx.vertex_array(self._program, [])

    def hear(self, viewer: Viewer, first: int) -> int:
        """Compute the messages of all patches around a viewer, and beyond; return the number of draw calls.

        `first` is the number of the first patch's receiver among all receivers.
        """
        around = int(viewer.centre[0]), int(viewer.centre[1]), self.side, first
        array = self.hearing.array()
        set_uniform(array.program, "around", *around)
        self._target.use()
        array.render(moderngl.TRIANGLES, vertices=3)
        array = self.hearing_far.array()
        set_uniform(array.program, "around", *around)
        reach = reach_of(viewer.cone)
        for level in range(FAR_LEVELS):
            patches = 2 << level
            x, z = (at / (self._patch * patches) for at in viewer.eye[::2])
            corner = around[0] // patches - FAR_SIDE // 2, around[1] // patches - FAR_SIDE // 2
            left, low, width, depth = seen_within((x - corner[0], z - corner[1]), reach)
            set_uniform(array.program, "level", level)
            self._far_target.viewport = left, level * FAR_SIDE + low, width, depth
            self._far_target.use()
            array.render(moderngl.TRIANGLES, vertices=3)
        return 1 + FAR_LEVELS

    def write(self, row: int, message: NDArray[np.float32]) -> None:
        """Replace the message (2,) of a row of the patch table."""
        self.texture.write(np.ascontiguousarray(message), viewport=(row % self.side, row // self.side, 1, 1))

    def average(self) -> int:
        """Compute the mean of all messages; return the number of draw calls."""
        self.texture.use(self.units["air"])
        self._far_target.viewport = 0, FAR_LEVELS * FAR_SIDE, 1, 1
        self._far_target.use()
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def use(self) -> None:
        """Bind the messages and those beyond."""
        self.texture.use(self.units["air"])
        self.far.use(self.units["far_air"])

    def release(self) -> None:
        """Release all GL objects."""
        hearing = self.hearing, self.hearing_far
        release_all(*hearing, self._array, self._program, self._target, self._far_target, self.texture, self.far)
