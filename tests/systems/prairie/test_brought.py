"""Entities that packages make while a prairie is made come back once, and not beside themselves (F4)."""

from collections.abc import Callable
from typing import Any

import esper
import pytest

from tallgrass.components.pose import Pose
from tallgrass.components.presser import Presser
from tallgrass.systems import prairie as prairie_module
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import private_world

SCENE = {"tallgrass": 2, "grass": {"green": {}}, "quality": "minimal"}


@pytest.fixture
def herds(monkeypatch: pytest.MonkeyPatch) -> list[list[int]]:
    """Install a package that brings three deer; return those that it has made for each prairie."""
    made = list[list[int]]()

    def bring(_: object, __: object, within: Callable[[str], Any]) -> None:
        with within("deer"):
            made.append([esper.create_entity(Presser(radius=0.3), Pose(x, 0.0)) for x in (1.0, 2.0, 3.0)])

    monkeypatch.setattr(prairie_module, "bring_systems", bring)
    return made


def ways() -> list[float]:
    """Return where all pressers are."""
    return sorted(pose.x for _, (_, pose) in esper.get_components(Presser, Pose))


def test_what_a_package_brings_is_found_again_whatever_numbers_its_entities_have(herds: list[list[int]]) -> None:
    with private_world():
        made = Prairie.load(SCENE)
        man = esper.create_entity(Presser(), Pose(9.0, 9.0))
        esper.delete_entity(herds[0][0], immediate=True)
        esper.add_component(herds[0][2], Pose(7.0, 0.0))
        state = made.state()
        made.release()
    for others in (0, 1, 2):
        with private_world():
            for _ in range(others):
                esper.create_entity()
            made = Prairie.load(SCENE)
            entities = made.restore(state)
            assert [entities[entity] for entity in herds[0][1:]] == herds[-1][1:]
            assert entities[man] not in herds[-1]
            assert ways() == [1.0, 2.0, 7.0, 9.0]
            again = made.restore(made.state())
            assert again[entities[man]] == entities[man]
            assert ways() == [1.0, 2.0, 7.0, 9.0]
            made.release()


def test_what_a_package_brought_that_is_no_longer_there_is_made_anew(
    herds: list[list[int]], monkeypatch: pytest.MonkeyPatch
) -> None:
    with private_world():
        made = Prairie.load(SCENE)
        state = made.state()
        made.release()
    monkeypatch.setattr(prairie_module, "bring_systems", lambda *_: None)
    with private_world():
        made = Prairie.load(SCENE)
        assert set(made.restore(state)) == set(herds[0])
        assert ways() == [1.0, 2.0, 3.0]
        made.release()
