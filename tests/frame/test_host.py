"""A prairie in somebody else's program: state, framebuffers, memory (D6)."""

import gc
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from weakref import ref

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.camera import Camera, camera_at
from tallgrass.engine.gl import mipmaps
from tallgrass.engine.gl.limits import limits_of
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import carpet_painter

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

VERTEX = """#version 330
layout(std140) uniform Host { vec4 place; };
out vec2 at;
void main() {
    at = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1));
    gl_Position = vec4(place.xy + at * place.zw, 0.0, 1.0);
}"""
FRAGMENT = """#version 330
uniform sampler2D picture;
in vec2 at;
out vec4 pixel;
void main() { pixel = texture(picture, at); }"""

FAR_FLOWERS = """\
tallgrass: 2
terrain: { noise: rolling, size: [60, 200], scale: 10, feature: 60, seed: 1 }
grass:
  tall: { root: "#000000", tip: "#ff2010", height: [0.4, 0.8], width: 0.03 }
  poppy: { plant: flower, root: "#000000", tip: "#ff0000", head: { size: [0.1, 0.2] } }
light: { azimuth: 180, elevation: 30 }
quality:
  models: 1
  blades: 300
  blade_rings: [{ to: 1, segments: 3 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.08 }]
  carpet_to: 40
  carpet: 16
"""


class Overlay:
    """A host's drawing over a prairie: a textured square, its uniform block at binding 0, its texture on unit 0."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        texels = np.random.default_rng(1).integers(0, 256, (4, 4, 4), dtype=np.uint8)
        self.texture = ctx.texture((4, 4), 4, texels.tobytes())
        self.texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.block = ctx.buffer(np.array([-0.5, -0.5, 0.8, 1.1], np.float32))
        self.block.bind_to_uniform_block(0)
        self.array = ctx.vertex_array(self.program, [])

    def draw(self) -> None:
        """Draw as a host that binds its texture alone."""
        self.texture.use(0)
        self.array.render(moderngl.TRIANGLE_STRIP, 4)

    def release(self) -> None:
        for thing in (self.array, self.program, self.texture, self.block):
            thing.release()


@pytest.fixture
def overlay(ctx: moderngl.Context) -> Iterator[Overlay]:
    made = Overlay(ctx)
    yield made
    made.release()


def over(stage: Stage, picture: NDArray[np.float64], overlay: Overlay) -> NDArray[np.bool_]:
    """Return the mask of pixels that the host's square changed."""
    overlay.draw()
    return np.asarray((stage.read() != picture).any(axis=-1))


def test_d6_what_the_host_draws_over_the_prairie_looks_as_it_does_alone(
    stage: Stage, load: Load, overlay: Overlay
) -> None:
    stage.target.use()
    stage.target.clear()
    stage.ctx.enable_only(moderngl.NOTHING)
    overlay.draw()
    alone = stage.read()
    picture = stage.shot(load())
    changed = over(stage, picture, overlay)
    square = alone.any(axis=-1)
    np.testing.assert_array_equal(stage.read()[square], alone[square])
    assert not changed[~square].any()
    assert square.sum() > 2000


def test_d6_a_prairie_is_drawn_the_same_whatever_state_the_host_left(
    stage: Stage, load: Load, overlay: Overlay
) -> None:
    prairie = load()
    expected = stage.shot(prairie)
    ctx = stage.ctx
    ctx.enable(moderngl.CULL_FACE | moderngl.BLEND)
    ctx.front_face, ctx.cull_face = "cw", "back"
    ctx.blend_func, ctx.depth_func = (moderngl.ONE, moderngl.ONE), ">"
    sampler = ctx.sampler(filter=(moderngl.NEAREST, moderngl.NEAREST))
    for unit in range(4):
        sampler.use(unit)
        overlay.texture.use(unit)
    found = stage.shot(prairie)
    ctx.enable_only(moderngl.NOTHING)
    ctx.front_face, ctx.depth_func = "ccw", "<"
    ctx.blend_func = moderngl.DEFAULT_BLENDING
    sampler.release()
    np.testing.assert_array_equal(found, expected)


