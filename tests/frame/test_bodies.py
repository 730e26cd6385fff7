"""A saucer in the picture (R4)."""

from collections.abc import Callable
from math import pi
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.body import Body, Hover
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.camera import Camera
from tallgrass.systems.bodies.feature import BodiesPart
from tallgrass.systems.bodies.fly import carried
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.reference import draw_truth

Stage = Any
Load = Callable[..., Prairie]
Aim = Callable[..., Camera]
Picture = NDArray[np.float64]

FLAT = """\
tallgrass: 2
seed: 5
light: { strength: 0 }
terrain: { noise: flat, size: [60, 60] }
grass:
  tall: { height: [0.5, 0.9], width: 0.02 }
quality:
  blades: 60
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 4, strips: 3, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 10
  carpet: 16
"""


@pytest.fixture(scope="module")
def prairie(load: Load, stage: Stage, camera: Aim) -> Prairie:
    """Prairie on flat ground without wind, drawn once; without a sun, so that bodies cast no shadow."""
    made = load(FLAT)
    stage.shot(made, camera(0.0, 1.7, 10.0))
    return made


@pytest.fixture
def show(prairie: Prairie, stage: Stage) -> Callable[..., Picture]:
    """Return the function that draws bodies for a new viewer: `show(camera, *bodies)`."""

    def drawn(aim: Camera, *bodies: Body) -> Picture:
        prairie.viewers.forget("main")
        entities = [prairie.world.create(body) for body in bodies]
        picture = stage.shot(prairie, aim)
        for entity in entities:
            prairie.world.delete(entity)
        return np.asarray(picture)

    return drawn


Show = Callable[..., Picture]


def changed(one: Picture, other: Picture) -> NDArray[np.bool_]:
    return np.asarray(np.abs(one - other).max(axis=-1) > 8.0)


def test_r4_a_saucer_is_seen_where_it_flies(show: Show, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 2.5, 10.0, pitch=5)
    seen = changed(show(aim, Body((1.0, 3.6, 0.0))), show(aim))
    left, right, top, bottom = stage.project(
        aim, np.array([[-0.5, 3.6, 0.0], [2.5, 3.6, 0.0], [1.0, 4.14, 0.0], [1.0, 3.2, 0.0]])
    )
    rows, columns = np.nonzero(seen)
    assert columns.min() == pytest.approx(left[0], abs=2.0)
    assert columns.max() == pytest.approx(right[0], abs=2.0)
    assert rows.min() == pytest.approx(top[1], abs=2.0)
    assert rows.max() == pytest.approx(bottom[1], abs=3.0)
    middle = stage.project(aim, np.array([[1.0, 3.6, 0.0]]))[0].astype(int)
    assert seen[middle[1], middle[0]]


def test_a_saucers_shadow_lies_where_the_sun_casts_it(load: Load, stage: Stage, camera: Aim) -> None:
    sunny = load(FLAT.replace("strength: 0", "azimuth: 90, elevation: 45"))
    aim, height = camera(0.0, 9.0, 9.0, pitch=-42), 4.0
    stage.shot(sunny, aim)
    before = stage.shot(sunny, aim)
    saucer = sunny.world.create(Body((2.5, height, 0.0)))
    after = stage.shot(sunny, aim)
    sunny.world.delete(saucer)
    darker = (before - after).min(axis=-1) > 8.0
    darker[:, 90:] = False  # there, it is seen itself
    low, high = stage.project(aim, np.array([[2.5 - height, 0.0, 0.0], [2.5 - height + 0.9, 0.9, 0.0]]))
    rows, columns = np.nonzero(darker)
    assert darker.sum() > 60
    assert low[0] - 2.0 <= columns.mean() <= high[0]
    assert high[1] - 2.0 <= rows.mean() <= low[1] + 2.0


def test_a_shadow_on_strips_ends_where_it_ends_on_every_blade(load: Load, stage: Stage, camera: Aim) -> None:
    far = FLAT.replace("to: 4", "to: 30").replace("carpet_to: 10", "carpet_to: 40").replace("blades: 60", "blades: 400")
    sunny = load(far.replace("strength: 0", "azimuth: 90, elevation: 45"))
    aim = camera(0.0, 3.0, 16.0, pitch=-13)
    stage.shot(sunny, aim)

    def true(prairie: Prairie, aim: Camera) -> Picture:
        stage.shot(prairie, aim)  # the reference shows what the last frame did
        view, projection = stage.matrices(aim)
        return draw_truth(prairie, view, projection, stage.size, samples=3).picture.astype(float)

    def shadow(draw: Callable[[Prairie, Camera], Picture]) -> Picture:
        lit = draw(sunny, aim)
        saucer = sunny.world.create(Body((7.2, 6.0, 2.5)))
        darker = lit - draw(sunny, aim)
        sunny.world.delete(saucer)
        return np.asarray(darker.reshape(30, 3, 40, 4, 3).mean(axis=(1, 3, 4)))

    drawn, due = shadow(stage.shot), shadow(true)
    assert due.max() > 8.0
    assert np.abs(drawn - due).mean() < 0.18 * due.mean()


