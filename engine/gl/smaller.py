"""Drawing with fewer pixels than the host has: into a buffer of one's own, which is filtered up into the host's."""

import logging
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from ctypes import c_float
from dataclasses import dataclass

import moderngl

from .functions import NUMBERS, functions_of
from .guest import aside, colourless, depth_ends, farthest_depth, set_depth_test
from .occlusion import OcclusionQuery
from .outputs import has_depth
from .shaders import program
from .stream import release_all
from .units import UNITS

log = logging.getLogger("tallgrass")

Size = tuple[int, int]

OVER = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
"""How what is drawn lies over what was there: colours come multiplied by their opacity."""

MOST_SIZES = 4
"""Sizes whose buffers are kept: a viewer's last and present one, and another viewer's."""

PLACES = dict(zip(("before", "picture", "deep"), UNITS[-3:], strict=True))
"""Texture units: the last, as what stands there is bound anew whenever it is read."""

PASSES = {"find": ">", "bring": "1", "fit": ">", "deepen": "<", "enlarge": "1", "lay": "1"}
"""What is done, and by which test of depth: to find out whether the host has drawn anything; to bring its depth over;
to blend the picture over what it has drawn, and write its depth there; to write both where it has drawn nothing. The
first and the third are as far away as can be. Or, where nothing else has depth, to lay the picture over all."""


def smaller_size(size: Size, scale: float, /) -> Size:
    """Return a picture's size [pixels] with `scale` times as many pixels across and up, at least one."""
    width, height = size
    return max(1, round(width * scale)), max(1, round(height * scale))


@dataclass(frozen=True, slots=True, eq=False)
class Buffers:
    """What is drawn into, and the host's depth beside it."""

    before: moderngl.Texture
    picture: moderngl.Texture
    deep: moderngl.Texture
    target: moderngl.Framebuffer

    @classmethod
    def made(cls, ctx: moderngl.Context, full: Size, small: Size, /, *, floats: bool = False) -> "Buffers":
        """Return new ones for a viewport and a picture of these sizes [pixels]."""
        before, picture, deep = (
            ctx.depth_texture(full),
            ctx.texture(small, 4, dtype="f2" if floats else "f1"),
            ctx.depth_texture(small),
        )
        for texture in (before, picture, deep):
            texture.repeat_x = texture.repeat_y = False
        for depth in (before, deep):
            depth.compare_func, depth.filter = "", (moderngl.NEAREST, moderngl.NEAREST)
        return cls(before, picture, deep, ctx.framebuffer([picture], deep))

    def use(self) -> None:
        """Bind what is read where the passes read it."""
        self.before.use(PLACES["before"])
        self.picture.use(PLACES["picture"])
        self.deep.use(PLACES["deep"])

    def release(self) -> None:
        """Give everything back."""
        release_all(self.target, self.before, self.picture, self.deep)


