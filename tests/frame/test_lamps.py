"""Lamps: the same light on all representations, falling off as it does in the world (F5, N12)."""

from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import esper
import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass import Lamp, Pose, Shade
from tallgrass.engine.camera import Camera, view_of
from tallgrass.systems.lamps.card import MOST, lamp_texels, visible_lamps
from tallgrass.systems.light.color import shown_as
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.space.frustum import picture_sides
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


def lamplight(shot: Callable[[], Picture], lamp: Lamp, pose: Pose) -> Picture:
    """Return the radiance that a lamp adds, from two pictures, shape (height, width, 3)."""
    before = shown_as(shot() / 255.0)
    entity = esper.create_entity(lamp, pose)
    try:
        return np.asarray(shown_as(shot() / 255.0) - before)
    finally:
        esper.delete_entity(entity, immediate=True)


@pytest.mark.parametrize("name", [pytest.param("all ways", marks=pytest.mark.slow), "a spot light"])
def test_n12_a_lamp_lights_all_representations_alike(stage: Stage, prairies: dict[str, Prairie], name: str) -> None:
    def truth() -> Picture:
        stage.shot(prairies["blades"], CAMERA)
        return draw_truth(prairies["blades"], *stage.matrices(CAMERA), SIZE, samples=3).picture.astype(np.float64)

    away = np.linalg.norm(stage.ground(CAMERA, 0.35), axis=-1)
    rings = [(away > near) & (away < far) for near, far in pairwise(RINGS)]

    def of_rings(picture: Picture) -> Picture:
        return np.array([picture[ring].mean() for ring in rings])

    due = of_rings(lamplight(truth, *LAMPS[name]))
    found = {
        lod: of_rings(lamplight(partial(stage.shot, prairie, CAMERA), *LAMPS[name])) / due
        for lod, prairie in prairies.items()
    }
    assert due.min() > 0.003
    assert max(np.abs(ratio - 1.0).max() for ratio in found.values()) < 0.04, found


def test_light_of_a_lamp_falls_off_by_the_inverse_square_and_ends_at_its_range(
    stage: Stage, prairies: dict[str, Prairie]
) -> None:
    def at(height: float, far: float) -> float:
        lamp, pose = Lamp(candela=300.0 * height**2, range=far), Pose(0.0, 0.0, y=height)
        return float(lamplight(lambda: stage.shot(prairies["carpet"], CAMERA), lamp, pose)[40:60, 60:84].mean())

    high, higher = at(15.0, 1000.0), at(30.0, 1000.0)
    assert high > 0.005
    assert higher == pytest.approx(high, rel=0.1)
    assert abs(at(15.0, 14.0)) < 1e-4


def test_a_spot_light_shines_within_its_cone_as_others_do_and_not_beyond(
    stage: Stage, prairies: dict[str, Prairie]
) -> None:
    shot, away = partial(stage.shot, prairies["carpet"], CAMERA), np.linalg.norm(stage.ground(CAMERA, 0.35), axis=-1)
    pose = Pose(0.0, 0.0, y=4.35)
    all_ways = lamplight(shot, Lamp(candela=4000.0), pose).sum(axis=2)
    spot = lamplight(shot, Lamp(candela=4000.0, cone=np.arctan(0.75), pitch=-np.pi / 2), pose).sum(axis=2)
    middle, edge, beyond = away < 1.2, (away > 2.3) & (away < 2.8), (away > 3.5) & (away < 6.0)
    assert all_ways[beyond].mean() > 0.2 * all_ways[middle].mean()
    assert spot[middle].mean() == pytest.approx(all_ways[middle].mean(), rel=0.03)
    assert 0.05 * all_ways[edge].mean() < spot[edge].mean() < 0.6 * all_ways[edge].mean()
    assert spot[beyond].mean() < 0.02 * all_ways[middle].mean()


