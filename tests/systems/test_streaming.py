"""The window of streamed ground moves on beside the frames (N11, D6)."""

from collections.abc import Iterator
from pathlib import Path
from threading import Event
from typing import Any

import numpy as np
import pytest

from tallgrass import Viewer
from tallgrass.engine.declared.terrain import TerrainSource
from tallgrass.engine.terrain.change import set_heights
from tallgrass.engine.terrain.load import load_terrain
from tallgrass.engine.terrain.record import Terrain
from tallgrass.engine.terrain.sample import height_at
from tallgrass.engine.terrain.stream import window_of
from tallgrass.systems import streaming
from tallgrass.systems.streaming import Streaming

EYE = 112.0, 2.0, 0.0
"""Place of a viewer at which the window just has to move."""


def level(x: Any, z: Any) -> Any:
    return 0.0 * x * z


@pytest.fixture
def terrain() -> Terrain:
    source = TerrainSource.model_validate({"heights": level, "window": 1024.0, "cell": 2.0})
    return load_terrain(source, Path(), about=(0.0, 0.0))


@pytest.fixture
def window(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[Event, Event]]:
    """Events: a window has been made, and may be used."""
    is_made, may_come = Event(), Event()

    def slowly(*asked: Any) -> Terrain:
        made = window_of(*asked)
        is_made.set()
        assert may_come.wait(10.0)
        return made

    monkeypatch.setattr(streaming, "window_of", slowly)
    yield is_made, may_come
    may_come.set()


def test_n11_nobody_waits_for_ground_ahead_and_what_is_dug_meanwhile_is_in_it(
    terrain: Terrain, window: tuple[Event, Event]
) -> None:
    follows, before, (is_made, may_come) = Streaming(live=True), terrain.first, window
    follows.follow(terrain, EYE, [], time=0.0)
    assert terrain.first == before
    assert is_made.wait(10.0)
    set_heights(terrain, (EYE[0], EYE[2]), np.full((5, 5), 7.0, np.float32))
    may_come.set()
    while terrain.first == before:
        follows.follow(terrain, EYE, [], time=0.0)
    follows.release()
    assert height_at(terrain, np.array([[EYE[0] + 4.0, EYE[2] + 4.0]], np.float32))[0] == 7.0


@pytest.mark.parametrize(
    ("others", "middle"),
    [
        pytest.param([((4200.0, 2.0, 0.0), 5.0)], (4100.0, 0.0), id="two near one another"),
        pytest.param([((0.0, 2.0, 0.0), 5.0)], (4000.0, 0.0), id="one who has been left far behind"),
        pytest.param([((4400.0, 2.0, 0.0), 1.0)], (4000.0, 0.0), id="one who looks no more"),
    ],
)
def test_t1_who_looks_stands_on_ground_wherever_others_have_looked_from(
    terrain: Terrain, others: list[tuple[tuple[float, float, float], float]], middle: tuple[float, float]
) -> None:
    follows = Streaming(live=True)
    follows.follow(terrain, (4000.0, 2.0, 0.0), [Viewer("map", eye=eye, time=at) for eye, at in others], time=5.0)
    follows.release()
    found = np.array(terrain.origin) + 0.5 * np.array(terrain.size)
    np.testing.assert_allclose(found, middle, atol=64.0)