def test_d6_what_a_mirror_shows_is_the_picture_turned_over(stage: Stage, load: Load, camera: Aim) -> None:
    prairie = load()
    view, projection = stage.matrices(camera(0.3, 4.1, 12.0, pitch=-14))
    pictures = []
    for over in (1.0, -1.0):
        stage.begin()
        prairie.draw(view, np.diag([over, 1.0, 1.0, 1.0]) @ projection)
        pictures.append(stage.read().astype(float))
    plain, mirrored = pictures
    assert (np.abs(mirrored[:, ::-1] - plain).max(axis=2) > 12.0).mean() < 0.005


def test_d6_a_prairie_fills_the_hosts_viewport_and_nothing_else(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(), camera(0.3, 4.1, 12.0, pitch=-14)
    stage.target.use()
    stage.target.clear(0.0, 0.0, 1.0, 1.0, depth=1.0)
    stage.target.viewport = (32, 20, 80, 45)
    stage.target.use()
    try:
        prairie.draw(*stage.matrices(aim))
    finally:
        stage.target.viewport = (0, 0, *stage.size)
    picture = stage.read()
    inside = np.zeros((90, 160), np.bool_)
    inside[90 - 65 : 90 - 20, 32:112] = True
    assert (picture[~inside] == (0, 0, 255)).all()
    assert (picture[inside] != (0, 0, 255)).any(axis=-1).all()
    small = picture[inside].reshape(45, 80, 3)
    large = stage.shot(prairie, aim).reshape(45, 2, 80, 2, 3).mean(axis=(1, 3))
    assert np.abs(small - large).mean() < 6.0


def test_d6_a_prairie_draws_into_the_framebuffer_that_is_bound_and_no_other(
    ctx: moderngl.Context, stage: Stage, load: Load
) -> None:
    prairie = load()
    expected = stage.shot(prairie)
    color, depth = ctx.texture(stage.size, 3, alignment=1), ctx.depth_renderbuffer(stage.size)
    other = ctx.framebuffer([color], depth)
    stage.target.clear(0.0, 0.0, 1.0)
    other.use()
    other.clear(depth=1.0)
    prairie.draw(*stage.matrices(camera_at(prairie.scene.camera, None, prairie.height_at)))
    assert ctx.detect_framebuffer().glo == other.glo
    assert (stage.read() == (0, 0, 255)).all()
    data = np.frombuffer(other.read(components=3, alignment=1), np.uint8).reshape(90, 160, 3)[::-1]
    np.testing.assert_array_equal(data, expected)
    for thing in (other, color, depth):
        thing.release()


def test_d6_into_textures_of_several_samples_it_draws_what_is_in_range_and_leaves_no_error(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim
) -> None:
    prairie = load(FAR_FLOWERS, lod="blades", linear=True)
    aim = camera(-18.0, float(prairie.height_at([(-18.0, 90.0)])[0]) + 1.2, 90.0, pitch=-1)
    texture, deep = ctx.texture(stage.size, 4, samples=4, dtype="f2"), ctx.depth_texture(stage.size, samples=4)
    several, colours = ctx.framebuffer([texture], deep), ctx.texture(stage.size, 4, dtype="f2")
    plain = ctx.framebuffer([colours])
    several.use()
    several.clear(depth=1.0)
    assert ctx.error == "GL_NO_ERROR"
    prairie.draw(*stage.matrices(aim), parts=("grass",))
    assert ctx.error == "GL_NO_ERROR"
    ctx.copy_framebuffer(plain, several)
    told = np.frombuffer(plain.read(components=3, dtype="f2"), np.float16)
    assert told.max() > 1.0
    assert told.min() == 0.0, "a sample beyond a blade's edge had a colour that the blade has nowhere"
    for thing in (several, plain, texture, deep, colours):
        thing.release()


@pytest.mark.parametrize("samples", [0, 4])
def test_d6_all_numbers_that_it_draws_are_finite(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim, samples: int
) -> None:
    """Where Mesa clips a ribbon at a corner, and in a sample beyond a crest, they were not: blurs spread such."""
    prairie = load(linear=True)
    colours, depth = ctx.texture(stage.size, 4, dtype="f4"), ctx.depth_renderbuffer(stage.size)
    several = ctx.renderbuffer(stage.size, 4, samples=samples, dtype="f4")
    deep = ctx.depth_renderbuffer(stage.size, samples=samples)
    plain, drawn = ctx.framebuffer([colours], depth), ctx.framebuffer([several], deep)
    for x, yaw, pitch in ((-7.3, 333.0, -32.0), (2.3, 77.0, -8.0), (-8.8, 148.0, -17.0)):
        drawn.use()
        drawn.clear(depth=1.0)
        height = float(prairie.height_at([(x, 5.0)])[0])
        prairie.draw(*stage.matrices(camera(x, height + 1.7, 5.0, yaw=yaw, pitch=pitch)))
        ctx.copy_framebuffer(plain, drawn)
        assert np.isfinite(np.frombuffer(plain.read(components=4, dtype="f4"), np.float32)).all()
    for thing in (drawn, plain, several, deep, colours, depth):
        thing.release()


def test_d6_without_a_context_of_its_own_a_prairie_takes_the_current_one(
    stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(moderngl, "get_context", lambda: stage.ctx)
    given = load()
    found = Prairie(given.loaded)
    np.testing.assert_array_equal(stage.shot(found), stage.shot(given))
    found.release()


def resident() -> float:
    """Return the resident memory of this process [MB], 0 where it is unknown."""
    told = Path("/proc/self/statm")
    return int(told.read_text().split()[1]) * 4096 / 1e6 if told.exists() else 0.0


def test_d6_released_a_prairie_leaves_nothing_behind_in_gl(ctx: moderngl.Context, stage: Stage, load: Load) -> None:
    scene = load().loaded
    gc.collect()  # what other tests have left
    before, ctx.gc_mode = ctx.gc_mode, "context_gc"
    ctx.objects.clear()
    memory = []
    try:
        for _ in range(12):
            prairie = Prairie(scene, ctx=ctx)
            stage.shot(prairie)
            prairie.release()
            del prairie
            gc.collect()
            memory.append(resident())
        dropped = [thing for thing in ctx.objects if not isinstance(thing, moderngl.InvalidObject)]
    finally:
        ctx.gc_mode = before
        ctx.objects.clear()
    assert dropped == [], "everything was released by its owner"
    assert memory[-1] - memory[3] < 25.0, "one prairie of these takes more than 4 MB"


def test_d6_a_dropped_prairie_is_reported_and_released_when_another_is_drawn(
    ctx: moderngl.Context, stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene, other = load().loaded, load()
    prairie = Prairie(scene, ctx=ctx)
    stage.shot(prairie)
    (patch,) = prairie.patch_at([(0, 20)])
    site, painter = ref(prairie.site), ref(prairie.painter)
    with pytest.warns(ResourceWarning, match=r"a prairie of scene\.yaml was dropped and not released: call its rel"):
        del prairie
    assert esper.entity_exists(patch)
    stage.shot(other)
    gc.collect()
    assert (site(), painter()) == (None, None)
    assert not esper.entity_exists(patch)
    released = Prairie(scene, ctx=ctx)
    stage.shot(released)
    released.release()
    monkeypatch.setattr(Prairie, "path", property(abs))  # it fails, as when Python ends and modules go
    del released  # which is not reported
    gc.collect()


def test_a_frame_ends_where_a_system_releases_the_prairie(stage: Stage, load: Load, caplog: Any) -> None:
    prairie = load()
    ran: list[str] = []

    def end() -> None:
        ran.append("end")
        prairie.release()

    stage.shot(prairie)
    prairie.systems.add("see", "end", end)
    prairie.systems.add("draw", "later", lambda: ran.append("later"), before="gather")
    empty = np.unique(stage.shot(prairie).reshape(-1, 3), axis=0)
    assert (len(empty), ran) == (1, ["end"])
    assert caplog.records == []
    with pytest.raises(RuntimeError, match=r"^this prairie has been released: load it again to draw it$"):
        stage.shot(prairie, Camera((0.0, 4.0, 20.0), 0.0, 0.0, 1.0))


def test_a_system_that_draws_its_own_prairie_is_left_out_in_a_sentence(stage: Stage, load: Load) -> None:
    prairie, view = load(), np.eye(4)
    seen = stage.shot(prairie)
    prairie.systems.add("input", "mirror", lambda: prairie.draw(view, view, viewer="mirror"))
    prairie.systems.add("input", "map", lambda: prairie.follow(view, view, viewer="map"))
    np.testing.assert_array_equal(stage.shot(prairie), seen)
    told = "run raised RuntimeError: this prairie is being drawn: its systems cannot draw it; do so before or after"
    assert [each.split(": ", 1)[1] for each in prairie.systems.failures.values()] == [told, told]
    assert [outlook.viewer.name for outlook in prairie.viewers.values()] == ["main"]
    np.testing.assert_array_equal(stage.shot(prairie), seen)


def test_a_system_that_reads_its_own_prairie_again_is_left_out_in_a_sentence(stage: Stage, load: Load) -> None:
    prairie = load()
    seen = stage.shot(prairie)
    prairie.systems.add("see", "other", lambda: prairie.reload({"tallgrass": 2, "grass": {"other": {}}}))
    np.testing.assert_array_equal(stage.shot(prairie), seen)
    (told,) = prairie.systems.failures.values()
    why = "this prairie is being drawn: its systems cannot read it again; do so before or after"
    assert told.endswith(f"run raised RuntimeError: {why}")


def test_d2_released_a_prairie_leaves_no_entity_behind(stage: Stage, load: Load) -> None:
    kept = load()
    theirs = esper.create_entity("a game's own")
    before = set(esper.get_entities())
    prairie = Prairie(kept.loaded, ctx=stage.ctx)
    for _ in range(4):  # patches and receivers become entities by and by
        stage.shot(prairie)
    assert len(set(esper.get_entities()) - before) > 500
    prairie.release()
    prairie.release()
    assert set(esper.get_entities()) == before
    assert esper.component_for_entity(theirs, str) == "a game's own"
    esper.delete_entity(theirs, immediate=True)


def test_d6_with_fewer_layers_than_there_are_pictures_a_prairie_looks_the_same(
    stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    expected = stage.shot(load("plain", preset="low"))
    monkeypatch.setattr(mipmaps, "limits_of", lambda gl: replace(limits_of(gl), layers=8))
    prairie = load("plain", preset="low")
    found = stage.shot(prairie)
    assert prairie.painter is not None
    assert carpet_painter(prairie.painter).images.layers <= 8
    assert (np.abs(found - expected).max(axis=-1) > 8.0).mean() < 0.003


@pytest.mark.slow
def test_d6_gl_is_asked_for_nothing_that_an_old_driver_does_not_know(
    stage: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    """For example moderngl's `info`: in a context of 3.3 to 4.0 it leaves a GL error, which the host finds next."""
    monkeypatch.setattr(moderngl.Context, "info", property(lambda _: pytest.fail("what moderngl knows was asked for")))
    prairie = load(hold=0.1)
    prairie.prepare()
    assert stage.shot(prairie).std() > 1.0
    assert stage.ctx.error == "GL_NO_ERROR"


def test_a_framebuffer_without_depth_is_told_of_once(
    ctx: moderngl.Context, stage: Stage, load: Load, caplog: pytest.LogCaptureFixture
) -> None:
    prairie, color = load(), ctx.texture(stage.size, 3, alignment=1)
    flat = ctx.framebuffer([color])
    stage.shot(prairie)
    assert caplog.messages == []
    for _ in range(2):
        flat.use()
        prairie.draw(*stage.matrices(camera_at(prairie.scene.camera, None, prairie.height_at)))
    (told,) = caplog.messages
    assert told.startswith(
        "a prairie is drawn into a framebuffer without depth, so what is far off lies over what is near"
    )
    for thing in (flat, color):
        thing.release()


def test_d6_two_prairies_are_drawn_side_by_side(stage: Stage, load: Load, camera: Aim) -> None:
    one, two = load(), load("plain", preset="low")
    aim = camera(0.3, 4.1, 12.0, pitch=-14)
    first, second = stage.shot(one, aim), stage.shot(two, aim)
    assert np.abs(first - second).mean() > 2.0
    np.testing.assert_array_equal(stage.shot(one, aim), first)
    np.testing.assert_array_equal(stage.shot(two, aim), second)
