"""Drawing with fewer pixels than the host has (N11)."""

import logging
from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.gl import rasteriser
from tallgrass.engine.gl.guest import guest
from tallgrass.engine.gl.smaller import MOST_SIZES, Smaller, smaller_size
from tallgrass.engine.gl.stream import release_all

SIZE = (40, 30)
VERTEX = """#version 330
uniform vec4 box;
uniform float depth;
void main() {
    vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(mix(box.xy, box.zw, corner), depth, 1.0);
}"""
FRAGMENT = """#version 330
uniform vec4 color;
out vec4 pixel;
void main() { pixel = color; }"""
ALL = (-1.0, -1.0, 1.0, 1.0)
LEFT = (-1.0, -1.0, 0.0, 1.0)
RED, GREEN, HALF_BLUE = (1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.0, 0.0, 0.5, 0.5)

Fill = Callable[..., None]


class Host:
    """A framebuffer with colour and depth that can be read."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.target.use()
        self.target.clear(depth=1.0)

    def picture(self) -> NDArray[np.uint8]:
        return np.frombuffer(self.color.read(), np.uint8).reshape(SIZE[1], SIZE[0], 4)

    def depths(self) -> NDArray[np.float32]:
        return np.frombuffer(self.depth.read(alignment=1), np.float32).reshape(SIZE[1], SIZE[0])


@pytest.fixture
def host(ctx: moderngl.Context) -> Iterator[Host]:
    made = Host(ctx)
    yield made
    ctx.enable_only(moderngl.NOTHING)
    release_all(made.target, made.color, made.depth)


@pytest.fixture(params=["software", "card"])
def smaller(
    ctx: moderngl.Context, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> Iterator[Smaller]:
    if request.param == "card":
        monkeypatch.setenv(rasteriser.AS_CARD, "1")
    made = Smaller(ctx)
    yield made
    made.release()


@pytest.fixture
def fill(ctx: moderngl.Context) -> Iterator[Fill]:
    """Fill a box in normalised coordinates with a colour, at a depth from -1 to 1; it is tested, and blended."""
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    array = ctx.vertex_array(program, [])

    def draw(color: tuple[float, ...], box: tuple[float, ...] = ALL, depth: float = 0.0) -> None:
        ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        program["color"], program["box"], program["depth"] = color, box, depth
        array.render(moderngl.TRIANGLE_STRIP, 4)

    yield draw
    release_all(array, program)


@pytest.mark.parametrize("scale", [0.35, 0.5, 0.77])
def test_n11_what_is_drawn_smaller_fills_the_hosts_viewport_and_is_as_deep(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, scale: float
) -> None:
    with guest(ctx) as target, smaller.instead_of(target, scale) as small:
        assert small.size == smaller_size(SIZE, scale)
        fill(RED, depth=0.5)
    assert (host.picture() == (255, 0, 0, 255)).all()
    np.testing.assert_allclose(host.depths(), 0.75, atol=1e-6)


@pytest.mark.parametrize("left", [-1.0, -0.3, 0.5, 0.9])
def test_n11_depth_is_written_where_the_smaller_picture_has_any_and_nowhere_else(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, left: float
) -> None:
    with guest(ctx) as target, smaller.instead_of(target, 0.5):
        fill(RED, depth=1.0)
        fill(GREEN, (left, 0.2, left + 0.1, 0.6), depth=0.5)
    assert (host.picture()[..., :2].max(axis=-1) > 100).all()
    expected = np.ones(SIZE[::-1], np.float32)
    column = round(0.25 * SIZE[0] * (left + 1.0)) * 2
    expected[18:24, column : column + 2] = 0.75
    np.testing.assert_allclose(host.depths(), expected, atol=1e-6)


@pytest.mark.parametrize("scale", [0.35, 0.5, 0.77])
def test_n11_what_the_host_has_drawn_nearer_stays_pixel_by_pixel(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, scale: float
) -> None:
    edge = 0.125  # between two of the smaller picture's pixels at some scale
    fill(GREEN, (-1.0, -1.0, edge, 1.0), depth=-0.5)
    before = host.depths()
    with guest(ctx) as target, smaller.instead_of(target, scale):
        fill(RED, depth=0.5)
    green = before < 0.5
    assert (host.picture()[green] == (0, 255, 0, 255)).all()
    assert (host.picture()[~green] == (255, 0, 0, 255)).all()
    np.testing.assert_array_equal(host.depths()[green], before[green])
    far = np.arange(SIZE[0]) > np.flatnonzero(~green[0])[0] + 1.0 / scale
    np.testing.assert_allclose(host.depths()[:, far], 0.75, atol=1e-6)


def test_n11_what_is_nearer_than_the_hosts_hides_it_and_is_deeper_than_nothing(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill
) -> None:
    fill(GREEN, LEFT, depth=0.8)
    with guest(ctx) as target, smaller.instead_of(target, 0.5):
        fill(RED, depth=0.5)
    assert (host.picture() == (255, 0, 0, 255)).all()
    np.testing.assert_allclose(host.depths(), 0.75, atol=1e-6)


def test_n11_what_is_half_transparent_lets_the_hosts_through(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill
) -> None:
    fill(GREEN, LEFT, depth=-0.5)
    before = host.depths()
    with guest(ctx) as target, smaller.instead_of(target, 0.5) as small:
        fill(RED, depth=0.5)
        small.depth_mask = False
        fill(HALF_BLUE, depth=-0.9)
    left, off = before < 0.5, host.picture().astype(int)
    off -= np.where(left[..., None], (0, 128, 128, 255), (128, 0, 128, 255))
    assert np.abs(off).max() <= 24, "beside an edge, filtered and sharpened"
    assert np.abs(np.delete(off, range(16, 24), axis=1)).max() <= 1
    np.testing.assert_array_equal(host.depths()[left], before[left])


@pytest.mark.parametrize("is_whole", [True, False])
def test_n11_where_nothing_else_has_depth_the_hosts_is_neither_read_nor_written(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, *, is_whole: bool
) -> None:
    fill(GREEN, LEFT, depth=-0.5)
    before, middle = host.depths(), SIZE[1] // 2
    with guest(ctx) as target, smaller.instead_of(target, 0.5, is_whole=is_whole, is_alone=True):
        fill(RED, ALL if is_whole else (-1.0, -1.0, 1.0, 0.0), depth=0.5)
    upper = host.picture()[middle + 2 :]
    assert (host.picture()[: middle - 2] == (255, 0, 0, 255)).all()
    if is_whole:
        assert (upper == (255, 0, 0, 255)).all()
    else:
        assert (upper[:, : SIZE[0] // 2] == (0, 255, 0, 255)).all()
        assert (upper[:, SIZE[0] // 2 :] == 0).all()
    np.testing.assert_array_equal(host.depths(), before)


OVER_TILES = 2 * 2 * 2
"""Triangles of both passes over the two tiles of a small picture."""


@pytest.mark.parametrize("smaller", ["card"], indirect=True)
@pytest.mark.parametrize("passes", [2, 6], ids=["nothing", "something"])
def test_n11_a_card_brings_nothing_over_and_fits_nothing_where_the_host_has_drawn_nothing(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, passes: int
) -> None:
    if passes > 2:
        fill(GREEN, (0.9, 0.9, 1.0, 1.0), depth=0.8)
    host.target.scissor = 0, 0, 10, 10  # which that is beside
    host.target.use()
    counted = ctx.query(primitives=True)
    with guest(ctx) as target, counted, smaller.instead_of(target, 0.5):
        pass
    assert counted.primitives == passes + OVER_TILES


@pytest.mark.parametrize("smaller", ["card"], indirect=True)
def test_n11_where_nothing_is_shown_all_passes_are_done_so_that_drivers_get_ready(
    ctx: moderngl.Context, host: Host, smaller: Smaller
) -> None:
    counted = ctx.query(primitives=True)
    host.target.use()
    with guest(ctx) as target, counted:
        target.scissor = 0, 0, 0, 0
        with smaller.instead_of(target, 0.5):
            pass
    assert counted.primitives == 6 + OVER_TILES


def test_n11_it_keeps_to_the_hosts_viewport_scissor_and_colours(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill
) -> None:
    host.target.viewport, host.target.scissor = (8, 4, 20, 16), (0, 0, 16, 12)
    host.target.color_mask = True, False, True, True
    host.target.use()
    with guest(ctx) as target, smaller.instead_of(target, 0.5) as small:
        assert small.size == (10, 8)
        fill((1.0, 1.0, 1.0, 1.0))
    lit = np.zeros(SIZE[::-1], np.bool_)
    lit[4:12, 8:16] = True
    np.testing.assert_array_equal(host.picture()[..., 0] == 255, lit)
    assert (host.picture()[..., 1] == 0).all()
    assert (host.target.viewport, host.target.scissor) == ((8, 4, 20, 16), (0, 0, 16, 12))


def test_n11_what_the_host_draws_next_looks_as_if_nothing_had_been_there(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill
) -> None:
    host.target.depth_mask = False
    host.target.use()
    fill(HALF_BLUE, depth=0.9)
    alone = host.picture()
    host.target.clear(depth=1.0)
    with guest(ctx) as target, smaller.instead_of(target, 0.5):
        pass
    fill(HALF_BLUE, depth=0.9)
    np.testing.assert_array_equal(host.picture(), alone)


@pytest.mark.parametrize("counted", ["samples", "any_samples"])
def test_n11_a_host_may_count_meanwhile_which_pixels_pass(
    ctx: moderngl.Context, host: Host, smaller: Smaller, fill: Fill, counted: str
) -> None:
    fill(GREEN, LEFT, depth=-0.5)
    query = ctx.query(samples=counted == "samples", any_samples=counted == "any_samples")
    with query, guest(ctx) as target, smaller.instead_of(target, 0.5):
        fill(RED, depth=0.5)
    assert ctx.error == "GL_NO_ERROR"
    assert counted == "any_samples" or query.samples > 0
    assert (host.picture()[:, 2:18] == (0, 255, 0, 255)).all()
    assert (host.picture()[:, 22:] == (255, 0, 0, 255)).all()


def test_at_full_scale_the_hosts_framebuffer_is_given_itself(
    ctx: moderngl.Context, host: Host, smaller: Smaller
) -> None:
    with guest(ctx) as target, smaller.instead_of(target, 1.0) as small:
        assert small is target
        assert small.glo == host.target.glo


@pytest.mark.parametrize("what", ["several samples a pixel", "no depth", "no colour"])
def test_where_nothing_can_stand_in_for_it_the_hosts_is_given_and_this_is_told_once(
    ctx: moderngl.Context, smaller: Smaller, caplog: pytest.LogCaptureFixture, what: str
) -> None:
    samples = 4 if what == "several samples a pixel" else 0
    colors = [] if what == "no colour" else [ctx.renderbuffer(SIZE, 4, samples=samples)]
    depth = None if what == "no depth" else ctx.depth_renderbuffer(SIZE, samples=samples)
    target = ctx.framebuffer(colors, depth)
    target.use()
    with caplog.at_level(logging.WARNING, "tallgrass"):
        for _ in range(2):
            with guest(ctx) as found, smaller.instead_of(found, 0.5) as small:
                assert small.glo == target.glo
    assert [record.message for record in caplog.records] == [
        f"a framebuffer is drawn into with all its pixels, whatever it takes: it has {what}"
    ]
    release_all(target, *colors, *([] if depth is None else [depth]))


def test_buffers_of_the_last_sizes_alone_are_kept(ctx: moderngl.Context, host: Host, smaller: Smaller) -> None:
    made = []
    for number in [*range(10), 8]:
        with guest(ctx) as target, smaller.instead_of(target, 0.4 + 0.05 * number) as small:
            made.append(small)
    assert made[-1] is made[-3]
    assert sum(not isinstance(each.mglo, moderngl.InvalidObject) for each in made[:-1]) == MOST_SIZES
    assert (host.picture() == 0).all()
