"""Receivers as entities: one per patch and representation that feels wind (D2, W1)."""

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.receivers import Receivers
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.world import World
from tallgrass.systems.around.receivers import ReceiverEntities
from tallgrass.systems.field import Field
from tallgrass.systems.receive import blow
from tallgrass.systems.show.blades.pool import BladePool
from tallgrass.systems.show.seen import Seen
from tallgrass.systems.show.strips.pool import StripPool
from tallgrass.systems.wind.blow import Listeners
from tallgrass.systems.wind.breeze import Breeze

Hear = Callable[[Listeners], NDArray[np.float32]]
Looking = Callable[..., Seen]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)


@pytest.fixture
def field(laid: Callable[..., Field]) -> Field:
    return laid(terrain=FLAT)


@pytest.fixture
def looking(world: World, field: Field, look: Callable[..., Seen]) -> Looking:
    """Look, and let the entities follow."""
    keeper = ReceiverEntities(world, field)

    def at(x: float, z: float, *, yaw: float | None = None, dt: float = 1e9) -> Seen:
        seen = look(field, x, z, yaw=yaw, dt=dt)
        keeper.follow(seen.standing, seen.strips)
        return seen

    return at


def test_d2_there_is_one_entity_for_each_patch_and_representation_that_is_shown(world: World, looking: Looking) -> None:
    for x, z, yaw in ((1.0, 1.0, None), (4.0, 1.0, None), (4.0, 1.0, 0.3), (-9.0, 6.0, 2.0), (1.0, 1.0, None)):
        seen = looking(x, z, yaw=yaw)
        strips = seen.strips
        found = [receivers for _, receivers in world.all(Receivers)]
        assert len(found) == sum(len(ring.rows) for ring in (seen.standing, *strips))
        sizes = sorted(len(receivers.place) for receivers in found)
        expected = [len(seen.standing.rows) * [42]]
        expected += [len(strips[0].rows) * [2 * 3 * 3], len(strips[1].rows) * [2 * 2 * 2]]
        assert sizes == sorted(size for ring in expected for size in ring)


def test_d2_a_patch_in_a_change_has_receivers_in_both_representations(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    settled = len(world.all(Receivers))
    looking(6.1, 1.0, dt=0.0)
    looking(6.1, 1.0, dt=0.1)
    assert len(world.all(Receivers)) > settled


def test_d2_the_arrays_are_slices_of_the_pools(
    world: World, field: Field, looking: Looking, wind: Callable[..., Hear]
) -> None:
    seen = looking(1.0, 1.0)
    blow(field, seen.standing, seen.strips, wind(Breeze(), time=1.0))
    pools: list[BladePool | StripPool] = [field.blades, *field.strips]
    for _, receivers in world.all(Receivers):
        assert receivers.place.shape == receivers.message.shape
        assert sum(np.shares_memory(receivers.place, pool.place) for pool in pools) == 1
        assert sum(np.shares_memory(receivers.message, pool.message) for pool in pools) == 1
        assert np.linalg.norm(receivers.message, axis=1).mean() > 0.05
    field.blades.message[:] = 0.25
    told = [
        receivers for _, receivers in world.all(Receivers) if np.shares_memory(receivers.message, field.blades.message)
    ]
    assert len(told) == 25
    assert all((receivers.message == 0.25).all() for receivers in told)


def test_d2_a_game_may_bend_single_receivers_itself(world: World, field: Field, looking: Looking) -> None:
    looking(1.0, 1.0)
    before = field.blades.message.copy()
    entity, receivers = world.all(Receivers)[0]
    receivers.message[3] = (0.6, -0.2)
    assert (field.blades.message != before).any(axis=-1).sum() == 1
    assert world.get(entity, Receivers) is receivers


def test_an_entity_lives_as_long_as_its_patch_is_shown(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    first = {entity for entity, _ in world.all(Receivers)}
    looking(1.5, 1.5)
    assert {entity for entity, _ in world.all(Receivers)} == first
    looking(1.5, 1.5, yaw=0.0)
    ahead = {entity for entity, _ in world.all(Receivers)}
    assert ahead < first
    looking(1.5, 1.5)
    again = {entity for entity, _ in world.all(Receivers)}
    assert ahead < again
    assert len(again) == len(first)
    assert not (again - ahead) & first


def test_an_entitys_places_stay_on_one_patch(world: World, looking: Looking) -> None:
    homes: dict[int, NDArray[np.float32]] = {}
    for step in range(10):
        looking(2.0 * step - 9.0, 1.4 * step - 7.0, dt=0.3)
        for entity, receivers in world.all(Receivers):
            middle = receivers.place.mean(axis=0)
            assert np.abs(middle - homes.setdefault(entity, middle)).max() < 1.0
            assert np.ptp(receivers.place, axis=0).max() < 2.5 + 1.5


def test_released_nothing_of_ours_is_left(world: World, looking: Looking) -> None:
    looking(1.0, 1.0)
    world.release()
    assert world.all(Receivers) == []
