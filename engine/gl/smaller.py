"""Drawing at reduced resolution: into a smaller framebuffer, which is then upsampled into the host's."""

import logging
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from ctypes import c_float
from dataclasses import dataclass

import moderngl

from .functions import ENUMS, functions_of
from .guest import aside, clear, colourless, depth_ends, farthest_depth, set_depth_test
from .occlusion import OcclusionQuery
from .outputs import has_depth
from .rasteriser import draws_in_software
from .shaders import program
from .stream import release_all
from .units import UNITS

log = logging.getLogger("tallgrass")

Size = tuple[int, int]
"""Width and height of a picture [pixels]."""

OVER = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
"""Blending of premultiplied colours over what was drawn before."""

MOST_SIZES = 4
"""Number of sizes whose buffers are kept: the last and the present one of two viewers."""

TEXTURE_UNITS = dict(zip(("host_depth", "small_color", "small_depth"), UNITS[-3:], strict=True))
"""Texture units of the samplers: the last ones, whose other users bind their textures anew before each use."""

TILES_UNIT = TEXTURE_UNITS["host_depth"]
"""Texture unit of the sorts of tiles: no pass reads the host's depth as well."""

TILE = 16
"""Width and height of a tile, which a card draws with depth or without [pixels of the smaller picture]."""

TILE_VERTICES = 6
"""Vertices of a tile's two triangles."""

FLAT, OF_HOST, DEEP = 0.0, 0.5, 1.0
"""Sorts of tiles: those without any depth, those of a picture where the host has drawn anything, those with depth."""

GLSL = {"TILE": TILE, "TILE_FLAT": FLAT, "TILE_OF_HOST": OF_HOST, "TILE_DEEP": DEEP, "TILE_VERTICES": TILE_VERTICES}

PASSES = {"find": ">", "bring": "1", "fit": ">", "deepen": "<", "enlarge": "1", "lay": "1"}
"""Depth test of each pass that fills the viewport.

`find` asks whether the host has drawn any pixel, and `bring` copies the host's depth to the smaller buffer. `fit`
blends the picture over the host's pixels, and `deepen` writes its depth there. `enlarge` writes colour and depth where
the host has drawn nothing. `find` and `fit` draw at the far plane. `lay`, where nothing else has depth, replaces `fit`,
`deepen` and `enlarge`: it draws the picture over everything.
"""

TILED = {FLAT: "flat", DEEP: "deep"}
"""Passes over tiles of a sort, by which a card enlarges the picture where the host has drawn nothing at all: most of a
frame's depth would be that of the sky, which is there already. `sort` finds out which tiles are of which sort."""


def smaller_size(size: Size, scale: float, /) -> Size:
    """Return the size of a picture [pixels] scaled by `scale`, at least one pixel on each side."""
    width, height = size
    return max(1, round(width * scale)), max(1, round(height * scale))


