"""Paths that pressers wear (F4)."""

from collections.abc import Iterator
from time import process_time

import esper
import numpy as np
import pytest

from tallgrass import Pose, Presser
from tallgrass.components.arrays import Floats
from tallgrass.engine.world import World
from tallgrass.systems.mow.worn import Step, wear
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import little_prairie

AROUND = np.stack(np.meshgrid(np.linspace(-9.0, 9.0, 60), np.linspace(-9.0, 9.0, 60)), -1).reshape(-1, 2)


@pytest.fixture
def prairie(world: World) -> Iterator[Prairie]:
    del world  # it is made the current one
    with little_prairie() as made:
        yield made


TYRE = [(-0.02, -0.3), (0.02, -0.3), (0.02, 0.3), (-0.02, 0.3)]


@pytest.mark.parametrize(
    "presser",
    [Presser(radius=0.02, wear=0.2), Presser(radius=0.1, wear=0.2), Presser(corners=TYRE, wear=0.2)],
    ids=["least", "narrow", "tyre"],
)
def test_f4_however_narrow_a_presser_is_it_wears_off_no_more_than_it_says(prairie: Prairie, presser: Presser) -> None:
    way = np.stack([np.linspace(-1.0, 1.0, 41), np.full(41, 0.1)], axis=1)
    before, walker = prairie.grass_at(way).density.sum(axis=1), esper.create_entity(presser)
    for x in np.arange(-1.5, 1.5, 0.05):
        esper.add_component(walker, Pose(float(x), 0.1, np.pi / 2))
        prairie.advance(0.05)
        prairie.bent_at([(0.0, 0.0)])
    worn = 1.0 - prairie.grass_at(way).density.sum(axis=1) / before
    assert worn.min() > 0.05
    assert worn.max() < 0.22


def test_f4_a_fast_wheel_wears_off_what_it_treads_also_in_few_frames_and_who_jumps_neither(prairie: Prairie) -> None:
    """At 55 m/s and ten frames a second it goes 5.5 m in a frame."""
    wheel = esper.create_entity(Presser(radius=0.2, wear=0.2), Pose(-18.0, 3.0))
    way = np.stack([np.linspace(-14.0, 14.0, 29), np.full(29, 3.0)], axis=1)
    before = prairie.grass_at(way).density.sum(axis=1)
    for x in np.arange(-18.0, 18.5, 5.5):
        esper.add_component(wheel, Pose(float(x), 3.0))
        prairie.advance(0.1)
        trodden = prairie.bent_at(way)
    assert np.hypot(*trodden.T).min() > 0.2
    assert (prairie.grass_at(way).density.sum(axis=1) / before).max() < 0.9
    esper.add_component(wheel, Pose(18.0, -3.0))
    prairie.bent_at(way)
    esper.add_component(wheel, Pose(-18.0, -3.0))
    assert np.hypot(*prairie.bent_at(way * (1.0, -1.0)).T).max() == 0.0
    assert (prairie.grass_at(way * (1.0, -1.0)).density.sum(axis=1) > 0.95).all()


def test_f4_many_steps_wear_the_same_together_as_one_by_one_and_cost_far_less(prairie: Prairie) -> None:
    """As with the wheels of many cars."""
    random, density = np.random.default_rng(2), prairie.site.ground.density
    steps = [
        Step(x, z, np.sin(yaw), -np.cos(yaw), half, 2.0 * half, 0.3)
        for x, z, yaw, half in random.uniform((-9.0, -9.0, -3.0, 0.1), (9.0, 9.0, 3.0, 0.6), (300, 4))
    ]
    before, times, worn = prairie.state(), list[float](), list[Floats]()
    for parts in ([[step] for step in steps], [steps]):
        prairie.restore(before)
        began = process_time()
        for part in parts:
            wear(density, part)
        times.append(process_time() - began)
        worn.append(prairie.grass_at(AROUND).density)
    np.testing.assert_array_equal(worn[0], worn[1])
    assert worn[0].min() < 0.2
    assert times[1] < 0.3 * times[0]


def test_n5_whoever_wears_a_path_goes_on_with_it_where_a_state_left_it(prairie: Prairie) -> None:
    again = Prairie.load(prairie.scene)
    walker = esper.create_entity(Presser(radius=0.4, wear=0.2))
    for step in range(40):
        esper.add_component(walker, Pose(0.0, 0.1 * step))
        prairie.bent_at([(0.0, 0.0)])
        if step == 13:  # a quarter of a step after the third that is worn as a whole
            again.restore(prairie.state(), {walker: walker})
        elif step > 13:
            again.bent_at([(0.0, 0.0)])
    way = np.stack([np.zeros(50), np.linspace(0.0, 4.0, 50)], axis=1)
    worn, too = (each.grass_at(way).density for each in (prairie, again))
    assert (worn.min(), worn.max()) == pytest.approx((0.4, 0.5), abs=0.01)
    np.testing.assert_array_equal(worn, too)
    again.release()
