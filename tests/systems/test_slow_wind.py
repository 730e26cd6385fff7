"""A plugin's slow wind is left out of a game for a while, by the prairie's own clock; never of a film."""

from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path
from weakref import ref

import esper
import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive, WindSource
from tallgrass.engine.schedule import PATIENCE
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind import quarantine
from tallgrass.systems.wind.quarantine import WAIT
from tallgrass.testing import LITTLE, little_prairie

Load = Callable[..., Prairie]
HERE = [(0.0, 0.0)]


class Draught(WindPrimitive):
    """A plugin's wind to the right, everywhere."""

    kind: str = "draught"
    swing: float = 0.0

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, [0.25, 0.0])


@pytest.fixture
def load(world: World, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Load]:
    """Return the function that loads a prairie with a wind whose every call takes 0.2 s of processor time."""
    assert world.name == esper.current_world
    readings = count()
    monkeypatch.setattr(quarantine, "thread_time", lambda: 0.2 * next(readings))
    (tmp_path / "scene.yaml").write_text(LITTLE)
    loaded: list[Prairie] = []

    def scene(**options: bool) -> Prairie:
        loaded.append(Prairie.load(tmp_path / "scene.yaml", **options))  # type: ignore[arg-type]
        loaded[-1].add(Draught())
        return loaded[-1]

    yield scene
    for prairie in loaded:
        prairie.release()


def is_felt(prairie: Prairie) -> bool:
    return bool(prairie.wind_at(HERE).any())


def test_in_a_game_a_slow_wind_is_left_out_and_comes_back_by_the_prairies_clock(
    load: Load, caplog: pytest.LogCaptureFixture
) -> None:
    prairie = load()
    for wait in (WAIT, 2.0 * WAIT):
        assert [is_felt(prairie) for _ in range(PATIENCE)] == [True] * (PATIENCE - 1) + [False]
        assert len(prairie.winds.quarantine.reasons) == 1
        prairie.advance(wait - 0.1)
        assert not is_felt(prairie)
        prairie.advance(0.2)
    assert is_felt(prairie)
    assert not prairie.winds.quarantine.reasons
    assert len(caplog.messages) == 1


def test_in_a_film_a_slow_wind_stays_and_is_told_of_once(load: Load, caplog: pytest.LogCaptureFixture) -> None:
    prairie = load(live=False)
    other = prairie.reseeded(8)
    other.add(Draught())
    for one in (prairie, other):
        assert all(is_felt(one) for _ in range(10))
        assert not one.winds.quarantine.reasons
    other.release()
    assert len(caplog.messages) == 2


def test_a_slow_wind_that_is_given_other_values_in_every_frame_is_left_out_as_well(load: Load) -> None:
    prairie = load()
    entity = esper.create_entity(WindSource(Draught(), "music"))
    prairie.remove(next(handle for handle, source in esper.get_component(WindSource) if source.name == "draught"))

    def felt_with(weight: float) -> bool:
        esper.add_component(entity, WindSource(Draught(weight=weight), "music"))
        return is_felt(prairie)

    assert [felt_with(0.1 * number) for number in range(1, PATIENCE + 3)] == [True] * (PATIENCE - 1) + [False] * 3
    prairie.advance(WAIT + 0.1)
    assert felt_with(1.0)


def test_winds_that_a_game_replaces_in_every_frame_are_not_kept(world: World, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither their times nor the reasons for leaving them out."""
    del world
    readings = count()
    monkeypatch.setattr(quarantine, "thread_time", lambda: 0.03 * next(readings))
    gone: list[ref[WindSource]] = []
    with little_prairie() as prairie:
        entities = esper.create_entity(), esper.create_entity()
        for number in range(1, 20):
            for entity, values in zip(entities, ({}, {"swing": float("nan")}), strict=True):
                weak = Draught(weight=0.05 * number).model_copy(update=values)
                esper.add_component(entity, WindSource(weak, f"wind {entity}"))
                gone.append(ref(esper.component_for_entity(entity, WindSource)))
            prairie.wind_at(HERE)
            prairie.advance(0.1)
        assert sum(source() is not None for source in gone) <= len(entities) + 1


def test_a_slow_wind_that_is_taken_away_while_it_is_left_out_is_no_harm(load: Load) -> None:
    prairie = load()
    handle = prairie.add(Draught(), name="another")
    for _ in range(PATIENCE):
        is_felt(prairie)
    prairie.remove(handle)
    prairie.advance(2.0 * WAIT)
    assert is_felt(prairie)


@pytest.mark.parametrize("live", [True, False])
def test_a_wind_that_waits_is_named_once_and_in_a_game_left_out_at_the_third_time(
    world: World, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, tmp_path: Path, *, live: bool
) -> None:
    """Waiting for a disk or a socket takes no processor time, but makes the game stand still."""
    del world
    waited = [0.0]
    monkeypatch.setattr(quarantine, "perf_counter", lambda: waited[0])

    class Socket(Draught):
        """A wind that waits for an answer about its strength."""

        kind: str = "socket"

        def extent(self, *, time: float) -> None:
            waited[0] += 5.0

    (tmp_path / "scene.yaml").write_text(LITTLE)
    prairie = Prairie.load(tmp_path / "scene.yaml", live=live)
    prairie.add(Socket())
    felt = [is_felt(prairie) for _ in range(PATIENCE + 2)]
    assert felt == [True] * (PATIENCE - 1) + [not live] * 3
    assert sum("extent waits: for 5.0 s" in message for message in caplog.messages) == 1
    assert len(caplog.messages) == 1 + live
    prairie.advance(WAIT + 0.1)
    assert is_felt(prairie)
    prairie.release()
