"""Clouds as a picture of their own, with half as many pixels across and up: from it, the sky is drawn behind all."""

from collections.abc import Mapping

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...engine.gl.stream import release_all
from ..frame.block import FrameBlock, joined
from .billows import billows_texture
from .clouds import FADE
from .heaps import heaps_texture

PART = 2
"""Pixels of the sky for each pixel of clouds, across and up: a line of sight through clouds costs ten times as much as
all else of the sky, and their edges are soft."""

MOST_SIZES = 4
"""Sizes whose pictures are kept: a viewer's last and present one, and another viewer's."""

LEAST_RISE = 1e-6
"""What counts as no change from row to row of how far lines of sight rise."""

TURNS, STEPS, SAFE = 20, (0.024, 0.2), 0.27
"""How often a line of sight steps on at most; how far at least and at most, of the way from the bases to the
highest tops: some 10 m, less than the finest billows, and less than heaps are wide; and how far for each 1 that clouds
lack there on the map, which hardly rises faster than that."""

BRIM = 0.04
"""How much denser than at its edge a base is that is seen: what is thinner shows what is behind."""

BEHIND, SOLID = 0.3, (0.01, 30.0)
"""How far behind where a cloud is entered its map counts, of all the way; how much denser a billow is at least than
there; and what the square of how fast it gets denser is divided by, as of a parabola: so edges of heaps are soft."""

GLSL = {
    "CLOUD_TURNS": TURNS,
    "CLOUD_STEPS": STEPS,
    "CLOUD_SAFE": SAFE,
    "CLOUD_BRIM": BRIM,
    "CLOUD_SOLID": SOLID,
    "CLOUD_BEHIND": BEHIND,
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

    def lay(self, *, seed: int) -> None:
        """Take over the clouds of another scene."""
        if self._heaps is not None:
            self._heaps.release()
        self._heaps = heaps_texture(self.ctx, seed=seed)

    def draw(self) -> int:
        """Draw what is seen of them, as the frame's record says by now; return the number of draw calls."""
        row = self._record[0]
        if self._heaps is None or row["cloud_edge"] > 1.0:
            return 0
        self._billows.use(self._units["billows"])
        self._heaps.use(self._units["heaps"])
        size = _size(row)
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
        drawn = self._pictures.get(_size(self._record[0]))
        if drawn is not None:
            drawn[1].use(self._units["clouds"])

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
        release_all(self._array, self._array.program, self._billows)
        if self._heaps is not None:
            self._heaps.release()
        for each in self._pictures.values():
            release_all(*each)


def _size(row: np.void) -> Size:
    """Return the size of the clouds' picture [pixels], by a frame's record."""
    width, height = (2.0 * row["half_screen"]).tolist()
    return max(-int(-width // PART), 1), max(-int(-height // PART), 1)


def rows_of_sky(row: NDArray[np.void] | np.void, height: int, /) -> tuple[int, int]:
    """Return the first row of so many in which there may be clouds, by a frame's record, and the one after the last."""
    ahead, across, up = (row[name].astype(np.float64) for name in ("ray_ahead", "ray_across", "ray_up"))
    longest = sum(float(np.linalg.norm(each)) for each in (ahead, across, up))
    highest = ahead[1] + abs(across[1]) - FADE[0] * longest  # in the middle row, over what all rows of sky have
    if abs(up[1]) < LEAST_RISE:
        return 0, height
    edge = float(np.clip(0.5 - 0.5 * highest / up[1], 0.0, 1.0)) * height
    return (int(np.floor(edge)), height) if up[1] > 0.0 else (0, int(np.ceil(edge)))
