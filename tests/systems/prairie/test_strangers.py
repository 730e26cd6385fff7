"""A stranger's wind that changes more than it may is named, and the change is undone or refused."""

from typing import Any, Literal

import esper
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.systems.prairie import Prairie
from tallgrass.systems.wind.breeze import Breeze


class Wandering(Breeze):
    """A stranger's wind that leaves another esper world current."""

    kind: Literal["wandering"] = "wandering"  # type: ignore[assignment]

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        esper.switch_world("next level")
        return super().mask(place, time=time)


def test_a_wind_that_leaves_another_esper_world_current_is_left_out_and_the_prairies_comes_back(
    prairie: Prairie, caplog: pytest.LogCaptureFixture
) -> None:
    home = esper.current_world
    prairie.add(Wandering())
    try:
        for _ in range(2):
            prairie.wind_at([(0.0, 0.0)])
        assert esper.current_world == home
    finally:
        esper.switch_world(home)
        esper.delete_world("next level")
    left = f"mask left esper world 'next level' current in place of '{home}'"
    assert prairie.wind_failures == {"wandering": f"wandering: {left}"}
    assert [message.partition("; ")[2] for message in caplog.messages] == ["this wind is left out from now on"]


class Releasing(Breeze):
    """A stranger's wind that releases the prairie on which it blows."""

    kind: Literal["releasing"] = "releasing"  # type: ignore[assignment]
    on: Any = None

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        self.on.release()
        return super().mask(place, time=time)


def test_a_wind_that_releases_its_prairie_is_left_out_and_the_prairie_stays(prairie: Prairie) -> None:
    prairie.add(Releasing(on=prairie))
    prairie.wind_at([(0.0, 0.0)])
    refused = "a wind of this prairie is being asked: it cannot release it; do so before or after"
    assert prairie.wind_failures == {"releasing": f"releasing: mask raised RuntimeError: {refused}"}
    prairie.release()
