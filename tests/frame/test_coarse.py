"""The carpet of cheaper presets is like the whole one, in the shade and where the ground shows (G5, N12)."""

from collections.abc import Callable

import esper
import moderngl
import numpy as np
import pytest
import yaml
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
light: {{ azimuth: 90, elevation: 50, haze: 1000000 }}
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


def test_g4_over_crests_of_a_coarse_carpet_as_much_sky_is_seen_as_over_a_whole_one(
    ctx: moderngl.Context, room: Stage
) -> None:
    z = np.arange(121.0) - 60.0
    ridge = np.where(np.abs(z) < 30.0, 3.0 * np.cos(z * np.pi / 60.0) ** 2, 0.0)
    heights = np.repeat(ridge[:, None], 121, 1).astype(np.float32)
    clear = []  # how far down the sky is seen, in rows of pixels
    for coarse in ("false", "true"):
        scene = yaml.safe_load(SCENE.format(blades=400, coarse=coarse))
        scene["terrain"] = {"heights": heights, "cell": 1.0}
        prairie = Prairie.load(scene, ctx=ctx, lod="carpet")
        picture = room.shot(prairie, Camera((0.6, 1.7, 50.0), 0.0, 0.024, np.radians(5.0))).mean(axis=(1, 2))
        prairie.release()
        sky, grass = picture[:10].mean(), picture[-20:].mean()
        clear.append(float(((picture - grass) / (sky - grass)).sum()))
    assert clear[1] == pytest.approx(clear[0], abs=1.0)


def test_g5_between_sparse_grass_litter_shows_on_coarse_ground_too(room: Stage, load: Load) -> None:
    def grain(picture: NDArray[np.float64]) -> float:
        near = picture[60:].mean(axis=2)
        return float(np.abs(np.diff(near, axis=1)).mean() / near.mean())

    whole, coarse = (grain(room.shot(prairie, CAMERA)) for prairie in both(load, 4))
    assert 0.2 * whole < coarse < 1.2 * whole