class Smaller:
    """A buffer that a guest draws into in place of the host's framebuffer, with fewer pixels.

    There is none before it is needed, and one for each of the last sizes.
    """

    def __init__(self, ctx: moderngl.Context, *, floats: bool = False) -> None:
        self._ctx, self._gl, self._floats = ctx, functions_of(ctx), floats
        self._programs: dict[str, moderngl.Program] = {}
        self._passes: dict[str, moderngl.VertexArray] = {}
        self._buffers: dict[tuple[Size, Size], Buffers] = {}
        self._has_host = OcclusionQuery(ctx)
        self._told: dict[str, object] = {}
        """What the programs have been told last, by name."""
        self._warned: set[str] = set()

    @contextmanager
    def instead_of(
        self, host: moderngl.Framebuffer, scale: float, *, is_whole: bool = True, is_alone: bool = False
    ) -> Iterator[moderngl.Framebuffer]:
        """Give a framebuffer with `scale` times as many pixels, across and up, in which the host's depth stands.

        In the end, what was drawn there lies over the host's picture, and the host's depth is that of what is nearer.
        The host's framebuffer must be bound as `guest` binds it. It is given itself where `scale` is 1, and where
        another one cannot stand in for it, which is told once. One that `is_whole` is opaque where the host has drawn
        nothing; any other lets through what is behind it there too. Where nothing but this `is_alone` with depth, the
        host's is neither read nor written.
        """
        if scale >= 1.0 or self._is_obstructed(host):
            yield host
            return
        x, y, width, height = host.viewport
        buffers = self._room((width, height), smaller_size((width, height), scale))
        if not is_alone:
            self._find(host, buffers)
        with aside(self._ctx, host, alike=True):
            if not is_alone:  # where it is read, it is still bound
                self._gl.glActiveTexture(NUMBERS["TEXTURE0"] + PLACES["before"])
                self._gl.glCopyTexSubImage2D(NUMBERS["TEXTURE_2D"], 0, 0, 0, x, y, width, height)
            buffers.target.depth_mask = True
            buffers.target.scissor = None  # type: ignore[assignment]
            buffers.target.use()
            self._clear()
            if not is_alone:
                with self._where_host(host), colourless(buffers.target):
                    self._do("bring")
            yield buffers.target
        self._enlarge(host, buffers, is_whole=is_whole, is_alone=is_alone)

    def _enlarge(self, host: moderngl.Framebuffer, buffers: Buffers, *, is_whole: bool, is_alone: bool) -> None:
        """Lay what was drawn over the host's picture."""
        x, y = host.viewport[:2]
        self._read(buffers)
        host.depth_mask = False
        if is_alone:
            self._do("lay", blending=None if is_whole else OVER, everywhere=True)
            host.depth_mask = True
            return
        self._tell({"whole": is_whole, "corner": (x, y)})
        with self._where_host(host) if is_whole else nullcontext():
            self._do("fit", blending=OVER, everywhere=not is_whole)
            host.depth_mask = True
            with colourless(host):
                self._do("deepen")
        if is_whole:
            self._do("enlarge")

    def _find(self, host: moderngl.Framebuffer, buffers: Buffers) -> None:
        """Let the card find out whether the host has drawn anything with depth: mostly it has not."""
        cut = host.scissor
        host.scissor, host.depth_mask = None, False  # type: ignore[assignment]
        self._read(buffers)
        with colourless(host), self._has_host.asking():
            self._do("find")
        host.scissor = cut if cut != (0, 0, *host.size) else None  # type: ignore[assignment]
        host.depth_mask = True

    def _where_host(self, host: moderngl.Framebuffer) -> AbstractContextManager[None]:
        """Leave out what is drawn meanwhile if it has not; where nothing is shown, drivers are to get ready for it."""
        return self._has_host.if_so() if all(host.scissor[2:]) else nullcontext()

    def _read(self, buffers: Buffers) -> None:
        """Let the passes read these."""
        buffers.use()
        small, ends = buffers.target.size, {"far_end": depth_ends()[1], "farthest": farthest_depth()}
        self._tell({"size": small, "unit": (1.0 / small[0], 1.0 / small[1]), **ends})

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._passes.values(), *self._programs.values(), *self._buffers.values(), self._has_host)

    def _clear(self) -> None:
        """Clear what is drawn into: by calls that leave the values alone which a host clears with."""
        for what, values in (("COLOR", (0.0,) * 4), ("DEPTH", (farthest_depth(),))):
            self._gl.glClearBufferfv(NUMBERS[what], 0, (c_float * len(values))(*values))

    def _do(self, name: str, *, blending: tuple[int, int] | None = None, everywhere: bool = False) -> None:
        """Do one of the passes, where its test of depth says or `everywhere`."""
        ctx = self._ctx
        tested = moderngl.NOTHING if everywhere else moderngl.DEPTH_TEST
        ctx.enable_only(tested if blending is None else tested | moderngl.BLEND)
        ctx.blend_func = blending or (moderngl.ONE, moderngl.ZERO)
        set_depth_test(ctx, PASSES[name])
        self._passes[name].render(moderngl.TRIANGLES, 3)
        set_depth_test(ctx, "<=")

    def make_ready(self) -> None:
        """Make its programs, unless they are there."""
        for name in PASSES.keys() - self._passes.keys():
            self._programs[name] = program(self._ctx, "engine/gl/fill.vert", f"engine/gl/{name}.frag")
            self._passes[name] = self._ctx.vertex_array(self._programs[name], [])
            self._told.clear()
        self._tell(PLACES)

    def _is_obstructed(self, host: moderngl.Framebuffer) -> bool:
        """Return whether nothing can stand in for the host's framebuffer, and tell it once."""
        obstacle = self._obstacle(host)
        if obstacle is not None and obstacle not in self._warned:
            self._warned.add(obstacle)
            log.warning("a framebuffer is drawn into with all its pixels, whatever it takes: it has %s", obstacle)
        return obstacle is not None

    def _obstacle(self, host: moderngl.Framebuffer) -> str | None:
        if self._gl.number("SAMPLES"):
            return "several samples a pixel"
        if host.glo and self._gl.number("DRAW_BUFFER0") == NUMBERS["NONE"]:
            return "no colour"
        return None if has_depth(self._gl, host.glo) else "no depth"

    def _room(self, full: Size, small: Size) -> Buffers:
        """Return buffers for a viewport and a picture of these sizes."""
        self.make_ready()
        found = self._buffers.pop((full, small), None)
        if found is None:
            if len(self._buffers) == MOST_SIZES:
                self._buffers.pop(next(iter(self._buffers))).release()
            found = Buffers.made(self._ctx, full, small, floats=self._floats)
        self._buffers[full, small] = found
        return found

    def _tell(self, values: Mapping[str, object]) -> None:
        """Tell all programs that ask for it what is another than before."""
        for name, value in values.items():
            if self._told.get(name) != value:
                self._told[name] = value
                for each in self._programs.values():
                    if name in each:
                        each[name] = value
