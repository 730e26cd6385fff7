"""The carpet of cheaper presets is like the whole one, in the shade and where the ground shows (G5, N12)."""

from collections.abc import Callable

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Shade
from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import Stage

Load = Callable[..., Prairie]

SCENE = """\
tallgrass: 2
terrain: {{ size: [60, 60], noise: flat }}
grass: {{ turf: {{ height: [0.3, 0.5], width: 0.02, blades: {blades} }} }}
light: {{ azimuth: 90, elevation: 50, haze: 1e6 }}
quality:
  models: 2
  blade_rings: [{{ to: 1, segments: 2 }}]
  strip_rings: [{{ to: 2, strips: 2, texel: 0.05 }}]
  carpet_to: 16
  carpet: 64
  coarse: {coarse}
"""
CAMERA = Camera((0.0, 6.0, 20.0), 0.0, -0.3, np.radians(30.0))


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (240, 120))


def both(load: Load, blades: int) -> list[Prairie]:
    """Prairies with the whole carpet, and with the coarse one."""
    return [load(SCENE.format(blades=blades, coarse=coarse), lod="carpet") for coarse in ("false", "true")]


def test_n12_a_shade_is_as_dark_on_a_coarse_carpet_as_on_a_whole_one(room: Stage, load: Load) -> None:
    darker = []
    for prairie in both(load, 400):
        lit = room.shot(prairie, CAMERA)
        x, y, z = (30.0 * along for along in prairie.sun.direction)
        shade = esper.create_entity(Shade((x, y, z), 8.0))
        under = np.linalg.norm(room.ground(CAMERA, 0.3), axis=-1) < 5.0
        darker.append(room.shot(prairie, CAMERA)[under].mean() / lit[under].mean())
        esper.delete_entity(shade, immediate=True)
    assert darker[0] < 0.8
    assert darker[1] == pytest.approx(darker[0], abs=0.05)


def test_g5_between_sparse_grass_litter_shows_on_coarse_ground_too(room: Stage, load: Load) -> None:
    def grain(picture: NDArray[np.float64]) -> float:
        near = picture[60:].mean(axis=2)
        return float(np.abs(np.diff(near, axis=1)).mean() / near.mean())

    whole, coarse = (grain(room.shot(prairie, CAMERA)) for prairie in both(load, 4))
    assert 0.2 * whole < coarse < 1.2 * whole
