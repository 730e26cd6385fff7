"""Reversed depth, as of a host that compares by `GL_GREATER` (D6)."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from ctypes import c_double
from dataclasses import dataclass

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Footprint
from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.functions import convention, functions_of
from tallgrass.engine.gl.host import DEFAULT_CLIP
from tallgrass.engine.gl.limits import limits_of
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Numbers = NDArray[np.float64]

STILL = LITTLE + "light: { elevation: 40 }\n"
FEWER = LITTLE + "  pixels: 0.6\nlight: { elevation: 40 }\n"
FROM_ZERO = DEFAULT_CLIP[0], 0x935F
"""`GL_ZERO_TO_ONE`."""

NEAR, FAR = 0.1, 5000.0
"""Near and far plane of a stage's projection [m]."""

VERTEX = """#version 330
in vec3 at;
uniform mat4 clip;
void main() { gl_Position = clip * vec4(at, 1.0); }"""
FRAGMENT = """#version 330
out vec4 pixel;
void main() { pixel = vec4(1.0, 0.0, 0.6, 1.0); }"""


@dataclass(frozen=True)
class Way:
    """A host's kind of depth, derived from a usual projection."""

    projection: Callable[[Numbers], Numbers]
    away: Callable[[Numbers], Numbers]
    """Returns distances from depths [m]."""

    control: tuple[int, int] = DEFAULT_CLIP
    range: tuple[float, float] = (0.0, 1.0)
    farthest: float = 0.0


def away(depth: Numbers) -> Numbers:
    """Return distances from usual depths [m]."""
    return FAR * NEAR / (FAR - depth * (FAR - NEAR))


def infinite(projection: Numbers) -> Numbers:
    return np.vstack([projection[:2], [[0.0, 0.0, 0.0, NEAR]], projection[3:]])


USUAL = Way(lambda projection: projection, away, farthest=1.0)
TURNED = Way(lambda projection: np.diag([1.0, 1.0, -1.0, 1.0]) @ projection, lambda depth: away(1.0 - depth))
INFINITE = Way(infinite, lambda depth: NEAR / np.maximum(depth, 1e-9), control=FROM_ZERO)
RANGE = Way(lambda projection: projection, lambda depth: away(1.0 - depth), range=(1.0, 0.0))


@pytest.fixture(scope="module")
def walls(ctx: moderngl.Context) -> Iterator[moderngl.VertexArray]:
    """Two walls of a host, one in the near grass and one farther off."""
    corners = [
        *((x, y, 16.0) for x, y in ((-4, -9), (-1, -9), (-4, 9), (-4, 9), (-1, -9), (-1, 9))),
        *((x, y, -6.0) for x, y in ((4, -9), (14, -9), (4, 9), (4, 9), (14, -9), (14, 9))),
    ]
    program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
    buffer = ctx.buffer(np.array(corners, np.float32))
    array = ctx.vertex_array(program, [(buffer, "3f", "at")])
    yield array
    for each in (array, buffer, program):
        each.release()


@contextmanager
def having(ctx: moderngl.Context, way: Way) -> Iterator[None]:
    """Set a host's kind of depth meanwhile."""
    gl = functions_of(ctx)
    range_ = convention(None, c_double, c_double)(ctx.mglo._context.load("glDepthRange"))  # noqa: SLF001
    if limits_of(gl).clipped:
        gl.glClipControl(*way.control)
    elif way.control != DEFAULT_CLIP:
        pytest.skip("depth cannot run from 0 to 1 here")
    range_(*way.range)
    try:
        yield
    finally:
        range_(0.0, 1.0)
        if limits_of(gl).clipped:
            gl.glClipControl(*DEFAULT_CLIP)


def seen(
    stage: Stage, prairie: Prairie, aim: Camera, walls: moderngl.VertexArray, way: Way, *draws: dict[str, object]
) -> tuple[Numbers, Numbers]:
    """Return the picture of a host with a kind of depth, and the distance of each pixel [m]."""
    view, usual = stage.matrices(aim)
    projection, ctx = way.projection(usual.astype(np.float64)), stage.ctx
    walls.program["clip"] = (projection @ view).T.reshape(16).tolist()
    stage.target.use()
    stage.target.clear(0.2, 0.4, 0.6, depth=way.farthest)
    with having(ctx, way):
        ctx.enable_only(moderngl.DEPTH_TEST)
        ctx.depth_func = "<" if way is USUAL else ">"
        walls.render()
        for options in draws:
            prairie.draw(view, projection, **options)  # type: ignore[arg-type]
        ctx.depth_func = "<="
        ctx.enable_only(moderngl.NOTHING)
    return stage.read(), way.away(stage.depth().astype(np.float64))


