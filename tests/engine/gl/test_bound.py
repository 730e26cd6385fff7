"""A guest in framebuffers of a host that makes, resizes and deletes them, and with whatever it has enabled (D6)."""

import gc
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import CFUNCTYPE, addressof, c_int, c_ubyte, c_uint

import moderngl
import numpy as np
import pytest

from tallgrass.engine.gl.current import own_context
from tallgrass.engine.gl.functions import ENUMS, functions_of
from tallgrass.engine.gl.guest import aside, guest
from tallgrass.engine.gl.host import SWITCHED_OFF

Size = tuple[int, int]
SMALL, LARGE = (16, 12), (40, 30)


@contextmanager
def framebuffer(ctx: moderngl.Context, size: Size, attachments: int = 1) -> Iterator[moderngl.Framebuffer]:
    """Make, clear and bind a framebuffer; release it and its textures in the end."""
    colors = [ctx.texture(size, 4) for _ in range(attachments)]
    made = ctx.framebuffer(colors)
    made.use()
    made.clear()
    yield made
    made.release()
    for color in colors:
        color.release()


def white(ctx: moderngl.Context) -> None:
    """Fill what viewport and scissor box of the bound framebuffer let through."""
    program = ctx.program(
        vertex_shader="""#version 330
        void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }""",
        fragment_shader="""#version 330
        out vec4 pixel;
        void main() { pixel = vec4(1.0); }""",
    )
    array = ctx.vertex_array(program, [])
    array.render(moderngl.TRIANGLES, 3)
    array.release()
    program.release()


def test_d6_frames_in_framebuffers_leave_no_memory_taken(ctx: moderngl.Context) -> None:
    frames = 400
    with framebuffer(ctx, SMALL) as first, framebuffer(ctx, LARGE) as second:

        def draw() -> None:
            for target in (first, second):
                target.use()
                with guest(ctx):
                    pass

        draw()
        tracemalloc.start()
        for _ in range(10):
            draw()
        gc.collect()
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(frames):
            draw()
        gc.collect()
        grown = tracemalloc.get_traced_memory()[0] - before
        tracemalloc.stop()
    assert grown < 100 * frames, "moderngl keeps some 400 bytes whenever it is asked for a framebuffer"


@pytest.mark.parametrize("before", [1, 2])
def test_d6_a_framebuffer_that_was_given_other_textures_is_drawn_as_it_is_now(
    ctx: moderngl.Context, before: int
) -> None:
    gl, mask, own = functions_of(ctx), (c_ubyte * 4)(), own_context()
    attach = CFUNCTYPE(None, *(c_int,) * 5)(ctx.mglo._context.load_opengl_function("glFramebufferTexture2D"))  # noqa: SLF001
    with framebuffer(ctx, SMALL, attachments=before) as target:
        with guest(own) as seen:
            was = seen.size
        size = was[0] + 8, was[1] + 4
        larger = ctx.texture(size, 4, bytes(4 * size[0] * size[1]))
        for output, texture in enumerate((larger.glo, 0)):
            attach(ENUMS["FRAMEBUFFER"], ENUMS["COLOR_ATTACHMENT0"] + output, ENUMS["TEXTURE_2D"], texture, 0)
        gl.glDrawBuffers(1, (c_uint * 1)(ENUMS["COLOR_ATTACHMENT0"]))
        target.viewport, target.scissor = (0, 0, *size), (0, 0, *was)
        gl.glColorMaski(1, 0, 1, 0, 1)
        with guest(own) as seen:
            with aside(own, seen):
                pass
            white(ctx)
        gl.glGetBooleani_v(ENUMS["COLOR_WRITEMASK"], 1, addressof(mask))
        gl.glColorMaski(1, 1, 1, 1, 1)
    lit = np.frombuffer(larger.read(), np.uint8).reshape(*size[::-1], 4)
    larger.release()
    assert (lit[: was[1], : was[0]] == 255).all()
    assert lit.any(axis=2).sum() == was[0] * was[1], "it stays in the host's box, of the size that was"
    assert mask[:] == [0, 1, 0, 1], "a second output that has no attachment is left as it is"


@pytest.mark.parametrize("switch", sorted({*SWITCHED_OFF, "POLYGON_SMOOTH"}))  # cards smooth edges into seams
def test_d6_what_would_change_a_guests_picture_is_off_meanwhile_and_then_as_the_host_left_it(
    ctx: moderngl.Context, switch: str
) -> None:
    gl, number = functions_of(ctx), ENUMS[switch]
    with framebuffer(ctx, SMALL):
        for turn, is_on in ((gl.glEnable, True), (gl.glDisable, False)):
            turn(number)
            with guest(ctx):
                assert not gl.glIsEnabled(number)
            assert bool(gl.glIsEnabled(number)) == is_on
