"""A frame leaves no garbage to Python's collector, and never triggers it (N11)."""

import gc
from collections.abc import Callable
from typing import Any

import pytest

from tallgrass.engine.camera import Camera
from tallgrass.systems.prairie import Prairie

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

LONG = """\
tallgrass: 2
terrain: { noise: flat, size: [240, 400] }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
quality:
  blades: 20
  models: 2
  blade_rings: [{ to: 1, segments: 3 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 2, texel: 0.08 }]
  carpet_to: 40
  carpet: 16
wind: [{ kind: breeze }, { kind: turbulence }]
"""
SPEED = 50.0 / 60.0
"""Distance of a fast flight in a frame [m]."""


@pytest.fixture(scope="module")
def prairie(load: Load) -> Prairie:
    """Prairie that is long enough for a flight."""
    return load(LONG)


def fly(stage: Stage, prairie: Prairie, camera: Aim, frames: range) -> None:
    for frame in frames:
        prairie.advance(1.0 / 60.0)
        stage.begin()
        prairie.draw(*stage.matrices(camera(0.6, 2.5, 170.0 - SPEED * frame, pitch=-5)))


@pytest.mark.slow
def test_n11_what_a_flight_leaves_behind_goes_at_once_and_makes_no_cycles(
    stage: Stage, prairie: Prairie, camera: Aim
) -> None:
    fly(stage, prairie, camera, range(20))
    gc.collect()
    gc.disable()
    try:
        fly(stage, prairie, camera, range(20, 60))
        assert gc.collect() == 0
    finally:
        gc.enable()


@pytest.mark.parametrize("trees", [0, 1600])
def test_n11_a_flight_over_thousands_of_patches_hardly_ever_sets_off_the_collector(
    stage: Stage, load: Load, camera: Aim, trees: int
) -> None:
    def collections() -> int:
        return int(gc.get_stats()[0]["collections"])

    stand = [[x, z] for x in range(-114, 115, 6) for z in range(-190, 191, 9)][:trees]
    prairie = load(LONG + (f"trees: {{ thorn: {{ habit: hawthorn, positions: {stand} }} }}\n" if stand else ""))
    cells = []
    for frame in range(40 + 210):
        if frame == 40:  # until then there are more and more patches
            before = collections()
        prairie.advance(1.0 / 60.0)
        prairie.follow(*stage.matrices(camera(0.6, 2.5, 90.0 - SPEED * max(0, frame - 39), pitch=-5)))
        prairie.systems.step("plant")
        cells.append(prairie.viewers["main"].viewer.centre[1])
    gone = (cells[40] - cells[-1]) * prairie.viewers["main"].patches.side
    assert gone > 5000
    assert collections() - before < 6
