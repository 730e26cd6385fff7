"""A game's shadow maps and shades: shadows lie where rays to the sun meet the caster (F5, N12)."""

import logging
from collections.abc import Callable, Iterator
from ctypes import c_int, c_uint
from dataclasses import replace
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Lod, Shade, ShadowMap
from tallgrass.components.shadow_map import texture_number
from tallgrass.engine.camera import Camera, view_of
from tallgrass.engine.gl.functions import ENUMS, functions_of
from tallgrass.engine.gl.units import BORROWED
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import EveryBlade, cells_in_picture, cells_within
from tallgrass.systems.shadows import feature
from tallgrass.systems.space.cone import view_cone
from tallgrass.testing import LITTLE, Stage

Array = NDArray[np.float64]
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

WIDTH = 0.035
"""Width of a blade [m]."""

SCENE: dict[str, Any] = {
    "tallgrass": 2,
    "terrain": {"size": [120, 120]},
    "grass": {"turf": {"height": [0.4, 0.6], "width": WIDTH, "blades": 800, "variety": 0}},
    "light": {"azimuth": 160.0, "elevation": 40.0, "haze": 1e6},
    "quality": {
        "models": 1,
        "blade_rings": [{"to": 2, "segments": 5}],
        "strip_rings": [{"to": 6, "strips": 6, "texel": 0.015}],
        "carpet_to": 16,
        "carpet": 64,
    },
}
CAMERA = Camera((0.0, 9.0, 9.0), 0.0, -0.8, np.radians(34.0))
SIZE = (128, 96)
LOW, HIGH = np.array([-1.6, 1.2, -2.2]), np.array([1.4, 2.6, 0.4])
"""Corners of a box above the grass [m]."""

MIDDLE, UP, YAW = (LOW + HIGH) / 2.0, (0.2, 1.0, -0.15), 0.7
"""The box's middle [m]; where it stands along and heads for when it is turned [rad]."""

ROD, THICK = 3.4, 0.8
"""Length and radius of a capsule [m]."""

FINE = 3
"""Number of rays through a pixel, across and up."""

HALF, DEEP = 12.0, 60.0
"""Half the side of the map, and half its depth [m]."""


def to_sun(azimuth: float = 160.0, elevation: float = 40.0) -> Array:
    a, e = np.radians((azimuth, elevation))
    return np.array([np.cos(e) * np.sin(a), np.sin(e), -np.cos(e) * np.cos(a)])


