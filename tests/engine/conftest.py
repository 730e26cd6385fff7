"""What the tests of the engine share: a second world of the game's."""

from collections.abc import Iterator

import esper
import pytest

from tallgrass.engine.world import World


@pytest.fixture
def elsewhere(world: World) -> Iterator[str]:
    """The game shows its menu, which is another world."""
    esper.switch_world("menu")
    yield "menu"
    esper.switch_world(world.name)
    esper.delete_world("menu")