@pytest.fixture(scope="module")
def prairie(load: Load) -> Prairie:
    made = load(STILL)
    made.cut(Footprint(radius=5.0), 0.05)
    return made


WHOLE: list[dict[str, object]] = [{}]
IN_PARTS: list[dict[str, object]] = [{"parts": ("ground",)}, {"parts": ("grass", "beyond"), "depth": "all"}]


@pytest.mark.parametrize("draws", [WHOLE, IN_PARTS], ids=["whole", "in parts"])
@pytest.mark.parametrize("way", [TURNED, INFINITE, RANGE], ids=["turned", "infinite from 0 to 1", "by its range"])
def test_d6_where_depth_is_less_farther_off_a_host_sees_the_same(
    stage: Stage, prairie: Prairie, camera: Aim, walls: moderngl.VertexArray, way: Way, draws: list[dict[str, object]]
) -> None:
    aim = camera(0.0, 4.0, 24.0, pitch=-6)
    due, far = seen(stage, prairie, aim, walls, USUAL, *draws)
    found, off = seen(stage, prairie, aim, walls, way, *draws)
    is_wall = (due == (255, 0, 153)).all(axis=-1)
    assert 0.03 < is_wall.mean() < 0.3, "some of the walls is seen, and some hidden"
    assert (far < 60.0).mean() > 0.3
    assert (np.abs(found - due).max(axis=-1) > 2).mean() < 0.005
    near = far < 60.0
    assert (np.abs(off / far - 1.0)[near] > 0.01).mean() < 0.005
    assert ((off < 500.0) == (far < 500.0)).mean() > 0.995


@pytest.mark.parametrize("way", [TURNED, INFINITE], ids=["turned", "infinite from 0 to 1"])
def test_d6_where_fewer_pixels_are_drawn_reversed_depth_is_brought_over_as_well(
    stage: Stage, load: Load, camera: Aim, walls: moderngl.VertexArray, way: Way
) -> None:
    fewer, aim = load(FEWER), camera(0.0, 4.0, 24.0, pitch=-6)
    due, far = seen(stage, fewer, aim, walls, USUAL, {})
    found, off = seen(stage, fewer, aim, walls, way, {})
    assert (np.abs(found - due).max(axis=-1) > 2).mean() < 0.005
    near = far < 60.0
    assert near.mean() > 0.3
    assert (np.abs(off / far - 1.0)[near] > 0.01).mean() < 0.01


@pytest.mark.parametrize("way", [TURNED, INFINITE], ids=["turned", "infinite from 0 to 1"])
def test_d6_grass_casts_its_shadow_into_a_map_whose_depth_is_reversed(
    stage: Stage, prairie: Prairie, camera: Aim, way: Way
) -> None:
    view, _ = stage.matrices(camera(0.0, 20.0, 40.0, pitch=-35))
    usual = np.diag([1 / 15, 1 / 15, -1 / 40, 1.0])
    usual[2, 3] = -1.0
    stage.shot(prairie, camera(0.0, 4.0, 24.0, pitch=-6))
    depths = []
    for one in (USUAL, way):
        projection = usual.copy()
        if one is not USUAL:  # an orthographic map has an end
            projection[2] = -usual[2] if one is TURNED else 0.5 * ([0.0, 0.0, 0.0, 1.0] - usual[2])
        stage.target.use()
        stage.target.clear(depth=one.farthest)
        with having(stage.ctx, one):
            prairie.draw_depth(view, projection)
        depth = stage.depth().astype(np.float64)
        depths.append(depth if one is USUAL else 1.0 - depth)
    assert (depths[0] < 1.0).mean() > 0.02
    assert (np.abs(depths[1] - depths[0]) > 1e-5).mean() < 0.005
