"""The reference picture to compare with: every blade in 3D at the finest level, supersampled."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from ..components.arrays import Ints, Point
from ..engine.camera import View, view_of
from ..engine.gl.guest import clear
from ..engine.gl.stream import release_all
from ..engine.terrain.sample import height_at
from .around.outlook import Outlook
from .painter import Painter
from .prairie import Prairie
from .show.blades.draw import BladeDrawing
from .show.blades.plant import standing_blades
from .show.blades.representation import BladeRepresentation
from .show.carpet.painter import CarpetPainter
from .space.cone import HALF_DIAGONAL, discrete_distance, inside_cone, view_cone
from .space.frustum import outside_planes, outside_planes_on_grid, picture_sides
from .space.ground import Ground
from .space.window import cell_of
from .tile import cells_on, patch_models
from .trees.draw import TreePart
from .trees.standing import PICTURE_BELOW
from .wind.blow import lone_receivers
from .wind.grass import grass_of

ROOM = 1.5
"""Upper bound of a bent and leaning blade's distance from its root, in its own lengths."""

CHUNK = 400
"""Number of patches drawn at a time in a reference, so that a large terrain needs no large buffers."""


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """A supersampled picture, and an estimate of its error against one with infinitely many samples."""

    picture: NDArray[np.uint8]
    """sRGB bytes, top row first, shape (height, width, 3)."""

    doubt: NDArray[np.float32]
    """Uncertainty of each pixel, shape (height, width, 3): half the difference between the means of two halves of its
    samples, taken like the white and black fields of a chessboard. Its mean square is at least that of the noise."""


def terrain_cells(ground: Ground, /) -> Ints:
    """Return every cell of the terrain, shape (n, 2)."""
    patch, terrain = ground.patch, ground.terrain
    low = np.asarray(terrain.origin, np.float32)
    first, last = cell_of(low, patch=patch), cell_of(low + np.array(terrain.size, np.float32), patch=patch)
    cells = np.stack(np.meshgrid(*(np.arange(a, b + 1) for a, b in zip(first, last, strict=True))), -1)
    flat: Ints = cells.reshape(-1, 2).astype(np.int32)
    return flat[cells_on(terrain, flat, patch=patch)]


def cells_within(ground: Ground, eye: Point, cone: tuple[float, float], /, *, sway: float) -> Ints:
    """Return the cells of the terrain inside an eye's view cone, (n, 2).

    `sway` is the distance that grass may reach beyond its patch [m].
    """
    cells = terrain_cells(ground)
    middles = (cells + np.float32(0.5)) * np.float32(ground.patch)
    radius = ground.patch * HALF_DIAGONAL + sway
    return cells[inside_cone(middles, apex=(eye[0], eye[2]), cone=cone, radius=radius)]


def cells_in_picture(prairie: Prairie, cells: Ints, seen: View, /) -> Ints:
    """Return those of `cells` (n, 2) whose blades may reach into the picture in some posture, shape (m, 2)."""
    site = prairie.site
    patch, terrain = site.ground.patch, site.ground.terrain
    corners = (cells[:, None] + np.array([(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)])) * patch
    heights = height_at(terrain, corners.reshape(-1, 2).astype(np.float32)).reshape(-1, 4)
    x, z = ((cells.T + 0.5) * patch).astype(np.float64)
    outside = outside_planes_on_grid(x, z, heights.mean(axis=1), picture_sides(seen))
    inside: Ints = cells[outside <= HALF_DIAGONAL * patch + ROOM * site.tallest + np.ptp(heights, axis=1)]
    return inside


def stand_all(prairie: Prairie, cells: Ints, painter: BladeDrawing, /, *, seen: View | None = None) -> int:
    """Upload all blades of `cells` (n, 2) to a painter, bent by the present wind; return their number.

    With a view `seen`, blades that cannot reach into the picture are left out.
    """
    site = prairie.site
    (stock,) = (each.stock for each in site.representations if isinstance(each, BladeRepresentation))
    model, turn = patch_models(cells, seed=site.scene.seed, models=site.quality.models)
    standing, grows = standing_blades(stock, cells, model, turn, site.ground)
    blades = standing[grows]
    if seen is not None:
        blades = blades[near_picture(blades, seen)]
    if not len(blades):
        return 0
    place = np.ascontiguousarray(blades["root"][:, ::2])
    grass = grass_of(site.growths, blades["kind"].astype(np.intp))
    receivers = lone_receivers(place, grass)
    painter.write(blades, prairie.pressers.over(prairie.winds.messages_to(receivers, time=prairie.time), receivers))
    return len(blades)


