"""The parts of the shaders compute what numpy computes (T1, W3, W12)."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import MOST_KINDS, GrassKind
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.systems.grow.bend import bending, spine
from tallgrass.systems.grow.postures import HANGING, grow_give, grow_postures
from tallgrass.systems.grow.record import GIVES, Blades, Growth
from tallgrass.systems.grow.response import grow_response
from tallgrass.systems.land.heights import Heights
from tallgrass.systems.land.part import posture_texture
from tallgrass.systems.site import Site

Laid = Callable[..., Site]
RecordOf = Callable[..., NDArray[np.void]]
Probe = Callable[..., NDArray[np.float32]]

POSTURE = """#include "lib/posture.glsl"
in vec4 row;
out vec3 told;
void main() { told = posture(row.x, bending(int(row.x) / 6, row.yz), row.w).place; }"""
BENDING = """#include "lib/posture.glsl"
in vec3 row;
out vec2 told;
void main() { told = bending(int(row.z), row.xy); }"""
HEIGHT = """#include "lib/terrain.glsl"
in vec2 row;
out float told;
void main() { told = height_at(row); }"""


@pytest.fixture
def postures(ctx: moderngl.Context, growths: list[Growth]) -> Iterator[moderngl.TextureArray]:
    texture = posture_texture(ctx, growths)
    yield texture
    texture.release()


@pytest.fixture
def record(laid: Laid, record_of: RecordOf) -> NDArray[np.void]:
    site = laid()
    return record_of(site)


def upright(count: int, variant: int) -> Blades:
    """Return blades of length 1 at the origin, upright at rest."""
    nothing = np.zeros(count, np.float32)
    still = np.zeros((count, 2), np.float32)
    kind = np.full(count, variant, np.int32)
    return Blades(still, nothing + 1, nothing, nothing, still, kind, nothing)


def bent(
    probe: Probe, postures: moderngl.TextureArray, record: NDArray[np.void], variant: int, messages: NDArray[np.float32]
) -> NDArray[np.float32]:
    """Return nine points along a blade for each message (n, 2), bent by the graphics card, shape (n, 9, 3)."""
    count, t = len(messages), np.linspace(0.0, 1.0, 9, dtype=np.float32)
    rows = np.empty((count, 9, 4), np.float32)
    rows[..., 0], rows[..., 1:3], rows[..., 3] = variant, messages[:, None], t
    return probe(POSTURE, rows.reshape(-1, 4), record, {"postures": postures}, 3).reshape(count, 9, 3)


def messages(count: int, seed: int = 1) -> NDArray[np.float32]:
    random = np.random.default_rng(seed)
    index, angle = random.random(count), random.uniform(-np.pi, np.pi, count)
    return np.stack([index * np.cos(angle), index * np.sin(angle)], 1).astype(np.float32)


@pytest.mark.parametrize("kind", [0, 1])
def test_w3_the_graphics_card_bends_blades_as_numpy_does(
    probe: Probe, postures: moderngl.TextureArray, record: NDArray[np.void], growths: list[Growth], kind: int
) -> None:
    wind = messages(60)
    for variant in range(6):
        there = bent(probe, postures, record, kind * 6 + variant, wind)
        here = spine(upright(60, variant), growths[kind].postures, wind, points=9)
        assert np.abs(there - here).max() < 4e-3


def test_w3_a_bent_blade_keeps_its_length(
    probe: Probe, postures: moderngl.TextureArray, record: NDArray[np.void]
) -> None:
    place = bent(probe, postures, record, 0, messages(100))
    length = np.linalg.norm(np.diff(place, axis=1), axis=2).sum(axis=1)
    assert length.min() > 0.97
    assert length.max() < 1.01


def test_w2_a_blade_bends_along_its_message_and_farther_with_its_index(
    probe: Probe, postures: moderngl.TextureArray, record: NDArray[np.void]
) -> None:
    index = np.linspace(0.05, 1.0, 20, dtype=np.float32)
    tip = bent(probe, postures, record, 6, index[:, None] * np.array([[0.6, -0.8]], np.float32))[:, -1]
    reach = tip[:, ::2] @ np.array([0.6, -0.8])
    np.testing.assert_allclose(tip[:, ::2], reach[:, None] * [[0.6, -0.8]], atol=1e-3)
    assert (np.diff(reach) > 0.0).all()
    assert (np.diff(tip[:, 1]) < 0.0).all()


def test_w12_the_same_message_bends_two_kinds_differently(
    probe: Probe, postures: moderngl.TextureArray, record: NDArray[np.void], growths: list[Growth]
) -> None:
    wind = messages(40)
    soft, stiff = (bent(probe, postures, record, kind * 6, wind) for kind in (0, 1))
    assert (soft[:, -1, 1] < stiff[:, -1, 1]).all()
    ours = [spine(upright(40, 0), growth.postures, wind, points=9) for growth in growths]
    difference = (soft - stiff) - (ours[0] - ours[1])
    assert np.abs(difference).max() < 8e-3


def test_w12_on_the_graphics_card_the_stiff_tip_stands_a_quarter_of_its_length_above_the_soft_one(
    ctx: moderngl.Context, probe: Probe, record: NDArray[np.void]
) -> None:
    kinds = [GrassKind(stiffness=stiffness) for stiffness in (0.2, 8.0)]
    made = [replace(grow_postures(kind, variants=6), give=grow_give(kind)) for kind in kinds]
    texture = posture_texture(ctx, [Growth(postures, grow_response(kinds[0]), ()) for postures in made])
    record[0]["give"][:GIVES, :2] = np.stack([postures.give for postures in made], axis=1)
    half = np.array([[0.5, 0.0], [0.3, -0.4]], np.float32)
    for variant in range(6 - HANGING):  # a leaf that hangs lies already
        soft, stiff = (bent(probe, texture, record, kind * 6 + variant, half)[:, -1, 1] for kind in (0, 1))
        assert (stiff - soft > 0.25).all()
    texture.release()


@pytest.mark.parametrize("kind", range(MOST_KINDS))
def test_w12_each_of_sixteen_kinds_gives_way_as_its_own_numbers_say(
    probe: Probe, record: NDArray[np.void], growths: list[Growth], kind: int
) -> None:
    gives = np.sort(np.random.default_rng(3).random((MOST_KINDS, GIVES)).astype(np.float32), axis=1)
    record[0]["give"] = gives.reshape(-1, 4, GIVES).transpose(0, 2, 1).reshape(-1, 4)
    wind = messages(50)
    asked = np.column_stack([wind, np.full(len(wind), kind, np.float32)])
    told = probe(BENDING, asked, record, {}, 2)
    np.testing.assert_allclose(told, bending(replace(growths[0].postures, give=gives[kind]), wind), atol=1e-5)


def test_t1_the_graphics_card_reads_the_same_bilinear_ground(
    ctx: moderngl.Context, probe: Probe, record: NDArray[np.void], hills: Terrain
) -> None:
    texture = Heights(ctx, hills).texture
    place = np.random.default_rng(2).uniform(-50.0, 50.0, (3000, 2)).astype(np.float32)
    there = probe(HEIGHT, place, record, {"heights": texture}, 1)[:, 0]
    np.testing.assert_allclose(there, height_at(hills, place), atol=1e-4)
    texture.release()