@pytest.mark.parametrize(
    "lod", ["blades", *(pytest.param(lod, marks=pytest.mark.slow) for lod in ("strips", "carpet"))]
)
def test_f10_a_lamp_shines_as_brightly_where_the_sun_is_hidden(
    stage: Stage, prairies: dict[str, Prairie], lod: str
) -> None:
    prairie, lamp = prairies[lod], LAMPS["all ways"]
    shot, away = partial(stage.shot, prairie, CAMERA), np.linalg.norm(stage.ground(CAMERA, 0.35), axis=-1)
    open_to_sun = lamplight(shot, *lamp)
    x, y, z = (40.0 * along for along in prairie.sun.direction)
    shade = esper.create_entity(Shade((x, y, z), 12.0))
    in_shade = lamplight(shot, *lamp)
    esper.delete_entity(shade, immediate=True)
    lit = away < 5.0
    # Beside the sun's, its light takes the mean of both ways through the leaves.
    assert in_shade[lit].mean() == pytest.approx(open_to_sun[lit].mean(), rel=0.2)


def test_a_lamp_goes_where_its_pose_goes_and_out_with_its_entity(stage: Stage, load: Load, camera: Aim) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0, pitch=-10)
    dark = stage.shot(prairie, aim)
    entity = esper.create_entity(Lamp(candela=1e6), Pose(-5.0, 8.0, y=4.0))
    left = stage.shot(prairie, aim) - dark
    esper.add_component(entity, Pose(5.0, 8.0, y=4.0))
    right = stage.shot(prairie, aim) - dark
    esper.delete_entity(entity, immediate=True)
    half = dark.shape[1] // 2
    assert left[:, :half].mean() > 2.0 * left[:, half:].mean() > 0.0
    assert right[:, half:].mean() > 2.0 * right[:, :half].mean() > 0.0
    assert (stage.shot(prairie, aim) == dark).all()
    assert prairie.painter is not None
    assert not prairie.painter.record["beside_sun"].any()  # then nobody looks for any


def test_a_scene_declares_lamps_at_heights_above_the_ground(stage: Stage, load: Load, camera: Aim) -> None:
    aim = camera(0.0, 2.0, 20.0, pitch=-10)
    scene = LITTLE.rstrip() + "\nlamps: [{ position: [2, 8], height: 4, candela: 1000000 }]\n"
    declared = stage.shot(load(scene), aim)
    prairie = load(LITTLE)
    height = 4.0 + float(prairie.height_at([(2.0, 8.0)])[0])
    entity = esper.create_entity(Lamp(candela=1e6), Pose(2.0, 8.0, y=height))
    shown = stage.shot(prairie, aim)
    esper.delete_entity(entity, immediate=True)
    assert np.abs(shown - declared).max() <= 1.0


def test_of_more_lamps_than_there_is_room_for_the_brightest_count(stage: Stage, camera: Aim) -> None:
    candela = np.random.default_rng(1).permutation(MOST + 40) + 1.0
    told = lamp_texels([(Lamp(candela=float(each)), Pose(0.0, 0.0, y=3.0)) for each in candela])
    sides = picture_sides(view_of(*stage.matrices(camera(0.0, 2.0, 20.0))))
    found = visible_lamps(told, sides, (0.0, 2.0, 20.0))
    kept = candela > 40
    assert np.array_equal(found, told[kept])
    behind = lamp_texels([(Lamp(range=5.0), Pose(0.0, 30.0, y=3.0))])
    assert len(visible_lamps(behind, sides, (0.0, 2.0, 20.0))) == 0


@pytest.mark.parametrize("pose", [None, Pose(0.0, 0.0)])
def test_a_lamp_without_a_place_is_left_out_until_it_has_one_and_told_once(
    stage: Stage, load: Load, camera: Aim, caplog: pytest.LogCaptureFixture, pose: Pose | None
) -> None:
    prairie, aim = load(LITTLE), camera(0.0, 2.0, 20.0)
    dark = stage.shot(prairie, aim)
    entity = esper.create_entity(Lamp(candela=1e4), *([] if pose is None else [pose]))
    for _ in range(2):
        assert np.array_equal(stage.shot(prairie, aim), dark)
    (told,) = caplog.messages
    assert told.startswith(f"the lamp of entity {entity} is left out while it has {pose or 'no Pose'}: ")
    assert told.endswith("and a lamp's pose has a height y")
    esper.add_component(entity, Pose(0.0, 0.0, y=2.0))
    assert (stage.shot(prairie, aim) > dark).any()
    esper.delete_entity(entity, immediate=True)
