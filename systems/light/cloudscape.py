"""Clouds as a picture of their own, with no more pixels than show: from it, the sky is drawn behind all."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import release_all
from ..frame.block import FrameBlock, joined
from .billows import billows_texture
from .clouds import FADE
from .heaps import heaps_texture

MOST_ROWS = 364
"""Rows of pixels that clouds are drawn with at most: a line of sight through clouds costs ten times as much as all else
of the sky. In a view of 40 degrees a pixel is 2 mrad high then, 1 m of the nearest clouds. They have nothing finer:
their billows are 18 m wide, their edges 3 m soft. It does not follow the view, as lenses would need new pictures."""

MOST_SIZES = 4
"""Sizes whose pictures are kept: a viewer's last and present one, and another viewer's."""

LEAST_RISE = 1e-6
"""What counts as no change from row to row of how far lines of sight rise."""

TURNS = 32
"""How often a line of sight steps on at most."""

STEPS, SAFE, INTO = (0.015, 0.2, 0.02), 0.27, 0.2
"""How far at least, of the way from the bases to the highest tops, some 2 m; how much farther at most outside clouds,
less than heaps are wide, and within; and how much for each 1 that clouds lack there on the map, which hardly rises
faster than that, and that they have. So a step is never much longer beside one: no edge shows where it changes."""

THICK = 500.0
"""Optical depth of all that way, straight up, for each 1 that clouds are denser than at their edge: so domes hide as
much of what is overhead as columns do, which shadows know of. With their sides, clouds hide 0.03 more of the sky."""

BASE_DENSE, BASE_HIGH = 0.25, 8.0
"""The part of that which a base has, and how much more places have, for all of the height: so bases are soft."""

LEAST = 0.02
"""The part of the light behind a cloud that counts as none."""

GLSL = {
    "CLOUD_TURNS": TURNS,
    "CLOUD_STEPS": STEPS,
    "CLOUD_SAFE": SAFE,
    "CLOUD_INTO": INTO,
    "CLOUD_THICK": THICK,
    "CLOUD_BASE_DENSE": BASE_DENSE,
    "CLOUD_BASE_HIGH": BASE_HIGH,
    "CLOUD_LEAST": LEAST,
}

Size = tuple[int, int]


class Cloudscape:
    """What is seen of clouds: a picture for each of the last sizes, drawn anew for each frame that has a sky."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self.ctx, self._record, self._units = ctx, block.record, units
        shaders = "systems/light/cloudscape.vert", "systems/light/cloudscape.frag"
        self._array = ctx.vertex_array(joined(ctx, block, units, *shaders, {}), [])
        self._billows = billows_texture(ctx)
        self._heaps: moderngl.Texture | None = None
        self._pictures: dict[Size, tuple[moderngl.Framebuffer, moderngl.Texture]] = {}
        self.coarse = False
        """Whether they are drawn a little coarser."""

    def lay(self, *, seed: int) -> None:
        """Take over the clouds of another scene."""
        release_all(self._heaps)
        self._heaps = heaps_texture(self.ctx, seed=seed)

    def draw(self) -> int:
        """Draw what is seen of them, as the frame's record says by now; return the number of draw calls."""
        row = self._record[0]
        if self._heaps is None or row["cloud_edge"] > 1.0:
            return 0
        self._billows.use(self._units["billows"])
        self._heaps.use(self._units["heaps"])
        size = self._size
        target, _ = self._picture(size)
        target.use()
        target.scissor = None  # type: ignore[assignment]
        target.clear()
        first, end = rows_of_sky(row, size[1])
        target.scissor = 0, first, size[0], end - first
        self._array.render(moderngl.TRIANGLES, vertices=3)
        return 1

    def use(self) -> None:
        """Bind what was drawn, for the sky."""
        drawn = self._pictures.get(self._size)
        if drawn is not None:
            drawn[1].use(self._units["clouds"])

    @property
    def _size(self) -> Size:
        """The size of the clouds' picture [pixels], by the frame's record."""
        wide, high = (2.0 * self._record[0]["half_screen"]).tolist()
        part = part_of(high) + self.coarse
        return max(-int(-wide // part), 1), max(-int(-high // part), 1)

    def _picture(self, size: Size) -> tuple[moderngl.Framebuffer, moderngl.Texture]:
        """Return what a picture of a size is drawn into."""
        found = self._pictures.pop(size, None)
        if found is None:
            texture = self.ctx.texture(size, 4, dtype="f2")
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
            found = self.ctx.framebuffer([texture]), texture
        self._pictures[size] = found
        if len(self._pictures) > MOST_SIZES:
            release_all(*self._pictures.pop(next(iter(self._pictures))))
        return found

    def release(self) -> None:
        """Give everything back."""
        release_all(self._array, self._array.program, self._billows, self._heaps)
        for each in self._pictures.values():
            release_all(*each)


def part_of(height: float, /) -> int:
    """Return how many pixels of a picture of this height are across one of its clouds."""
    return max(-int(-height // MOST_ROWS), 1)


def rows_of_sky(row: NDArray[np.void] | np.void, height: int, /) -> tuple[int, int]:
    """Return the first row of so many in which there may be clouds, by a frame's record, and the one after the last."""
    ahead, across, up = (row[name].astype(np.float64) for name in ("ray_ahead", "ray_across", "ray_up"))
    longest = sum(float(np.linalg.norm(each)) for each in (ahead, across, up))
    highest = ahead[1] + abs(across[1]) - FADE[0] * longest  # in the middle row, over what all rows of sky have
    if abs(up[1]) < LEAST_RISE:
        return 0, height
    edge = float(np.clip(0.5 - 0.5 * highest / up[1], 0.0, 1.0)) * height
    return (int(np.floor(edge)), height) if up[1] > 0.0 else (0, int(np.ceil(edge)))
