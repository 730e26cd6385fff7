"""Clouds drawn into a picture of reduced resolution, which the sky samples."""

import math
from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.guest import clear
from ...engine.gl.smaller import Size
from ...engine.gl.stream import release_all
from ...engine.gl.texture import interpolated
from ..frame.block import FrameBlock, joined
from .billows import billows_texture
from .clouds import DEPTH, DOME, FADE, SILVER_DEPTH
from .heaps import heaps_texture

MOST_ROWS = 364
"""Largest number of rows of the clouds' picture: marching through clouds costs ten times as much as the rest of the
sky. In a view of 40 degrees a pixel is then 2 mrad high, 1 m on the nearest clouds; billows are 18 m wide and edges 5 m
soft. It does not depend on the angle of view, so that zooming makes no new pictures."""

COARSE_ROWS = MOST_ROWS // 2
"""The same of a coarse quality: a pixel is 2 m high on the nearest clouds, still less than their edges are soft."""

MOST_SIZES = 4
"""Number of sizes whose pictures are kept: a viewer's last and present one, and another viewer's."""

LEAST_RISE = 1e-6
"""Smallest change of the lines of sight's elevation from row to row; below it all rows are drawn."""

MOST_STEPS = 32
"""Largest number of steps along a line of sight."""

STEP_LENGTHS, STEP_OUTSIDE, STEP_INSIDE = (0.015, 0.22, 0.025), 0.37, 0.2
"""Shortest step, and what may be added to it at most outside clouds and inside, relative to the way from the bases to
the highest tops. Outside, a step grows by `STEP_OUTSIDE` per unit of missing density, as the map hardly rises faster;
inside, by `STEP_INSIDE` per unit of excess density. So step lengths change gradually, and no edges show. The shortest
step is some 3 m; the longest is shorter than heaps are wide."""

MARCH_DEPTH = 1.5 * math.sqrt(DOME) * DEPTH**1.5
"""Optical depth of the whole way, straight up, per unit of excess density: where the column that shadows use has an
optical depth of 1, the dome above it has the same. Seen with their sides, clouds hide up to 0.05 more of the sky."""

BASE_DEPTH, BASE_DEPTH_RISE = 0.2, 4.0
"""Factor on the optical depth at a base, and its increase over the whole height, up to 1: it makes bases soft."""

OPAQUE = 0.04
"""Transmittance that counts as 0."""

GLSL = {
    "CLOUD_MOST_STEPS": MOST_STEPS,
    "CLOUD_STEP_LENGTHS": STEP_LENGTHS,
    "CLOUD_STEP_OUTSIDE": STEP_OUTSIDE,
    "CLOUD_STEP_INSIDE": STEP_INSIDE,
    "CLOUD_MARCH_DEPTH": MARCH_DEPTH,
    "CLOUD_BASE_DEPTH": BASE_DEPTH,
    "CLOUD_BASE_DEPTH_RISE": BASE_DEPTH_RISE,
    "CLOUD_OPAQUE": OPAQUE,
    "CLOUD_SILVER_LEAST": OPAQUE**SILVER_DEPTH,
}


class Cloudscape:
    """The clouds' pictures, one for each recent size; the present one is drawn in each frame that shows sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._record, self._units = ctx, block.record, units
        shaders = "systems/light/cloudscape.vert", "systems/light/cloudscape.frag"
        self._array = ctx.vertex_array(joined(ctx, block, units, *shaders, {}), [])
        self._billows = billows_texture(ctx)
        self._heaps: moderngl.Texture | None = None
        self._pictures: dict[Size, tuple[moderngl.Framebuffer, moderngl.Texture]] = {}
        self.coarse = False
        """Whether clouds are drawn at a lower resolution."""

    def lay(self, *, seed: int) -> None:
        """Make the cloud map of a scene's seed."""
        release_all(self._heaps)
        self._heaps = heaps_texture(self.ctx, seed=seed)

    def draw(self) -> int:
        """Draw the clouds in view into their picture, by the frame block's record; return the number of draw calls."""
        row = self._record[0]
        if self._heaps is None or row["cloud_edge"] > 1.0:
            return 0
        self._billows.use(self._units["billows"])
        self._heaps.use(self._units["heaps"])
        size = self._size
        target, _ = self._picture(size)
        target.use()
        target.scissor = None  # type: ignore[assignment]
        clear(target)
        first, end = rows_of_sky(row, size[1])
        target.scissor = 0, first, size[0], end - first
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def use(self) -> None:
        """Bind the picture for the sky's shaders."""
        drawn = self._pictures.get(self._size)
        if drawn is not None:
            drawn[1].use(self._units["clouds"])

    @property
    def _size(self) -> Size:
        """Size of the clouds' picture [pixels], by the frame block's record."""
        wide, high = (2.0 * self._record[0]["half_screen"]).tolist()
        pixel = cloud_pixel(high, most_rows=COARSE_ROWS if self.coarse else MOST_ROWS)
        return max(-int(-wide // pixel), 1), max(-int(-high // pixel), 1)

    def _picture(self, size: Size) -> tuple[moderngl.Framebuffer, moderngl.Texture]:
        """Return the framebuffer and texture of a size; release the least recently used beyond the limit."""
        picture = self._pictures.pop(size, None)
        if picture is None:
            texture = interpolated(self.ctx.texture(size, 4, dtype="f2"))
            picture = self.ctx.framebuffer([texture]), texture
        self._pictures[size] = picture
        if len(self._pictures) > MOST_SIZES:
            release_all(*self._pictures.pop(next(iter(self._pictures))))
        return picture

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self._array, self._array.program, self._billows, self._heaps)
        for each in self._pictures.values():
            release_all(*each)


def cloud_pixel(height: float, /, *, most_rows: int = MOST_ROWS) -> int:
    """Return the factor by which clouds are coarser than a picture of this height [pixels], in at most `most_rows`."""
    return max(-int(-height // most_rows), 1)


def rows_of_sky(row: NDArray[np.void] | np.void, height: int, /) -> tuple[int, int]:
    """Return the range of rows, out of `height`, that may show clouds, by a frame block's record: first and end."""
    ahead, across, up = (row[name].astype(np.float64) for name in ("ray_ahead", "ray_across", "ray_up"))
    longest = sum(float(np.linalg.norm(each)) for each in (ahead, across, up))
    highest = ahead[1] + abs(across[1]) - FADE[0] * longest  # in the middle row, relative to the lowest clouds
    if abs(up[1]) < LEAST_RISE:
        return 0, height
    edge = float(np.clip(0.5 - 0.5 * highest / up[1], 0.0, 1.0)) * height
    return (int(np.floor(edge)), height) if up[1] > 0.0 else (0, int(np.ceil(edge)))
