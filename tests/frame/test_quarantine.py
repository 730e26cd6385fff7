"""A picture with winds that fail is the picture without them."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.components.wind import Grass, WindPrimitive

Floats = NDArray[np.float32]
Load = Any
Stage = Any


class Raising(WindPrimitive):
    """A wind that fails in a frame like any other."""

    kind: str = "raising"
    priority: int = 90

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        raise LookupError(f"{len(place)} places")


class Lost(Raising):
    """A wind that is nowhere."""

    kind: str = "lost"

    def pose(self, *, time: float) -> Any:
        return None


class Undefined(Raising):
    """A wind of no numbers, from some instant on."""

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
