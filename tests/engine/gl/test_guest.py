"""A guest's manners: the host's framebuffer, and the host's state as it was (D6)."""

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from ctypes import addressof, c_int, c_int64
from types import SimpleNamespace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl import current
from tallgrass.engine.gl.current import own_context
from tallgrass.engine.gl.functions import ENUMS, functions_of
from tallgrass.engine.gl.guest import guest, saved_state
from tallgrass.engine.gl.host import LAYOUTS
from tallgrass.engine.gl.units import FIRST_UNIT

SIZE = (40, 30)
VERTEX = """#version 330
uniform float depth;
out vec2 at;
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 4.0 - 1.0;
    at = corner;
    gl_Position = vec4(corner, depth, 1.0);
}"""
FRAGMENT = """#version 330
uniform vec4 color;
out vec4 pixel;
void main() { pixel = color; }"""

Fill = Callable[..., None]


@pytest.fixture
def host(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    """Bound framebuffer of the host, with colour and depth, black and cleared to far."""
    color, depth = ctx.texture(SIZE, 4), ctx.depth_renderbuffer(SIZE)
    target = ctx.framebuffer([color], depth)
    target.use()
    ctx.enable_only(moderngl.NOTHING)
    target.clear(depth=1.0)
    yield target
    ctx.enable_only(moderngl.NOTHING)
    ctx.cull_face = "back"
    for thing in (target, color, depth):
        thing.release()


@pytest.fixture
def fill(ctx: moderngl.Context) -> Iterator[Fill]:
    """A host's drawing: one colour over all that viewport, scissor, masks and tests let through."""
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    array = ctx.vertex_array(program, [])

    def draw(*color: float, depth: float = 0.0) -> None:
        program["color"], program["depth"] = color, depth
        array.render(moderngl.TRIANGLES, 3)

    yield draw
    for thing in (array, program):
        thing.release()


def picture(target: moderngl.Framebuffer) -> NDArray[np.uint8]:
    width, height = SIZE
    return np.frombuffer(target.read(components=4), np.uint8).reshape(height, width, 4)


def misbehave(ctx: moderngl.Context, target: moderngl.Framebuffer, fill: Fill) -> None:
    """Change all GL state, as drawing that restores nothing would."""
    ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND | moderngl.CULL_FACE)
    ctx.cull_face = "front_and_back"
    target.depth_mask = False
    target.viewport = (1, 1, 3, 3)
    target.scissor = (2, 2, 1, 1)
    fill(1.0, 0.0, 0.0, 0.5, depth=0.9)