def seen_from_sun(sun: Array) -> Array:
    """Return the matrix from the world to the clip space of a map from the sun, (4, 4)."""
    right = np.cross(-sun, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    turned = np.eye(4)
    turned[:3, :3] = right, np.cross(right, -sun), sun
    return np.asarray(np.diag([1.0 / HALF, 1.0 / HALF, -1.0 / DEEP, 1.0]) @ turned)


def met(start: Array, way: Array) -> Array:
    """Return the distances along rays (..., 3) to the box, infinite where they miss it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        one, other = (LOW - start) / way, (HIGH - start) / way
    near, far = np.minimum(one, other).max(axis=-1), np.maximum(one, other).min(axis=-1)
    return np.asarray(np.where((near <= far) & (far > 0.0), near, np.inf))


def box_texture(ctx: moderngl.Context, matrix: Array, sun: Array, side: int = 1024) -> moderngl.Texture:
    """Return a depth texture of the box from the sun."""
    line = (np.arange(side) + 0.5) / side * 2.0 - 1.0
    x, y = np.meshgrid(line, line)
    start = np.stack([x, y, np.full_like(x, -1.0), np.ones_like(x)], axis=-1) @ np.linalg.inv(matrix).T
    depth = np.minimum(met(start[..., :3], -sun) / (2.0 * DEEP), 1.0)
    texture = ctx.depth_texture((side, side))
    texture.write(depth.astype(np.float32).tobytes())
    return texture


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, SIZE)


@pytest.fixture
def box(ctx: moderngl.Context) -> Iterator[ShadowMap]:
    matrix = seen_from_sun(to_sun())
    texture = box_texture(ctx, matrix, to_sun())
    yield ShadowMap(texture, matrix, bias=0.0)
    texture.release()


@pytest.fixture
def night(ctx: moderngl.Context) -> Iterator[ShadowMap]:
    """Shadow map in which everything lies in shadow."""
    texture = ctx.depth_texture((8, 8))
    texture.write(np.zeros((8, 8), np.float32).tobytes())
    yield ShadowMap(texture, seen_from_sun(to_sun()))
    texture.release()


@pytest.fixture(scope="module")
def places(ctx: moderngl.Context, prairies: dict[str, Prairie]) -> Array:
    """Places that a reference shows, in pixels three times as fine as the picture's (height, width, 3) [m]."""
    prairie, large = prairies["blades"], Stage(ctx, (SIZE[0] * FINE, SIZE[1] * FINE))
    large.shot(prairie, CAMERA)
    view, projection = large.matrices(CAMERA)
    seen, every = view_of(view, projection), EveryBlade(prairie)
    cells = cells_within(prairie.site.ground, CAMERA.position, view_cone(seen), sway=prairie.site.sway)
    large.begin()
    every.draw(seen, cells_in_picture(prairie, cells, seen))
    every.release()
    height, width = large.size[::-1]
    x, y = np.meshgrid((np.arange(width) + 0.5) / width * 2 - 1, 1 - (np.arange(height) + 0.5) / height * 2)
    clip = np.stack([x, y, large.depth() * 2.0 - 1.0, np.ones_like(x)], axis=-1) @ seen.unclip.T
    return np.asarray(clip[..., :3] / clip[..., 3:])


def edges(shadow: Array, middle: int, across: float) -> Array:
    """Return the ends of a shadow to the left and to the right [m]."""
    return across * np.array([shadow[:middle].sum(), shadow[middle:].sum()])


def in_box(places: Array) -> NDArray[np.bool_]:
    """Return whether the box stands between the sun and places."""
    return np.isfinite(met(places, to_sun()))


def in_turned(places: Array) -> NDArray[np.bool_]:
    """Return whether the box, turned about its middle, stands between the sun and places."""
    up = np.divide(UP, np.linalg.norm(UP))
    right = np.cross((np.sin(YAW), 0.0, -np.cos(YAW)), up)
    right /= np.linalg.norm(right)
    axes = np.stack([right, up, np.cross(right, up)])
    return np.isfinite(met((places - MIDDLE) @ axes.T + MIDDLE, to_sun() @ axes.T))


def in_capsule(places: Array) -> NDArray[np.bool_]:
    """Return whether a row of balls stands between the sun and places."""
    along = np.linspace(-ROD / 2.0 + THICK, ROD / 2.0 - THICK, 120)[:, None] * np.divide(UP, np.linalg.norm(UP))
    shaded = np.zeros(places.shape[:-1], bool)
    for ball in MIDDLE + along:
        shaded |= np.linalg.norm(np.cross(ball - places, to_sun()), axis=-1) < THICK
    return shaded


CASTERS: dict[str, tuple[Shade | None, Callable[[Array], NDArray[np.bool_]]]] = {
    "map": (None, in_box),
    "box": (Shade(tuple(MIDDLE), size=tuple(HIGH - LOW)), in_box),
    "turned": (Shade(tuple(MIDDLE), size=tuple(HIGH - LOW), up=UP, yaw=YAW), in_turned),
    "capsule": (Shade(tuple(MIDDLE), THICK, ROD, UP, capsule=True), in_capsule),
}
"""Casters: a shade, or None for the map; and the function that returns whether places lie in the shadow."""


@pytest.mark.parametrize(
    "caster",
    ["map", "box", pytest.param("turned", marks=pytest.mark.slow), pytest.param("capsule", marks=pytest.mark.slow)],
)
def test_n12_a_shadow_lies_where_rays_are_stopped_on_all_representations(
    stage: Stage, prairies: dict[str, Prairie], box: ShadowMap, night: ShadowMap, places: Array, caster: str
) -> None:
    shade, stopped = CASTERS[caster]
    due = stopped(places).reshape(SIZE[1], FINE, SIZE[0], FINE).mean(axis=(1, 3))
    ground = stage.ground(CAMERA, 0.35)
    rows = np.flatnonzero((due.max(axis=1) > 0.98) & (due[:, :8].max(axis=1) < 0.02) & (due[:, -8:].max(axis=1) < 0.02))
    assert len(rows) > 15
    across = float(np.linalg.norm(np.diff(ground[rows], axis=1), axis=-1).mean())
    whole = due[rows].mean(axis=0)
    middle, off = int(whole.argmax()), {}
    for lod, prairie in prairies.items():
        lit = stage.shot(prairie, CAMERA)
        prairie.shadows([night])
        dark = stage.shot(prairie, CAMERA)
        prairie.shadows([] if shade else [box])
        entity = esper.create_entity(*filter(None, [shade]))
        part = stage.shot(prairie, CAMERA)
        esper.delete_entity(entity, immediate=True)
        prairie.shadows([])
        assert (stage.shot(prairie, CAMERA) == lit).all()
        lit, part, dark = (each[rows].mean(axis=(0, 2)) for each in (lit, part, dark))
        off[lod] = edges((lit - part) / (lit - dark), middle, across) - edges(whole, middle, across)
    assert max(np.abs(each).max() for each in off.values()) < WIDTH, off


@pytest.mark.parametrize("compares", ["", "<=", ">"])
def test_a_texture_is_read_as_a_shadow_map_whatever_its_own_state_says_and_keeps_it(
    stage: Stage, prairies: dict[str, Prairie], box: ShadowMap, compares: str
) -> None:
    prairie = prairies["strips"]
    due, texture = stage.shot(prairie, CAMERA), box.texture
    prairie.shadows([box])
    shaded = stage.shot(prairie, CAMERA)
    texture.compare_func, texture.filter = compares, (moderngl.NEAREST, moderngl.NEAREST)
    own = texture.compare_func, texture.filter
    assert (stage.shot(prairie, CAMERA) == shaded).all()
    assert (texture.compare_func, texture.filter) == own
    prairie.shadows([])
    assert (stage.shot(prairie, CAMERA) == due).all()
    assert (due - shaded).max() > 20.0


def test_a_map_whose_depth_is_reversed_casts_the_same_shadow(
    ctx: moderngl.Context, stage: Stage, prairies: dict[str, Prairie], box: ShadowMap
) -> None:
    prairie, turned = prairies["carpet"], np.diag([1.0, 1.0, -1.0, 1.0]) @ box.matrix
    prairie.shadows([box])
    due = stage.shot(prairie, CAMERA)
    texture = ctx.depth_texture(box.texture.size)
    texture.write((1.0 - np.frombuffer(box.texture.read(), np.float32)).tobytes())
    prairie.shadows([ShadowMap(texture, turned, bias=0.0)])
    assert np.abs(stage.shot(prairie, CAMERA) - due).max() <= 1.0
    prairie.shadows([])
    assert (stage.shot(prairie, CAMERA) != due).any()
    texture.release()


def test_maps_are_bound_where_a_host_has_textures_of_its_own_and_these_are_there_again(
    ctx: moderngl.Context, stage: Stage, prairies: dict[str, Prairie], box: ShadowMap
) -> None:
    gl, found = functions_of(ctx), (c_int * 1)()
    own = ctx.texture((2, 2), 4)
    try:
        for unit in BORROWED:
            own.use(unit)
        prairies["strips"].shadows([box, box])
        stage.shot(prairies["strips"], CAMERA)
        for unit in BORROWED:
            gl.glActiveTexture(ENUMS["TEXTURE0"] + unit)
            for name, due in (("TEXTURE_BINDING_2D", own.glo), ("SAMPLER_BINDING", 0)):
                gl.glGetIntegerv(ENUMS[name], found)
                assert found[0] == due
    finally:
        prairies["strips"].shadows([])
        own.release()


def test_where_there_are_no_maps_any_more_programs_find_depth_textures_as_before(
    stage: Stage, prairies: dict[str, Prairie], box: ShadowMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    bound = dict[int, int]()
    monkeypatch.setattr(feature, "borrow", bound.__setitem__)
    prairies["strips"].shadows([box, box])
    stage.shot(prairies["strips"], CAMERA)
    units = {*bound}
    assert len(units) >= 2
    prairies["strips"].shadows([])
    bound.clear()
    stage.shot(prairies["strips"], CAMERA)
    assert bound.keys() == units
    assert texture_number(box.texture) not in bound.values()


def test_of_several_maps_the_first_counts_that_a_place_lies_in(
    ctx: moderngl.Context, stage: Stage, prairies: dict[str, Prairie], box: ShadowMap, night: ShadowMap
) -> None:
    prairie = prairies["carpet"]
    lit = stage.shot(prairie, CAMERA)
    clear = ctx.depth_texture((8, 8))
    clear.write(np.ones((8, 8), np.float32).tobytes())
    prairie.shadows([ShadowMap(clear, night.matrix), night])
    assert np.abs(stage.shot(prairie, CAMERA) - lit).max() <= 1.0
    aside = np.eye(4)
    aside[0, 3] = 10.0
    prairie.shadows([ShadowMap(clear, aside @ night.matrix), box])
    second = stage.shot(prairie, CAMERA)
    prairie.shadows([box])
    assert (stage.shot(prairie, CAMERA) == second).all()
    prairie.shadows([])
    clear.release()


def test_what_is_no_farther_towards_the_sun_than_a_maps_bias_casts_no_shadow(
    stage: Stage, prairies: dict[str, Prairie], box: ShadowMap
) -> None:
    prairie, pictures = prairies["carpet"], []
    for shadows in ([], [box], [replace(box, bias=10.0)]):
        prairie.shadows(shadows)
        pictures.append(stage.shot(prairie, CAMERA))
    prairie.shadows([])
    lit, dark, past = pictures
    assert np.abs(dark - lit).max() > 30.0
    assert np.abs(past - lit).max() <= 1.0


def test_n12_blades_on_their_way_to_strips_lie_in_shadow_as_those_that_stand(
    ctx: moderngl.Context, stage: Stage, night: ShadowMap
) -> None:
    prairie, aim = Prairie.load(SCENE, ctx=ctx, live=False), Camera((0.0, 2.0, 6.0), 0.0, -0.5, 0.6)
    stage.shot(prairie, aim)
    outlook, darker = prairie.viewers["main"], []
    for hold in (None, "strips"):
        for entity in filter(None, outlook.patches.entity[outlook.patches.shown].tolist()):
            esper.component_for_entity(entity, Lod).hold = hold
        stage.shot(prairie, aim)
        prairie.advance(0.6)
        lit = stage.shot(prairie, aim).mean()
        prairie.shadows([night])
        darker.append([stage.shot(prairie, aim).mean() / lit])
        prairie.shadows([])
        prairie.shine(clouds=1.0)
        darker[-1].append(stage.shot(prairie, aim).mean() / lit)
        prairie.shine(clouds=0.0)
    moved = outlook.appearance.morph[outlook.patches.shown & (outlook.appearance.morph > 0.0)]
    assert len(moved) > 4
    assert 0.3 < moved.min() <= moved.max() < 1.0
    assert darker[1] == pytest.approx(darker[0], abs=0.03)
    prairie.release()


def test_a_map_whose_texture_was_released_is_named_once_and_drawn_without(
    ctx: moderngl.Context, stage: Stage, load: Load, camera: Aim, caplog: pytest.LogCaptureFixture
) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10)
    due = stage.shot(prairie, aim)
    texture = ctx.depth_texture((8, 8))
    texture.write(np.zeros((8, 8), np.float32).tobytes())
    number = texture.glo
    prairie.shadows([ShadowMap(texture, seen_from_sun(to_sun()))])
    assert (stage.shot(prairie, aim) != due).any()
    texture.release()
    with caplog.at_level(logging.WARNING, "tallgrass"):
        for _ in range(2):
            assert (stage.shot(prairie, aim) == due).all()
    (said,) = [record.getMessage() for record in caplog.records]
    assert said == f"texture {number} of a shadow map has been released: the prairie is drawn without it"


@pytest.mark.parametrize(
    ("maps", "error", "why"),
    [
        (lambda t: ShadowMap(t, np.eye(3)), ValueError, r"a shadow map's matrix is 4x4, not array"),
        (lambda t: ShadowMap(t, np.full((4, 4), np.nan)), ValueError, r"a shadow map's matrix is finite numbers, not"),
        (lambda t: ShadowMap(t, "sun"), ValueError, r"a shadow map's matrix is 4x4, not 'sun'"),
        (
            lambda t: ShadowMap(t, np.eye(4), bias=-1.0),
            ValueError,
            r"a shadow map's bias is from 0 to 100 m, not -1\.0",
        ),
        (lambda _: ShadowMap("map.png", np.eye(4)), TypeError, r"a shadow map's texture is a 2D depth texture of "),
        (lambda _: ShadowMap(None, np.eye(4)), TypeError, r"a shadow map's texture .* or its number in GL, not None"),
        (
            lambda t: t.ctx.texture((2, 2), 1),
            TypeError,
            r"shadow maps come in a list, as \[ShadowMap\(\.\.\.\)\], not ",
        ),
        (lambda t: [t], TypeError, r"shadow maps are made as ShadowMap\(texture, matrix\), unlike "),
        (lambda t: [ShadowMap(t, np.eye(4))] * 5, ValueError, r"there is room for 4 shadow maps, not for 5"),
    ],
)
def test_what_is_no_shadow_map_is_refused_in_a_sentence(
    ctx: moderngl.Context, load: Load, maps: Callable[[moderngl.Texture], Any], error: type[Exception], why: str
) -> None:
    prairie, texture = load(LITTLE), ctx.depth_texture((2, 2))
    ShadowMap(c_uint(texture.glo), np.eye(4))  # as pyglet's glGenTextures has it
    with pytest.raises(error, match=f"^{why}"):
        prairie.shadows(maps(texture))
    with pytest.raises(TypeError, match=r"^a shadow map's texture is a depth texture, not one of colours"):
        ShadowMap(ctx.texture((2, 2), 1), np.eye(4))
    texture.release()
