"""Fixtures of tests of the engine: a second esper world."""

from collections.abc import Iterator

import esper
import pytest

from tallgrass.engine.world import World


@pytest.fixture
def elsewhere(world: World) -> Iterator[str]:
    """Name of another current world, as when a game shows its menu."""
    esper.switch_world("menu")
    yield "menu"
    esper.switch_world(world.name)
    esper.delete_world("menu")