def test_d6_what_the_host_draws_next_looks_as_if_no_guest_had_been_there(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    fill(0.2, 0.4, 0.6, 0.8, depth=0.5)
    alone = picture(host)
    host.clear(depth=0.25)
    with guest(ctx) as target:
        misbehave(ctx, target, fill)
    fill(0.2, 0.4, 0.6, 0.8, depth=0.5)
    np.testing.assert_array_equal(picture(host), alone)


def test_d6_a_guest_draws_into_the_framebuffer_that_is_bound(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    with guest(ctx) as target:
        assert target.glo == host.glo
        assert target.viewport == (0, 0, *SIZE)
        fill(1.0, 1.0, 1.0, 1.0)
    assert (picture(host) == 255).all()
    assert ctx.detect_framebuffer().glo == host.glo


def test_d6_a_guest_draws_in_the_hosts_viewport_and_scissor(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    host.viewport, host.scissor = (8, 4, 20, 16), (0, 0, 16, 12)
    host.use()
    with guest(ctx) as target:
        assert target.viewport == (8, 4, 20, 16)
        fill(1.0, 1.0, 1.0, 1.0)
    lit = np.zeros(SIZE[::-1], np.bool_)
    lit[4:12, 8:16] = True
    np.testing.assert_array_equal(picture(host)[..., 0] == 255, lit)


def test_d6_viewport_scissor_and_masks_are_as_before_without_being_set_again(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    host.viewport, host.scissor = (8, 4, 20, 16), (0, 0, 16, 12)
    host.color_mask, host.depth_mask = (True, False, True, True), False
    host.use()
    with guest(ctx) as target:
        misbehave(ctx, target, fill)
    fill(1.0, 1.0, 1.0, 1.0, depth=-1.0)
    lit = picture(host)[4:12, 8:16]
    assert (lit == (255, 0, 255, 255)).all()
    assert (picture(host).reshape(-1, 4).sum(axis=0)[0]) == 255 * 64
    host.depth_mask, host.color_mask, host.scissor = True, (True,) * 4, None  # type: ignore[assignment]
    host.use()
    ctx.enable_only(moderngl.DEPTH_TEST)
    fill(0.0, 1.0, 0.0, 1.0, depth=0.99)
    assert (picture(host)[4:20, 8:28, 1] == 255).all(), "no depth was written while the host's mask forbade it"


def test_d6_a_guest_writes_the_colours_that_the_host_lets_it_and_depth_in_any_case(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    host.color_mask, host.depth_mask = (True, False, False, True), False
    host.use()
    with guest(ctx):
        ctx.enable_only(moderngl.DEPTH_TEST)
        fill(1.0, 1.0, 1.0, 1.0, depth=-0.5)
        fill(0.5, 0.5, 0.5, 0.5)
    assert (picture(host) == (255, 0, 0, 255)).all(), "the farther one is hidden"
    assert host.color_mask == (True, False, False, True)
    assert host.depth_mask is False


def test_d6_of_several_attachments_a_guest_writes_the_first_alone(ctx: moderngl.Context, fill: Fill) -> None:
    colors = [ctx.texture(SIZE, 4) for _ in range(3)]
    target = ctx.framebuffer(colors)
    target.color_mask = (True,) * 4, (True, False, True, False), (False,) * 4  # type: ignore[assignment]
    target.use()
    ctx.clear(0.2, 0.2, 0.2, 0.2)
    before = [color.read() for color in colors]
    with guest(ctx):
        fill(1.0, 1.0, 1.0, 1.0)
    assert set(colors[0].read()) == {255}
    assert [color.read() for color in colors[1:]] == before[1:]
    ctx.clear(1.0, 1.0, 1.0, 1.0)
    assert colors[1].read()[:4] == bytes((255, before[1][1], 255, before[1][3])), "the masks are the host's"
    target.release()
    for color in colors:
        color.release()


def test_d6_without_colour_a_guest_writes_depth(ctx: moderngl.Context, fill: Fill) -> None:
    depth = ctx.depth_texture(SIZE)
    target = ctx.framebuffer([], depth)
    target.use()
    target.clear(depth=1.0)
    with guest(ctx):
        ctx.enable_only(moderngl.DEPTH_TEST)
        fill(1.0, 1.0, 1.0, 1.0, depth=0.5)
    assert np.allclose(np.frombuffer(depth.read(), np.float32), 0.75)
    for thing in (target, depth):
        thing.release()


def test_d6_what_the_host_has_enabled_stays_enabled(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
    ctx.blend_func, ctx.depth_func = (moderngl.ONE, moderngl.ONE), "1"
    fill(0.2, 0.2, 0.2, 0.2, depth=-0.5)
    with guest(ctx) as target:
        misbehave(ctx, target, fill)
    fill(0.2, 0.2, 0.2, 0.2, depth=0.9)
    ctx.blend_func, ctx.depth_func = (moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA), "<"
    assert (picture(host)[5, 5] == 2 * 51).all()


@pytest.mark.parametrize("sets", ["glEnable", "glDisable"])
def test_d6_a_guest_draws_its_first_frame_under_the_switches_of_all_others(ctx: moderngl.Context, sets: str) -> None:
    """Otherwise a software rasteriser compiles all programs again for the second frame."""
    gl, switch = functions_of(ctx), ENUMS["TEXTURE_CUBE_MAP_SEAMLESS"]
    getattr(gl, sets)(switch)
    current._made.cache_clear()  # noqa: SLF001
    for _ in range(2):
        with saved_state(None):
            own_context()
            assert not gl.glIsEnabled(switch)
        assert bool(gl.glIsEnabled(switch)) is (sets == "glEnable")
    gl.glEnable(switch)


def test_d6_nothing_stays_enabled_as_pyglets_drawing_expects(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    with guest(ctx) as target:
        misbehave(ctx, target, fill)
    host.clear(depth=0.0)
    fill(0.5, 0.5, 0.5, 0.5, depth=0.5)
    half = 127.5
    assert (np.abs(picture(host).astype(float) - half) <= 1.0).all(), "neither tested, nor blended, nor culled"


def test_d6_the_state_is_given_back_when_drawing_fails(
    ctx: moderngl.Context, host: moderngl.Framebuffer, fill: Fill
) -> None:
    def fail() -> None:
        with guest(ctx) as target:
            misbehave(ctx, target, fill)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert host.viewport == (0, 0, *SIZE)
    fill(1.0, 1.0, 1.0, 1.0, depth=0.5)
    assert (picture(host) == 255).all()


def test_d6_textures_and_samplers_of_the_host_stay_where_they_are_and_off_a_guests(
    ctx: moderngl.Context, host: moderngl.Framebuffer
) -> None:
    texture = ctx.texture((2, 1), 1, b"\x00\xff")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    source = "#version 330\nuniform sampler2D t; out vec4 p; void main() { p = texture(t, vec2(0.45, 0.5)); }"
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=source)
    array, smooth = ctx.vertex_array(program, []), ctx.sampler(filter=(moderngl.LINEAR, moderngl.LINEAR))
    for unit in range(16):
        smooth.use(unit)
        texture.use(unit)
    with guest(ctx):
        texture.use(FIRST_UNIT)
        program["t"] = FIRST_UNIT
        array.render(moderngl.TRIANGLES, 3)
    assert (picture(host)[..., 0] == 0).all(), "the host's sampler smooths a guest's texture"
    for unit in range(16):
        host.clear()
        program["t"] = unit
        array.render(moderngl.TRIANGLES, 3)
        assert (picture(host)[..., 0] > 0).all(), f"the host's sampler or texture is gone from unit {unit}"
    ctx.clear_samplers(0, 16)
    for thing in (array, program, smooth, texture):
        thing.release()


@pytest.mark.parametrize("target", ["ARRAY_BUFFER", "UNIFORM_BUFFER", "COPY_READ_BUFFER", "COPY_WRITE_BUFFER"])
def test_d6_buffers_of_the_host_stay_bound_while_a_guest_fills_and_copies_its_own(
    ctx: moderngl.Context, host: moderngl.Framebuffer, target: str
) -> None:
    hosts, gl, found = ctx.buffer(reserve=16), functions_of(ctx), c_int()
    gl.glBindBuffer(ENUMS[target], hosts.glo)
    with guest(ctx) as drawn_into:
        assert drawn_into.glo == host.glo
        one, two = ctx.buffer(b"tall"), ctx.buffer(reserve=4)
        ctx.copy_buffer(two, one)
    gl.glGetIntegerv(ENUMS[f"{target}_BINDING"], addressof(found))
    gl.glBindBuffer(ENUMS[target], 0)
    assert found.value == hosts.glo
    for buffer in (hosts, one, two):
        buffer.release()


@pytest.mark.parametrize("store", LAYOUTS)
def test_d6_however_the_host_lays_texels_out_a_guest_loads_and_reads_its_own_as_they_are(
    ctx: moderngl.Context, host: moderngl.Framebuffer, store: str
) -> None:
    texels = np.random.default_rng(1).integers(0, 2**16, (3, 4, 5), np.uint16)
    number, gl, found = ENUMS[store], functions_of(ctx), c_int()
    value = 1 if store.endswith(("SWAP_BYTES", "LSB_FIRST")) else 2
    read = [bytearray(4 * texels.nbytes) for _ in range(2)]
    gl.glPixelStorei(number, value)
    try:
        with guest(ctx) as target:
            assert target.glo == host.glo
            image = ctx.texture((5, 12), 1, texels.tobytes(), dtype="u2", alignment=1)
            layers = ctx.texture_array((5, 4, 3), 1, texels.tobytes(), dtype="u2", alignment=1)
            image.read_into(read[0], alignment=1)
            layers.read_into(read[1], alignment=1)
        gl.glGetIntegerv(number, addressof(found))
    finally:
        gl.glPixelStorei(number, 0)
    assert read == [texels.tobytes() + bytes(3 * texels.nbytes)] * 2
    assert found.value == value
    for thing in (image, layers):
        thing.release()


def test_d6_the_hosts_primitive_restart_takes_no_vertex_from_a_guest(
    ctx: moderngl.Context, host: moderngl.Framebuffer
) -> None:
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    indices = ctx.buffer(np.arange(3, dtype=np.uint32))
    array, gl = ctx.vertex_array(program, [], index_buffer=indices), functions_of(ctx)
    program["color"] = (1.0, 1.0, 1.0, 1.0)
    gl.glEnable(ENUMS["PRIMITIVE_RESTART"])
    gl.glPrimitiveRestartIndex(2)
    try:
        with guest(ctx):
            array.render(moderngl.TRIANGLES)
        assert gl.glIsEnabled(ENUMS["PRIMITIVE_RESTART"])
    finally:
        gl.glPrimitiveRestartIndex(-1)
    assert (picture(host) == 255).all()
    for thing in (array, indices, program):
        thing.release()


@pytest.mark.parametrize("span", [(0, 0), (32, 64)], ids=["whole", "part"])
def test_d6_where_the_host_captures_outputs_to_is_bound_again_after_a_guest_has_captured_its_own(
    ctx: moderngl.Context, host: moderngl.Framebuffer, span: tuple[int, int]
) -> None:
    source = "#version 330\nout float seen; void main() { seen = float(gl_VertexID); }"
    program, gl = ctx.program(vertex_shader=source, varyings=("seen",)), functions_of(ctx)
    array, goal, bound, other = (ctx.vertex_array(program, []), *(ctx.buffer(reserve=256) for _ in range(3)))
    target, place = ENUMS["TRANSFORM_FEEDBACK_BUFFER"], ENUMS["TRANSFORM_FEEDBACK_BUFFER_BINDING"]
    if span[1]:
        gl.glBindBufferRange(target, 0, bound.glo, *span)
    else:
        gl.glBindBufferBase(target, 0, bound.glo)
    gl.glBindBuffer(target, other.glo)
    with guest(ctx) as drawn:
        assert drawn.glo == host.glo
        array.transform(goal, moderngl.POINTS, vertices=3)
    found, wide = (c_int * 2)(), (c_int64 * 2)()
    gl.glGetIntegeri_v(place, 0, addressof(found))
    gl.glGetIntegerv(place, addressof(found) + 4)
    gl.glGetInteger64i_v(ENUMS["TRANSFORM_FEEDBACK_BUFFER_START"], 0, addressof(wide))
    gl.glGetInteger64i_v(ENUMS["TRANSFORM_FEEDBACK_BUFFER_SIZE"], 0, addressof(wide) + 8)
    assert found[:] == [bound.glo, other.glo]
    assert tuple(wide) == span
    assert goal.read(12) == np.arange(3, dtype=np.float32).tobytes()
    gl.glBindBufferBase(target, 0, 0)
    for thing in (array, program, goal, bound, other):
        thing.release()


@pytest.mark.parametrize("sort", ["buffer", "array", "captured", "texture", "sampler", "renderbuffer"])
def test_d6_what_was_bound_and_is_deleted_while_a_guest_draws_is_no_error(ctx: moderngl.Context, sort: str) -> None:
    program = ctx.program(vertex_shader="#version 330\nout float seen; void main() { seen = 1.0; }", varyings=("seen",))
    array, buffer = ctx.vertex_array(program, []), ctx.buffer(reserve=16)
    array.transform(buffer, moderngl.POINTS, vertices=1)
    things: dict[str, Callable[[], Any]] = {
        "buffer": lambda: ctx.buffer(reserve=16), "array": lambda: array, "captured": lambda: buffer,
        "texture": lambda: ctx.texture((2, 2), 4), "sampler": ctx.sampler,
        "renderbuffer": lambda: ctx.depth_renderbuffer((2, 2)),
    }  # fmt: skip
    thing = things[sort]()
    if sort == "sampler":
        thing.use(FIRST_UNIT)
    with guest(ctx):
        thing.release()
    assert ctx.error == "GL_NO_ERROR"


def test_d6_pyglet_is_never_loaded_for_a_host_that_does_without(
    ctx: moderngl.Context, host: moderngl.Framebuffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == "pyglet"]:
        monkeypatch.delitem(sys.modules, name)
    with guest(ctx) as target:
        assert target.glo == host.glo
    assert not any(name.split(".")[0] == "pyglet" for name in sys.modules)


def test_n4_a_context_that_was_released_is_refused_in_a_sentence() -> None:
    released: Any = SimpleNamespace(mglo=moderngl.InvalidObject())
    with (
        pytest.raises(RuntimeError, match=r"^the moderngl context of this prairie was released"),
        saved_state(released),
    ):
        pass


def test_n4_a_thread_without_a_context_is_refused_in_a_sentence(ctx: moderngl.Context) -> None:
    def draw() -> None:
        with saved_state(ctx):
            pass

    with ThreadPoolExecutor(1) as other, pytest.raises(RuntimeError, match=r"^no GL context is current in this thread"):
        other.submit(draw).result()
    draw()
