"""A picture with winds that fail equals the picture without them."""

from itertools import count
from typing import Any

import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, WindPrimitive
from tallgrass.systems.reference import draw_truth
from tallgrass.systems.wind import quarantine
from tallgrass.testing import looking

Load = Any
Stage = Any


class Raising(WindPrimitive):
    """A wind that fails in a later frame."""

    kind: str = "raising"
    priority: int = 90

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        raise LookupError(f"{len(place)} places")


class Lost(Raising):
    """A wind whose pose is not finite."""

    kind: str = "lost"

    def pose(self, *, time: float) -> Any:
        return None


class Undefined(Raising):
    """A wind that returns NaN from some time on."""

    kind: str = "undefined"

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return place * np.float32(np.nan)


def test_a_frame_with_failing_winds_is_the_frame_without_them(
    load: Load, stage: Stage, caplog: pytest.LogCaptureFixture
) -> None:
    calm, troubled = load(), load()
    for wind in (Raising(), Lost(), Undefined(start=0.5)):
        troubled.add(wind)
    for told in (2, 3, 3):
        np.testing.assert_array_equal(stage.shot(troubled), stage.shot(calm))
        assert len(caplog.messages) == told
        for prairie in (calm, troubled):
            prairie.advance(0.5)
    assert [message.partition(" of ")[0] for message in caplog.messages] == ["lost", "raising", "undefined"]


class Undated(Raising):
    """A wind whose `ends` fails."""

    kind: str = "undated"

    def ends(self) -> float:
        return float("nan")


def test_a_wind_that_ends_at_no_time_is_told_of(load: Load, caplog: pytest.LogCaptureFixture) -> None:
    prairie = load()
    prairie.add(Undated())
    prairie.wind_at([(0, 0)])
    assert prairie.wind_failures == {"undated": "undated: ends returned numbers that are not finite"}
    assert len(caplog.messages) == 1


class Steady(Raising):
    """A wind that never fails."""

    kind: str = "steady"
    swing: float = 0.0

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.full_like(place, [0.5, 0.0])


def test_a_reference_is_drawn_in_all_winds_however_slow_they_are(
    load: Load, stage: Stage, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    prairie = load()
    prairie.add(Steady())
    stage.shot(prairie)
    view, projection = stage.matrices(looking(0.0, 1.7, 20.0, pitch=-12))
    stage.target.use()
    quick = draw_truth(prairie, view, projection, stage.size, samples=1).picture
    readings = count()
    monkeypatch.setattr(quarantine, "thread_time", lambda: 5.0 * next(readings))
    np.testing.assert_array_equal(draw_truth(prairie, view, projection, stage.size, samples=1).picture, quick)
    assert not prairie.winds.quarantine.reasons
    assert len(caplog.messages) == 1
    stage.shot(prairie)
    assert len(prairie.winds.quarantine.reasons) == 1
    ((name, why),) = prairie.wind_failures.items()
    assert name == "steady"
    assert why.startswith("steady: ")
    assert "takes too long" in why
