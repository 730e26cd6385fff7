"""Grain: pictures of grass are as rough as those of all its blades, in calm air and in wind (G3, G4)."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tallgrass.app.bench.contrast import relative_contrast
from tallgrass.components.pose import Pose
from tallgrass.engine.camera import Camera
from tallgrass.systems.light.repeating import LITTER_SIDE
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth, patch_distances
from tallgrass.systems.show.strips import textures
from tallgrass.systems.show.strips.pages import ALIGNMENT, SPARE
from tallgrass.systems.wind.breeze import Breeze
from tallgrass.testing import LITTLE, Stage

Load = Callable[..., Prairie]

MEADOW = """\
tallgrass: 2
seed: 3
terrain: { size: [300, 300] }
grass: { prairie: { height: [0.4, 0.7], width: 0.018 } }
quality: high
"""
NEAR = Camera((0.3, 1.7, 0.0), 0.0, np.radians(-8.0), np.radians(20.0))
ABOVE = Camera((0.3, 9.0, 0.0), 0.0, np.radians(-24.0), np.radians(16.0))
FAR = Camera((0.3, 6.0, 100.0), 0.0, np.radians(-3.75), np.radians(4.5))
BELOW = Camera((100.4, 6.85, -28.1), 0.0, np.radians(-5.0), np.radians(42.0))
LOW = Camera((0.3, 4.0, 100.0), 0.0, np.radians(-9.0), np.radians(9.0))


@pytest.fixture(scope="module")
def room(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, (320, 240))


@pytest.mark.parametrize(
    ("held", "camera", "strength"),
    [
        pytest.param("strips", NEAR, 0.0, marks=pytest.mark.slow),
        pytest.param("strips", NEAR, 0.9, marks=pytest.mark.slow),
        ("carpet", ABOVE, 0.0),
        ("carpet", LOW, 0.8),
        pytest.param("carpet", FAR, 0.0, marks=pytest.mark.slow),
    ],
    ids=["strips", "strips in a gale", "carpet", "carpet in a gale", "carpet far away"],
)
def test_g4_grass_has_about_as_much_contrast_as_all_its_blades(
    room: Stage, load: Load, held: str, camera: Camera, strength: float
) -> None:
    prairie = load(MEADOW, lod=held)
    prairie.add(Breeze(direction=80.0, strength=strength, gustiness=0.3, swing=0.0), pose=Pose())
    prairie.advance(2.0)
    seen = room.shot(prairie, camera).astype(np.uint8)
    truth = draw_truth(prairie, *room.matrices(camera), room.size, samples=6)
    grass = patch_distances(prairie, *room.matrices(camera), room.size) >= 0
    flat, usual, rough = np.percentile(relative_contrast(seen, truth, grass), [10, 50, 90])
    assert flat > 0.63
    assert 0.8 < usual < 1.2
    assert rough < 1.6


@pytest.mark.slow
def test_a_strip_shows_nothing_of_the_picture_beside_its_own(
    room: Stage, load: Load, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Once, far off below a crest, dark roots of neighbouring pictures showed at the tops of strips."""
    seen = []
    for spare in (SPARE, 3 * ALIGNMENT):
        monkeypatch.setattr(textures, "SPARE", spare)
        seen.append(room.shot(load("meadow", preset="high", lod="strips"), BELOW))
    assert np.abs(seen[0] - seen[1]).max() < 40.0


def test_the_ground_shows_no_lattice_from_above(room: Stage, load: Load) -> None:
    prairie = load(LITTLE.replace("noise: rolling", "noise: flat").replace("blades: 60", "blades: 20"))
    picture = room.shot(prairie, Camera((0.0, 40.0, 0.0), 0.0, np.radians(-90.0), np.radians(12.0))).mean(axis=2)
    picture -= picture.mean()
    metre = room.size[1] / (80.0 * np.tan(np.radians(6.0)))
    alike = np.fft.irfft2(np.abs(np.fft.rfft2(picture)) ** 2)
    again = round(LITTER_SIDE * metre)
    assert alike[0, again - 1 : again + 2].max() < 0.3 * alike[0, 0]
    assert alike[again - 1 : again + 2, 0].max() < 0.3 * alike[0, 0]
