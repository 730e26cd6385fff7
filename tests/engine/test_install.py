"""Prairies advanced by the game's own esper world after `install` (D6)."""

import esper
import numpy as np
import pytest

from tallgrass.engine.world import Advance, World, install


class Order(esper.Processor):
    """A game's own processor, which records the prairies' time when it runs."""

    def __init__(self, steps: list[float]) -> None:
        self.steps = steps
        self.seen: list[float] = []

    def process(self, *args: object, **options: object) -> None:
        self.seen.append(sum(self.steps))


@pytest.fixture
def steps(world: World) -> list[float]:
    """Steps [s] by which a prairie in the world was advanced."""
    told: list[float] = []
    world.advance = told.append
    return told


def test_d6_installed_a_world_advances_its_prairies_before_the_games_own_processors(
    steps: list[float],
) -> None:
    order = Order(steps)
    esper.add_processor(order)
    install()
    esper.process(0.25)
    esper.process(dt=0.5)
    esper.process(0.125, "what else a game hands around", paused=False)
    esper.process()
    assert steps == [0.25, 0.5, 0.125]
    assert order.seen == [0.25, 0.75, 0.875, 0.875]


def test_d6_installing_twice_advances_once(steps: list[float]) -> None:
    install()
    install()
    esper.process(0.1)
    assert steps == [0.1]


def test_d6_only_prairies_of_the_current_world_are_advanced(world: World, steps: list[float], elsewhere: str) -> None:
    esper.switch_world(world.name)
    install()
    esper.switch_world(elsewhere)
    install()
    esper.process(0.1)
    assert steps == []


def test_d6_a_step_that_is_no_time_is_refused_in_a_sentence(world: World) -> None:
    install()
    assert world.advance is None
    with pytest.raises(TypeError, match=r"tallgrass needs dt \[s\] first, not 'a game'"):
        esper.process("a game")


@pytest.mark.parametrize("dt", [1, 0.5, np.float32(0.5), np.int64(1)])
def test_d6_a_step_may_be_any_number_and_comes_to_prairies_as_a_float(steps: list[float], dt: float) -> None:
    install()
    esper.process(dt)
    assert [(type(step), step) for step in steps] == [(float, dt)]


def test_d6_the_processor_leaves_with_the_worlds_last_prairie(world: World, steps: list[float]) -> None:
    other = World()
    own = Order(steps)
    esper.add_processor(own, 3)
    install()
    other.release()
    assert esper.get_processor(Advance) is not None
    world.release()
    world.release()
    assert esper.get_processor(Advance) is None
    assert esper.get_processor(Order) is own
    esper.process(0.1)
    assert own.seen == [0]
    esper.remove_processor(Order)


def test_d6_a_second_release_takes_no_other_prairies_processor_away(world: World) -> None:
    world.release()
    World()
    kept = World()
    install()
    world.release()
    assert esper.get_processor(Advance) is not None
    kept.release()
