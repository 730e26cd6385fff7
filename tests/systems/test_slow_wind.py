"""A game does without a plugin's slow wind for a while, by the prairie's own clock; a film never does."""

from collections.abc import Callable, Iterator
from itertools import count
from pathlib import Path

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.engine.world import World
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind import quarantine
from tallgrass.systems.wind.quarantine import PATIENCE, WAIT
from tallgrass.testing import LITTLE

Floats = NDArray[np.float32]
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
    """Load a prairie in the draught, where every call takes a fifth of a second by the processor's clock."""
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


def test_a_slow_wind_that_is_taken_away_while_it_is_left_out_is_no_harm(load: Load) -> None:
    prairie = load()
    handle = prairie.add(Draught(), name="another")
    for _ in range(PATIENCE):
        is_felt(prairie)
    prairie.remove(handle)
    prairie.advance(2.0 * WAIT)
    assert is_felt(prairie)
