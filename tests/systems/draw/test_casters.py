"""Shadows of a game's shades and maps, and of bodies, as `lib/shadows.glsl` has them (F10)."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Shade
from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.shadows.shades import CRISP, EDGE, SOFTER, shade_texels

Array = NDArray[np.float64]
Probe = Callable[..., NDArray[np.float32]]

SUN = np.array([0.48, 0.6, -0.64])
MIDDLE, RADIUS, HEIGHT = np.array([1.0, 1.2, -0.5]), 0.7, 3.4
UP = np.array([0.6, 0.64, 0.48])

ASK = """#include "lib/shadows.glsl"
in vec3 row;
out float told;
void main() { told = %s; }"""


def random_places() -> NDArray[np.float32]:
    """Return places around the middle of the shades, some of them inside, (n, 3) [m]."""
    return (MIDDLE + np.random.default_rng(3).uniform(-2.5, 2.5, (4000, 3))).astype(np.float32)


def sunny() -> NDArray[np.void]:
    record = np.zeros(1, FRAME)
    record["sun"] = SUN
    return record


def gap(places: Array) -> tuple[Array, Array]:
    """Return how far the rays from places to the sun pass from a capsule, and how far along they do so [m]."""
    axis = np.linspace(-1.0, 1.0, 201)[:, None] * (HEIGHT / 2.0 - RADIUS) * UP + MIDDLE
    apart = axis - places[:, None]
    along = np.maximum(apart @ SUN, 0.0)
    off = np.linalg.norm(apart - along[..., None] * SUN, axis=-1)
    nearest = off.argmin(axis=1)
    rows = np.arange(len(places))
    return off[rows, nearest] - RADIUS, along[rows, nearest]


def test_a_capsule_stops_the_rays_that_meet_it_and_no_others(probe: Probe) -> None:
    texels = shade_texels([Shade(tuple(MIDDLE), RADIUS, HEIGHT, tuple(UP), capsule=True)])[0]
    record = ", ".join(f"{number:.9g}" for number in texels.reshape(-1))
    places = random_places()
    seen = probe(ASK % f"shade_visibility(mat3x4({record}), row)", places, sunny(), {}, 1)[:, 0]
    off, along = gap(places.astype(np.float64))
    soft = CRISP + SOFTER * along
    stopped, passing = off < -1.05 * soft - 1e-3, off > 1.05 * soft + 1e-3
    assert min(stopped.sum(), passing.sum()) > 400
    assert (along[stopped] == 0.0).sum() > 20, "places inside, behind which it does not stand"
    assert seen[stopped].max() < 1e-3
    assert seen[passing].min() > 1.0 - 1e-3


def test_bodies_all_cast_their_shadows(probe: Probe) -> None:
    record, bodies = sunny(), MIDDLE + np.array([(0.0, 0.0, 0.0), (1.1, 0.0, 0.0), (0.0, 0.5, -1.8)])
    record["bodies"]["middle"][0, :3], record["bodies"]["radius"][0, :3] = bodies, RADIUS
    places = random_places()
    seen = probe(ASK % "bodies_visibility(row, -1)", places, record, {}, 1)[:, 0]
    apart = bodies[:, None] - places
    off = np.linalg.norm(np.cross(apart, SUN), axis=-1) / RADIUS
    before = apart @ SUN > 0.0
    stopped = (before & (off < 1.0 - 2.0 * EDGE)).any(axis=0)
    assert (before & (off < 1.0 - 2.0 * EDGE)).sum(axis=1).min() > 50
    assert seen[stopped].max() < 1e-3
    assert seen[(off > 1.0 + 2.0 * EDGE).all(axis=0)].min() > 1.0 - 1e-3


@pytest.fixture
def shadow_map(ctx: moderngl.Context) -> Callable[[Array], moderngl.Texture]:
    def make(depth: Array) -> moderngl.Texture:
        texture = ctx.depth_texture(depth.shape[::-1])
        texture.compare_func, texture.filter = "<=", (moderngl.LINEAR, moderngl.LINEAR)
        texture.write(np.ascontiguousarray(depth, np.float32).tobytes())
        return texture

    return make


def test_the_edge_of_a_maps_shadow_is_as_soft_along_either_diagonal(
    probe: Probe, shadow_map: Callable[[Array], moderngl.Texture]
) -> None:
    depth = np.where(np.add.outer(np.arange(16.0), np.arange(16.0)) < 15.0, 0.2, 0.8)
    rows = np.column_stack([*np.random.default_rng(4).uniform(0.4, 0.6, (2, 200)), np.full(200, 0.5)])
    words, found = ASK % "map_visibility(map_0, row)", []
    for texels, places in ((depth, rows), (depth[:, ::-1], rows * (-1.0, 1.0, 1.0) + (1.0, 0.0, 0.0))):
        texture = shadow_map(texels)
        found.append(probe(words, places.astype(np.float32), sunny(), {"map_0": texture}, 1)[:, 0])
        texture.release()
    assert 0.2 < found[0].mean() < 0.8
    assert found[0].std() > 0.1
    np.testing.assert_allclose(found[0], found[1], atol=0.01)


def test_a_place_nearer_or_farther_than_a_map_reaches_is_not_in_it(
    probe: Probe, shadow_map: Callable[[Array], moderngl.Texture]
) -> None:
    texture = shadow_map(np.zeros((16, 16)))
    rows = np.array(
        [(0.5, 0.5, 0.5), (0.5, 0.5, -0.1), (0.5, 0.5, 1.1), (0.05, 0.5, 0.5), (0.5, 0.95, 0.5)], np.float32
    )
    inside = probe(ASK % "is_in_map(map_0, row) ? 1.0 : 0.0", rows, sunny(), {"map_0": texture}, 1)[:, 0]
    texture.release()
    assert inside.tolist() == [1.0, 0.0, 0.0, 0.0, 0.0]