def near_picture(blades: NDArray[np.void], seen: View, /) -> NDArray[np.bool_]:
    """Return whether each blade, a record of (n,), may reach into the picture in some posture, shape (n,)."""
    root = blades["root"].astype(np.float64)
    length = blades["height"] + (blades["stem"] if "stem" in (blades.dtype.names or ()) else 0.0)
    reach = ROOM * length.astype(np.float64) + blades["width"]
    return np.asarray(outside_planes(root, picture_sides(seen)) <= reach)


def carpet_painter(painter: Painter, /) -> CarpetPainter:
    """Return the painter of ground and carpet."""
    carpet = painter.coarsest
    assert isinstance(carpet, CarpetPainter)
    return carpet


class EveryBlade:
    """Draws a prairie with every blade in 3D at the finest level and every leaf, by the prairie's own painter.

    The prairie must have been drawn once, as its viewer's eye is used.
    """

    def __init__(self, prairie: Prairie) -> None:
        if prairie.painter is None:
            raise RuntimeError("draw the prairie once before its reference")
        self.prairie = prairie
        self.painter: Painter = prairie.painter
        self.outlook: Outlook = prairie.viewers["main"]
        self.blades = self.painter.blade_painter(prairie.site.finest)

    def draw(
        self,
        view: View,
        cells: Ints,
        *,
        reach: int | None = None,
        leaves_from: float = 0.0,
        seen_at: Sequence[Point] = (),
    ) -> None:
        """Draw sky, ground, all trees and all blades of `cells` (n, 2) into the bound framebuffer.

        With `reach`, blades are drawn up to this discrete distance, and the prairie's own carpet beyond it. Trees are
        drawn as the prairie's far trees if they are no higher than `leaves_from` [pixels], seen from every place of
        `seen_at` [m], or else from the viewer's eye.
        """
        cover = None
        if reach is not None:
            patches, appears = self.outlook.patches, self.outlook.appearance
            cover = np.where(patches.distance > reach, appears.cover[-1], np.float32(0.0))
            cells = cells[discrete_distance(cells, self.outlook.viewer.centre) <= reach]
        cells = cells[self.prairie.clearings.spare(cells)]
        carpet_painter(self.painter).lay(self.outlook, cover)
        trees = self.painter.part(TreePart)
        trees.leaves_from, trees.detail_eyes = leaves_from, seen_at
        try:
            self.painter.draw(view, blades=self._chunks(cells, view))
        finally:
            trees.leaves_from, trees.detail_eyes = None, ()

    def _chunks(self, cells: Ints, seen: View) -> Iterator[BladeDrawing]:
        for start in range(0, len(cells), CHUNK):
            if stand_all(self.prairie, cells[start : start + CHUNK], self.blades, seen=seen):
                yield self.blades

    def release(self) -> None:
        """Release the blades' GL objects."""
        self.blades.release()


@contextmanager
def without_trees(prairie: Prairie) -> Iterator[None]:
    """Hide the trees of a prairie that has been drawn once, but not their shade, inside this context."""
    assert prairie.painter is not None
    trees = prairie.painter.part(TreePart)
    trees.hidden = True
    try:
        yield
    finally:
        trees.hidden = False


def patch_distances(prairie: Prairie, view: object, projection: object, size: tuple[int, int]) -> NDArray[np.int32]:
    """Return the discrete distance of the patch that each pixel shows, top row first, shape (height, width).

    It is -1 for the sky, and for ground beyond the terrain, where there are no patches. The patch is found at half the
    mean height of the kinds of grass.
    """
    seen, every = view_of(view, projection), prairie.painter
    if every is None:
        raise RuntimeError("draw the prairie once before asking what its picture shows")
    ctx, (width, height) = every.ctx, size
    host = ctx.detect_framebuffer()
    depth = ctx.depth_texture(size)
    target = ctx.framebuffer([ctx.renderbuffer(size)], depth)
    try:
        target.use()
        clear(target, depth=1.0)
        carpet_painter(every).lay(prairie.viewers["main"], None)
        raised = np.eye(4)
        raised[1, 3] = 0.5 * np.mean(prairie.site.canopy)
        every.draw(view_of(seen.view @ raised, seen.projection), blades=[])
        fine = np.frombuffer(depth.read(alignment=1), np.float32).reshape(height, width)[::-1]
    finally:
        host.use()
        target.color_attachments[0].release()
        release_all(target, depth)
    centre = prairie.viewers["main"].viewer.centre
    return _distances(fine.astype(np.float64), seen, centre, prairie.site.ground)


