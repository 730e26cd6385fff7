"""A rival to measure against: the same scene, drawn by common techniques, without this engine's."""

from math import cos, radians, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...engine.camera import View
from ...engine.gl.stream import Records, release_all
from ...engine.terrain.sample import height_at
from ...systems.features import UNITS
from ...systems.frame.block import joined
from ...systems.painter import Painter
from ...systems.reference import terrain_cells
from ...systems.show.blades.plant import BladeStock
from ...systems.show.blades.representation import BladeRepresentation
from ...systems.site import Site
from ...systems.space.frustum import outside_planes, picture_sides
from ...systems.tile import patch_models
from ...systems.wind.breeze import Breeze

NEAR, MIDDLE = 10.0, 30.0
"""Distances at which the first two of three levels end [m]."""

FULL = 12.0
"""Distance up to which every blade is drawn [m]. Blades are about a pixel wide there: beyond are fewer, wider ones."""

CHUNK = 32
"""Number of blades that are drawn or left out together."""

WIDTH = 2048
"""Width of the data textures [texels]."""

TEXEL = np.dtype([("texel", "4f4")])


class ByHand:
    """Grass on tiles culled to the frustum and thinned by distance: three levels of segments, an instanced draw each.

    Blades, light and ground are the engine's. Blades sway in the scene's first breeze, computed by the graphics card.
    Nothing is blended: edges are as smooth as the framebuffer's samples make them.
    """

    def __init__(self, painter: Painter, site: Site) -> None:
        self._painter, self._site, self._ctx = painter, site, painter.ctx
        (stock,) = (each.stock for each in site.representations if isinstance(each, BladeRepresentation))
        order = np.argsort(stock.rank, axis=1, kind="stable")
        self._rank: Floats = np.take_along_axis(stock.rank, order, axis=1).min(axis=0)
        self._blades, self._chunks = (Records(self._ctx, TEXEL, WIDTH) for _ in range(2))
        self._blades.write(_blade_texels(stock, order))
        self._lay_tiles()
        segments = (max(site.finest, 3), 3, 1)
        self._programs = [self._program(each) for each in segments]
        self._arrays = [self._ctx.vertex_array(program, []) for program in self._programs]
        self._vertices = [2 * each + 1 for each in segments]
        self._instances = [0, 0, 0]

    def _program(self, segments: int) -> moderngl.Program:
        defines = {"SEGMENTS": segments, "CHUNK": CHUNK, "WIDTH": WIDTH}
        units = UNITS | {"blades": 0, "chunks": 1}
        made = joined(self._ctx, self._painter.block, units, "app/bench/rival.vert", "app/bench/rival.frag", defines)
        made["many"], made["full"] = len(self._rank), FULL
        found = [wind for wind in self._site.scene.wind if isinstance(wind, Breeze)]
        breeze = found[0] if found else Breeze(strength=0.0)
        heading = radians(breeze.direction)
        made["breeze"] = sin(heading), -cos(heading), breeze.strength, breeze.gustiness
        made["speed"] = breeze.speed
        return made

    def _lay_tiles(self) -> None:
        """Compute the tiles once: places, patch models, and bounding spheres."""
        site, patch = self._site, self._site.ground.patch
        cells = terrain_cells(site.ground)
        model, turn = patch_models(cells, seed=site.scene.seed, models=site.quality.models)
        corner = cells.astype(np.float32) * np.float32(patch)
        steps = np.array([[0, 0], [1, 0], [0, 1], [1, 1]], np.float32) * np.float32(patch)
        heights = height_at(site.ground.terrain, (corner[:, None] + steps).reshape(-1, 2)).reshape(-1, 4)
        tallest = max(kind.height[1] for kind in site.scene.grass.values())
        low, high = heights.min(axis=1), heights.max(axis=1) + np.float32(tallest)
        middle = corner + np.float32(patch / 2)
        self._middle = np.stack([middle[:, 0], (low + high) / 2, middle[:, 1]], axis=1)
        aside = np.float32(0.71 * patch + site.sway)
        self._radius = np.hypot(aside, (high - low) / 2)
        self._tile = np.zeros((len(cells), 2, 4), np.float32)
        self._tile[:, 0, :2], self._tile[:, 0, 2] = corner, model * 4 + turn
        self._tile[:, 1] = heights

    def cull(self, view: View) -> None:
        """Choose the visible tiles and their numbers of blades, and upload them."""
        eye = np.array(view.eye)
        planes = picture_sides(view, ends=True).astype(np.float32)
        seen = np.flatnonzero(outside_planes(self._middle, planes) <= self._radius)
        away = np.linalg.norm(self._middle[seen] - eye.astype(np.float32), axis=1)
        order = np.argsort(away)
        seen, away = seen[order], away[order]
        share = np.minimum(FULL / np.maximum(away - self._radius[seen], 1e-3), 1.0)
        chunks = np.ceil(np.searchsorted(self._rank, share) / CHUNK).astype(np.intp)
        texels = np.repeat(self._tile[seen], chunks, axis=0)
        start = np.cumsum(chunks) - chunks
        texels[:, 0, 3] = (np.arange(len(texels)) - np.repeat(start, chunks)) * CHUNK
        ends = np.append(start, len(texels))[np.searchsorted(away, [NEAR, MIDDLE, np.inf])]
        self._instances = np.diff(ends, prepend=0).tolist()
        self._chunks.write(texels.view(TEXEL).reshape(-1))

    def draw(self, view: View, *, time: float) -> None:
        """Draw the frame of an instant [s] into the bound framebuffer, on the carpet that was laid last."""
        self.cull(view)
        self._painter.draw(view, blades=[])
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._blades.texture.use(0)
        self._chunks.texture.use(1)
        first = 0
        for level, count in enumerate(self._instances):
            program = self._programs[level]
            program["first"], program["now"] = first, time
            if count:
                self._arrays[level].render(moderngl.TRIANGLE_STRIP, self._vertices[level], instances=count * CHUNK)
            first += count
        self._ctx.enable_only(moderngl.NOTHING)

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._arrays, *self._programs, self._blades, self._chunks)


def _blade_texels(stock: BladeStock, order: NDArray[np.intp]) -> NDArray[np.void]:
    """Return the texels of all tiles' blades, shape (n,), in the `order` in which thinning keeps them longest."""
    turns = np.repeat(order, 4, axis=0)
    records = np.take_along_axis(stock.records, turns, axis=1)
    texels = np.zeros((*records.shape, 3, 4), np.float32)
    texels[..., 0, :2] = records["root"][..., ::2]
    texels[..., 0, 2], texels[..., 0, 3] = records["height"], records["width"]
    texels[..., 1, :2], texels[..., 1, 2:] = records["rest"], records["facing"]
    texels[..., 2, 0] = records["kind"]
    texels[..., 2, 1] = np.take_along_axis(np.repeat(stock.rank, 4, axis=0), turns, axis=1)
    return texels.view(TEXEL).reshape(-1)