def test_r4_a_hill_hides_a_saucer_behind_it(load: Load, stage: Stage, camera: Aim) -> None:
    hills = load()
    heights = hills.height_at(np.column_stack([np.zeros(60), np.arange(-29.5, 30.0)]))
    top = int(heights.argmax())
    z = float(np.arange(-29.5, 30.0)[top])
    eye = camera(0.0, float(heights[top]) + 0.4, z + 1.5, pitch=-3)
    before = stage.shot(hills, eye)
    low = float(heights[top]) - 4.0
    saucer = hills.world.create(Body((0.0, low, z - 8.0)))
    np.testing.assert_array_equal(stage.shot(hills, eye), before)
    hills.world.add(saucer, Body((0.0, low + 5.5, z - 8.0)))
    assert changed(stage.shot(hills, eye), before).sum() > 100


def test_r4_grass_stands_before_a_saucer_and_hides_some_of_it(show: Show, stage: Stage, camera: Aim) -> None:
    aim = camera(0.0, 0.6, 10.0)
    low, grass = Body((0.0, 0.55, 2.0)), show(aim)
    seen = show(aim, low)
    middle = stage.project(aim, np.array([[0.0, 0.6, 2.0]]))[0].astype(int)
    around = np.s_[middle[1] - 3 : middle[1] + 4, middle[0] - 10 : middle[0] + 10]
    kept = ~changed(seen, grass)[around]
    assert 0.02 < kept.mean() < 0.98, "through the stalks it is seen in parts"
    up = camera(0.0, 3.6, 10.0, pitch=20)
    high = changed(show(up, Body((0.0, 6.3, 2.0))), show(up))
    middle = stage.project(up, np.array([[0.0, 6.3, 2.0]]))[0].astype(int)
    assert high[middle[1] - 1 : middle[1] + 2, middle[0] - 10 : middle[0] + 10].all()


def test_r4_turning_and_banking_change_what_is_seen(show: Show, camera: Aim) -> None:
    aim = camera(0.0, 4.0, 6.0, pitch=-15)
    ahead = show(aim, Body((0.0, 2.5, 0.0)))
    for other in (Body((0.0, 2.5, 0.0), yaw=pi / 4), Body((0.0, 2.5, 0.0), bank=0.3), Body((0.0, 2.5, 0.0), nose=0.3)):
        assert changed(show(aim, other), ahead).sum() > 60
    right = changed(show(aim, Body((0.0, 2.5, 0.0), bank=0.4)), show(aim))
    rows, columns = np.nonzero(right)
    assert rows[columns > 85].mean() > rows[columns < 75].mean() + 3.0, "banked to the right, the right side is lower"


def test_r4_its_outline_is_soft(show: Show, camera: Aim) -> None:
    aim = camera(0.0, 2.5, 10.0, pitch=20)
    sky, seen = show(aim), show(aim, Body((0.0, 5.5, 0.0), nose=0.2))
    difference = np.abs(seen - sky).max(axis=-1)
    full = difference > 0.0
    edge = full & ~(np.roll(full, 1, 0) & np.roll(full, -1, 0) & np.roll(full, 1, 1) & np.roll(full, -1, 1))
    assert np.median(difference[edge]) < 0.6 * np.median(difference[full & ~edge])


def test_r4_several_are_one_draw_and_none_is_none(show: Show, prairie: Prairie, camera: Aim) -> None:
    aim = camera(0.0, 2.5, 10.0)
    plain = show(aim)
    calls = prairie.statistics.draw_calls
    two = show(aim, Body((-3.0, 3.0, 0.0)), Body((3.0, 3.0, 0.0)))
    assert prairie.statistics.draw_calls == calls + 2
    seen = changed(two, plain)
    assert seen[:, :70].any()
    assert seen[:, 90:].any()
    np.testing.assert_array_equal(show(aim), plain)
    assert prairie.statistics.draw_calls == calls


def test_no_program_is_made_before_something_flies(load: Load, stage: Stage, camera: Aim) -> None:
    calm = load(FLAT)
    stage.shot(calm, camera(0.0, 1.7, 10.0))
    assert calm.painter is not None
    assert calm.painter.part(BodiesPart).painter is None


class Rotor(WindPrimitive):
    """A plugin's wind that flies past and bends no grass, so that only its body is seen."""

    kind: str = "rotor"

    def hover(self) -> Hover:
        return Hover(height=3.0)

    def pose(self, *, time: float) -> Pose:
        return Pose(2.0 * time - 1.0, 0.0, 0.4)

    def mask(self, place: NDArray[np.float32], /, *, time: float) -> NDArray[np.float32]:
        return np.zeros(len(place), np.float32)

    def action(self, place: NDArray[np.float32], /, *, time: float, seed: int, grass: Grass) -> NDArray[np.float32]:
        return np.zeros_like(place)


def test_r4_what_hovers_over_a_strangers_wind_is_drawn_where_it_flies(
    show: Show, prairie: Prairie, camera: Aim
) -> None:
    aim = camera(0.0, 2.5, 10.0, pitch=5)
    rotor = Rotor()
    there = carried(lambda time: rotor.pose(time=time), prairie.time, prairie.site.top_at, height=3.0)
    expected = show(aim, there)
    handle = prairie.add(rotor)
    seen = show(aim)
    prairie.remove(handle)
    np.testing.assert_array_equal(seen, expected)
    assert changed(seen, show(aim)).sum() > 60


def test_d6_a_saucer_leaves_no_state_in_gl(show: Show, ctx: moderngl.Context, stage: Stage, camera: Aim) -> None:
    aim, body = camera(0.0, 2.5, 10.0), Body((0.0, 3.0, 0.0))
    first = show(aim, body)
    np.testing.assert_array_equal(show(aim, body), first)
    assert ctx.detect_framebuffer().glo == stage.target.glo
    assert stage.target.depth_mask
    assert ctx.error == "GL_NO_ERROR"