@dataclass(frozen=True, slots=True, eq=False)
class Buffers:
    """A smaller framebuffer with its textures of colour and depth, a copy of the host's depth, and sorts of tiles."""

    host_depth: moderngl.Texture
    color: moderngl.Texture
    depth: moderngl.Texture
    target: moderngl.Framebuffer
    tiles: moderngl.Texture
    sorting: moderngl.Framebuffer

    @classmethod
    def made(cls, ctx: moderngl.Context, full: Size, small: Size, /, *, floats: bool = False) -> "Buffers":
        """Return new buffers for the sizes of the host's viewport and of the smaller picture [pixels]."""
        host_depth, color, depth = (
            ctx.depth_texture(full),
            ctx.texture(small, 4, dtype="f2" if floats else "f1"),
            ctx.depth_texture(small),
        )
        for texture in (host_depth, color, depth):
            texture.repeat_x = texture.repeat_y = False
        for texture in (host_depth, depth):
            texture.compare_func, texture.filter = "", (moderngl.NEAREST, moderngl.NEAREST)
        tiles = ctx.texture((-(-small[0] // TILE), -(-small[1] // TILE)), 1)
        tiles.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return cls(host_depth, color, depth, ctx.framebuffer([color], depth), tiles, ctx.framebuffer([tiles]))

    def use(self) -> None:
        """Bind the textures to the units of the passes' samplers."""
        self.host_depth.use(TEXTURE_UNITS["host_depth"])
        self.color.use(TEXTURE_UNITS["small_color"])
        self.depth.use(TEXTURE_UNITS["small_depth"])

    def release(self) -> None:
        """Release framebuffers and textures."""
        release_all(self.target, self.sorting, self.host_depth, self.color, self.depth, self.tiles)


class Smaller:
    """Framebuffers of fewer pixels that a guest draws into in place of the host's.

    They are made at first use, one for each of the last `MOST_SIZES` sizes.
    """

    def __init__(self, ctx: moderngl.Context, *, floats: bool = False) -> None:
        self._ctx, self._gl, self._floats = ctx, functions_of(ctx), floats
        self._passes: dict[str, moderngl.VertexArray] = {}
        self._buffers: dict[tuple[Size, Size], Buffers] = {}
        self._has_drawn = OcclusionQuery(ctx)
        self._uniforms: dict[str, object] = {}
        """Values of uniforms that all programs were given last, by name."""
        self._warned: set[str] = set()
        self._by_tiles = not draws_in_software(ctx)
        """Whether the picture is enlarged by tiles where the host has drawn nothing: where a card finds that out."""

    @contextmanager
    def instead_of(
        self, host: moderngl.Framebuffer, scale: float, *, is_whole: bool = True, is_alone: bool = False
    ) -> Iterator[moderngl.Framebuffer]:
        """Yield a framebuffer of `scale` times the size of the host's viewport, initialised with the host's depth.

        In the end, its picture is drawn over the host's, and the host's depth becomes the nearer one of the two. The
        host's framebuffer must be bound as `guest` binds it. It is yielded itself where `scale` is 1, and where it
        cannot be replaced, which is logged once. A picture that `is_whole` is opaque where the host has drawn nothing;
        any other is blended there too. Where only the picture has depth (`is_alone`), the host's depth is neither read
        nor written.
        """
        if scale >= 1.0 or self._is_obstructed(host):
            yield host
            return
        x, y, width, height = host.viewport
        buffers = self._room((width, height), smaller_size((width, height), scale))
        if not is_alone:
            self._find(host, buffers)
        with aside(self._ctx, host, alike=True):
            if not is_alone:  # the host's framebuffer is still bound for reading
                self._gl.glActiveTexture(ENUMS["TEXTURE0"] + TEXTURE_UNITS["host_depth"])
                self._gl.glCopyTexSubImage2D(ENUMS["TEXTURE_2D"], 0, 0, 0, x, y, width, height)
            buffers.target.depth_mask = True
            buffers.target.scissor = None  # type: ignore[assignment]
            buffers.target.use()
            clear(buffers.target, depth=farthest_depth())
            if not is_alone:
                with self._if_host_has_drawn(host), colourless(buffers.target):
                    self._run("bring")
            yield buffers.target
            if is_whole and not is_alone:
                self._sort(host, buffers)
        self._enlarge(host, buffers, is_whole=is_whole, is_alone=is_alone)

    def _enlarge(self, host: moderngl.Framebuffer, buffers: Buffers, *, is_whole: bool, is_alone: bool) -> None:
        """Draw the smaller picture over the host's."""
        x, y = host.viewport[:2]
        self._bind(buffers)
        host.depth_mask = False
        if is_alone:
            self._run("lay", blending=None if is_whole else OVER, everywhere=True)
            host.depth_mask = True
            return
        self._set_uniforms({"whole": is_whole, "corner": (x, y)})
        if is_whole and self._by_tiles:
            self._draw_tiles(host, buffers)
        with self._if_host_has_drawn(host) if is_whole else nullcontext():
            host.depth_mask = False
            self._run("fit", blending=OVER, everywhere=not is_whole)
            host.depth_mask = True
            with colourless(host):
                self._run("deepen")
            if is_whole and self._by_tiles:
                self._run("enlarge")
        if is_whole and not self._by_tiles:
            self._run("enlarge")

    def _sort(self, host: moderngl.Framebuffer, buffers: Buffers) -> None:
        """Sort the tiles of the smaller picture."""
        if not self._by_tiles:
            return
        self._bind(buffers)
        buffers.sorting.scissor = None  # type: ignore[assignment]
        buffers.sorting.use()
        self._run("sort", everywhere=True)
        with self._if_host_has_drawn(host):
            self._gl.glClearBufferfv(ENUMS["COLOR"], 0, (c_float * 4)(*(OF_HOST,) * 4))

    def _draw_tiles(self, host: moderngl.Framebuffer, buffers: Buffers) -> None:
        """Draw the smaller picture over the host's where the host has drawn nothing."""
        buffers.tiles.use(TILES_UNIT)
        columns, rows = buffers.tiles.size
        for sort, name in TILED.items():
            host.depth_mask = sort == DEEP
            self._run(name, everywhere=sort == FLAT, vertices=TILE_VERTICES * columns * rows)
        buffers.host_depth.use(TEXTURE_UNITS["host_depth"])

    def _find(self, host: moderngl.Framebuffer, buffers: Buffers) -> None:
        """Let the card find out whether the host has drawn anything with depth: mostly it has not."""
        scissor = host.scissor
        host.scissor, host.depth_mask = None, False  # type: ignore[assignment]
        self._bind(buffers)
        with colourless(host), self._has_drawn.asking():
            self._run("find")
        host.scissor = scissor if scissor != (0, 0, *host.size) else None  # type: ignore[assignment]
        host.depth_mask = True

    def _if_host_has_drawn(self, host: moderngl.Framebuffer) -> AbstractContextManager[None]:
        """Draw what is inside only if the host has drawn anything; always where nothing shows, to warm up drivers."""
        return self._has_drawn.if_so() if all(host.scissor[2:]) else nullcontext()

    def _bind(self, buffers: Buffers) -> None:
        """Bind buffers for the passes, and set the uniforms that depend on them."""
        buffers.use()
        small, ends = buffers.target.size, {"far_end": depth_ends()[1], "farthest": farthest_depth()}
        self._set_uniforms({"size": small, "texel": (1.0 / small[0], 1.0 / small[1]), **ends})

    def release(self) -> None:
        """Release programs, vertex arrays, buffers and the query."""
        programs = [each.program for each in self._passes.values()]
        release_all(*self._passes.values(), *programs, *self._buffers.values(), self._has_drawn)

    def _run(
        self, name: str, *, blending: tuple[int, int] | None = None, everywhere: bool = False, vertices: int = 3
    ) -> None:
        """Draw one of the passes, with its depth test unless `everywhere`."""
        ctx = self._ctx
        tested = moderngl.NOTHING if everywhere else moderngl.DEPTH_TEST
        ctx.enable_only(tested if blending is None else tested | moderngl.BLEND)
        ctx.blend_func = blending or (moderngl.ONE, moderngl.ZERO)
        set_depth_test(ctx, PASSES.get(name, "1"))
        self._passes[name].render(moderngl.TRIANGLES, vertices)
        set_depth_test(ctx, "<=")

    def make_ready(self) -> None:
        """Make the programs of the passes, at the first call."""
        for name in PASSES.keys() - self._passes.keys():
            self._add(name, program(self._ctx, "engine/gl/fill.vert", f"engine/gl/{name}.frag"))
        if self._by_tiles and TILED[FLAT] not in self._passes:
            self._add("sort", program(self._ctx, "engine/gl/fill.vert", "engine/gl/sort.frag"))
            for sort, name in TILED.items():
                defines = {"TILED": 1, "DEEP": 1} if sort == DEEP else {"TILED": 1}
                self._add(name, program(self._ctx, "engine/gl/tile.vert", "engine/gl/enlarge.frag", defines=defines))
                self._passes[name].program["sort"], self._passes[name].program["tiles"] = sort, TILES_UNIT
        self._set_uniforms(TEXTURE_UNITS)

    def _add(self, name: str, made: moderngl.Program) -> None:
        """Add the program of a pass."""
        self._passes[name] = self._ctx.vertex_array(made, [])
        self._uniforms.clear()

    def _is_obstructed(self, host: moderngl.Framebuffer) -> bool:
        """Return whether the host's framebuffer cannot be replaced by a smaller one; log the reason once."""
        obstacle = self._obstacle(host)
        if obstacle is not None and obstacle not in self._warned:
            self._warned.add(obstacle)
            log.warning("a framebuffer is drawn into with all its pixels, whatever it takes: it has %s", obstacle)
        return obstacle is not None

    def _obstacle(self, host: moderngl.Framebuffer) -> str | None:
        if self._gl.number("SAMPLES"):
            return "several samples a pixel"
        if host.glo and self._gl.number("DRAW_BUFFER0") == ENUMS["NONE"]:
            return "no colour"
        return None if has_depth(self._gl, host.glo) else "no depth"

    def _room(self, full: Size, small: Size) -> Buffers:
        """Return buffers for the sizes of the host's viewport and of the smaller picture [pixels]."""
        self.make_ready()
        found = self._buffers.pop((full, small), None)
        if found is None:
            if len(self._buffers) == MOST_SIZES:
                self._buffers.pop(next(iter(self._buffers))).release()
            found = Buffers.made(self._ctx, full, small, floats=self._floats)
        self._buffers[full, small] = found
        return found

    def _set_uniforms(self, values: Mapping[str, object]) -> None:
        """Set uniforms whose values have changed, in all programs that use them."""
        for name, value in values.items():
            if self._uniforms.get(name) != value:
                self._uniforms[name] = value
                for each in self._passes.values():
                    if name in each.program:
                        each.program[name] = value