def _distances(depth: NDArray[np.float64], seen: View, centre: Ints, ground: Ground) -> NDArray[np.int32]:
    height, width = depth.shape
    across = (np.arange(width) + 0.5) / width * 2.0 - 1.0
    up = 1.0 - (np.arange(height) + 0.5) / height * 2.0
    x, y = np.meshgrid(across, up)
    clip = np.stack([x, y, depth * 2.0 - 1.0, np.ones_like(x)], axis=-1)
    world = clip @ seen.unclip.T
    place = np.stack([world[..., 0] / world[..., 3], world[..., 2] / world[..., 3]], axis=-1)
    cell = cell_of(np.clip(place, -1e6, 1e6), patch=ground.patch)
    low, size = np.asarray(ground.terrain.origin), np.asarray(ground.terrain.size)
    here = (depth < 1.0) & ((place >= low) & (place <= low + size)).all(axis=-1)
    return np.where(here, discrete_distance(cell, centre), -1).astype(np.int32)


def draw_truth(
    prairie: Prairie,
    view: object,
    projection: object,
    size: tuple[int, int],
    *,
    samples: int = 4,
    reach: int | None = None,
    seen_at: Sequence[Point] = (),
) -> Truth:
    """Return the reference picture of a prairie that has been drawn once, and its uncertainty.

    Each pixel is the mean of `samples` by `samples` pixels of a larger picture, in display space as blending is. With
    `reach`, blades are drawn up to this discrete distance, and the prairie's own carpet beyond it; far trees, seen from
    here or from every place of `seen_at` [m], are drawn as the prairie draws them. The matrices may show a part of the
    picture that the prairie was drawn with, as those of `cropped` do.
    """
    seen = view_of(view, projection)
    every = EveryBlade(prairie)
    ctx, (width, height) = every.painter.ctx, size
    host, quarantine = ctx.detect_framebuffer(), prairie.winds.quarantine
    live = quarantine.live
    large = (width * samples, height * samples)
    color, depth = ctx.texture(large, 3, alignment=1), ctx.depth_renderbuffer(large)
    target = ctx.framebuffer([color], depth)
    try:
        quarantine.live = False  # so that no wind is left out part of the way
        target.use()
        clear(target, depth=1.0)
        site = prairie.site
        cells = cells_within(site.ground, every.outlook.viewer.eye, view_cone(seen), sway=site.sway)
        leaves_from = 0.0 if reach is None else samples * PICTURE_BELOW
        cells = cells_in_picture(prairie, cells, seen)
        every.draw(seen, cells, reach=reach, leaves_from=leaves_from, seen_at=seen_at)
        return box_filtered(target, size, samples)
    finally:
        quarantine.live = live
        host.use()
        release_all(target, color, depth, every)


def box_filtered(target: moderngl.Framebuffer, size: tuple[int, int], samples: int) -> Truth:
    """Return a framebuffer's picture with each `samples` by `samples` pixels averaged into one, top row first."""
    width, height = size
    fine = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    fine = fine.reshape(height, samples, width, samples, 3)
    halves = np.zeros((2, height, width, 3), np.uint32)
    for down, across in np.ndindex(samples, samples):  # many times as fast as one sum over two axes
        halves[(down + across) % 2] += fine[:, down, :, across]
    count = samples * samples
    white, black = halves[0] / max(count - count // 2, 1), halves[1] / max(count // 2, 1)
    doubt = 0.5 * (white - black) if count > 1 else np.zeros_like(white)
    picture = np.round(halves.sum(axis=0) / count).astype(np.uint8)
    return Truth(np.ascontiguousarray(picture[::-1]), np.ascontiguousarray(doubt[::-1], np.float32))


def cropped(
    projection: NDArray[np.float32], corner: tuple[int, int], part: tuple[int, int], whole: tuple[int, int], /
) -> NDArray[np.float32]:
    """Return the projection (4, 4) that shows only a part of a picture.

    `corner` is the column and row of the part's first pixel from the top left, `part` and `whole` are (width, height)
    [pixels].
    """
    (left, top), (wide, high), (width, height) = corner, part, whole
    narrow = np.eye(4)
    narrow[0, [0, 3]] = width / wide, (width - 2 * left) / wide - 1.0
    narrow[1, [1, 3]] = height / high, 1.0 - (height - 2 * top) / high
    return np.asarray(narrow @ projection, np.float32)
