"""Lamps: the same light on all representations, falling off as it does in the world (F5, N12)."""

from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Lamp, Pose
from tallgrass.engine.camera import Camera
from tallgrass.systems.lamps.card import MOST
from tallgrass.systems.light.color import shown_as
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_reference
from tallgrass.testing import LITTLE, Stage

Picture = NDArray[np.float64]
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]

SCENE: dict[str, Any] = {
    "tallgrass": 2,
    "terrain": {"size": [120, 120]},
    "grass": {"turf": {"height": [0.4, 0.6], "width": 0.035, "blades": 800, "variety": 0}},
    "light": {"strength": 0.01, "zenith": "#0c1020", "horizon": "#0c1020", "haze": 1e6},
    "quality": {
        "models": 1,
        "blade_rings": [{"to": 2, "segments": 3}],
        "strip_rings": [{"to": 6, "strips": 4, "texel": 0.015}],
        "carpet_to": 16,
        "carpet": 64,
    },
}
CAMERA = Camera((0.0, 10.0, 10.0), 0.0, -0.78, np.radians(50.0))
SIZE = (144, 96)
RINGS = 0.5, 2.0, 3.5, 5.0, 7.0
"""Distances from the foot of the lamp between which light is compared [m]."""

LAMPS = {
    "all ways": (Lamp(candela=1200.0, range=20.0), Pose(0.0, 0.0, y=3.0)),
    "a spot light": (Lamp("#ffffff", 8000.0, 30.0, cone=0.9, pitch=-0.6), Pose(-6.0, 2.0, 1.2, y=4.0)),
}


@pytest.fixture(scope="module")
def stage(ctx: moderngl.Context) -> Stage:
    return Stage(ctx, SIZE)


@pytest.fixture(scope="module")
def prairies(ctx: moderngl.Context) -> Iterator[dict[str, Prairie]]:
    """One prairie a representation, which shows nothing else."""
    made = {lod: Prairie.load(SCENE, ctx=ctx, lod=lod, live=False) for lod in ("blades", "strips", "carpet")}
    yield made
    for prairie in made.values():
        prairie.release()


def lamplight(shot: Callable[[], Picture], lamp: Lamp, pose: Pose) -> Picture:
    """The radiance that a lamp adds, from two pictures, shape (height, width, 3)."""
    before = shown_as(shot() / 255.0)
    entity = esper.create_entity(lamp, pose)
    try:
        return np.asarray(shown_as(shot() / 255.0) - before)
    finally:
        esper.delete_entity(entity, immediate=True)


@pytest.mark.parametrize("name", LAMPS)
def test_n12_a_lamp_lights_all_representations_alike(stage: Stage, prairies: dict[str, Prairie], name: str) -> None:
    def truth() -> Picture:
        stage.shot(prairies["blades"], CAMERA)
        return draw_reference(prairies["blades"], *stage.matrices(CAMERA), SIZE, samples=3).astype(np.float64)

    away = np.linalg.norm(stage.ground(CAMERA, 0.35), axis=-1)
    rings = [(away > near) & (away < far) for near, far in zip(RINGS, RINGS[1:], strict=False)]

    def of_rings(picture: Picture) -> Picture:
        return np.array([picture[ring].mean() for ring in rings])

    due = of_rings(lamplight(truth, *LAMPS[name]))
    found = {
        lod: of_rings(lamplight(lambda at=prairie: stage.shot(at, CAMERA), *LAMPS[name])) / due
        for lod, prairie in prairies.items()
    }
    print(due, found)
    assert due.min() > 0.003
    assert max(np.abs(ratio - 1.0).max() for ratio in found.values()) < 0.08, found
