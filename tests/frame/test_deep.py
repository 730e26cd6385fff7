"""Depth of all grass: it hides as much of what a game draws after the prairie as of what it draws before (D6)."""

from collections.abc import Callable, Iterator

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera
from tallgrass.engine.gl.stream import release_all
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage, stage

Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Picture = NDArray[np.float64]

REEDS = """\
tallgrass: 2
seed: 3
terrain: { noise: flat, size: [60, 60] }
grass: { reed: { height: [0.8, 1.3], width: 0.02, stiffness: 1.5 } }
light: { azimuth: 60, elevation: 40 }
quality:
  blades: 400
  models: 2
  blade_rings: [{ to: 1, segments: 3 }]
  strip_rings: [{ to: 8, strips: 8, columns: 2, sections: 2, texel: 0.02 }]
  carpet_to: 12
  carpet: 32
"""

VERTEX = """#version 330
in vec3 at;
uniform mat4 clip;
void main() { gl_Position = clip * vec4(at, 1.0); }"""
FRAGMENT = """#version 330
uniform float opaque;
out vec4 pixel;
void main() { pixel = vec4(1.0, 0.0, 0.6, opaque); }"""


class Host:
    """A game with a pond amid the reeds, and a sky."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        pond = [(x, 0.3, z) for x, z in ((-40, 22), (40, 22), (-40, 15), (40, 15))]
        sky = [(x, y, 1.0) for x, y in ((-1, -1), (1, -1), (-1, 1), (1, 1))]
        self.buffers = [ctx.buffer(np.array(each, np.float32)) for each in (pond, sky)]
        self.pond, self.sky = (ctx.vertex_array(self.program, [(each, "3f", "at")]) for each in self.buffers)

    def draw(self, what: moderngl.VertexArray, clip: NDArray[np.floating], *, opaque: float = 1.0) -> None:
        self.program["clip"], self.program["opaque"] = clip.T.reshape(16).tolist(), opaque
        what.render(moderngl.TRIANGLE_STRIP)

    def release(self) -> None:
        release_all(self.pond, self.sky, *self.buffers, self.program)


@pytest.fixture(scope="module")
def host(ctx: moderngl.Context) -> Iterator[Host]:
    made = Host(ctx)
    yield made
    made.release()


@pytest.fixture(scope="module")
def stage_of_reeds(ctx: moderngl.Context) -> Iterator[Stage]:
    with stage(ctx, (320, 180)) as made:
        yield made


def seen(stage: Stage, prairie: Prairie, host: Host, camera: Camera, depth: str | None) -> Picture:
    """Return the picture with the pond: drawn first and opaque, or after the grass's depth and translucent."""
    view, projection = stage.matrices(camera)
    clip = projection.astype(float) @ view
    stage.begin()
    if depth is None:
        host.ctx.enable_only(moderngl.DEPTH_TEST)
        host.draw(host.pond, clip)
    prairie.draw(view, projection, depth=depth or "near")
    if depth is not None:
        host.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        host.ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        stage.target.depth_mask = False
        host.draw(host.pond, clip, opaque=0.7)
        stage.target.depth_mask = True
    return stage.read()


@pytest.mark.parametrize("lod", ["auto", pytest.param("blades", marks=pytest.mark.slow)])
def test_as_much_of_a_pond_is_seen_past_reeds_after_them_as_before(
    stage_of_reeds: Stage, load: Load, camera: Aim, host: Host, lod: str
) -> None:
    prairie, aim, stage = load(REEDS, lod=lod), camera(0.0, 2.2, 28.0, pitch=-6), stage_of_reeds
    stage.begin()
    dry = stage.shot(prairie, aim)
    due, after, near = (seen(stage, prairie, host, aim, depth) for depth in (None, "all", "near"))
    way = np.array((255.0, 0.0, 153.0)) - dry.mean(axis=(0, 1))
    view, projection = stage.matrices(aim)
    stage.begin()
    host.ctx.enable_only(moderngl.DEPTH_TEST)
    host.draw(host.pond, projection.astype(float) @ view)
    where = stage.read()[..., 0] == 255

    def share(picture: Picture, opaque: float) -> float:
        part = ((picture - dry) @ way)[where] / (opaque * (way @ way))
        return float(np.clip(part, 0.0, 1.0).mean())

    assert 0.01 < share(due, 1.0) < 0.8, share(due, 1.0)
    assert share(after, 0.7) == pytest.approx(share(due, 1.0), abs=0.03)
    assert share(near, 0.7) > share(due, 1.0) + 0.1


def test_the_picture_is_the_same_whichever_grass_writes_depth(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, pictures, depths = load(), [], []
    for depth in ("near", "all"):
        stage.begin()
        prairie.draw(*stage.matrices(camera(0.0, 1.7, 20.0, pitch=-8)), depth=depth)
        pictures.append(stage.read())
        depths.append(stage.depth().copy())
    assert (pictures[0] != pictures[1]).any(axis=-1).mean() < 0.01  # thin outlines of the carpet hide no strips then
    assert (depths[1] < depths[0]).mean() > 0.05


def test_a_games_sky_goes_in_underneath_by_what_the_prairie_covers(
    stage: Stage, load: Load, camera: Aim, host: Host
) -> None:
    prairie, ctx = load(), stage.ctx
    camera_up = stage.matrices(camera(0.0, 1.0, 20.0, pitch=6))
    color, deep = ctx.texture(stage.size, 4), ctx.depth_texture(stage.size)
    target = ctx.framebuffer([color], deep)
    pictures = []
    try:
        for is_first in (True, False):
            target.use()
            target.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
            ctx.enable_only(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE_MINUS_DST_ALPHA, moderngl.ONE
            if is_first:
                host.draw(host.sky, np.eye(4))
            prairie.draw(*camera_up, parts=("ground", "grass", "beyond"))
            if not is_first:
                host.draw(host.sky, np.eye(4))
            pictures.append(np.frombuffer(target.read(components=3), np.uint8).reshape(90, 160, 3).astype(float))
        first, last = pictures
        only_sky = (first == (255, 0, 153)).all(axis=-1)
        assert 0.2 < only_sky.mean() < 0.9
        assert (last[only_sky] == (255, 0, 153)).all()
        assert np.abs(first - last).max() <= 5  # layer upon layer, each rounded to bytes
    finally:
        ctx.enable_only(moderngl.NOTHING)
        for each in (target, color, deep):
            each.release()


def test_a_depth_that_is_none_is_told(stage: Stage, load: Load, camera: Aim) -> None:
    with pytest.raises(ValueError, match="unknown depth 'far'; there are near, all"):
        load().draw(*stage.matrices(camera(0.0, 1.7, 20.0)), depth="far")
