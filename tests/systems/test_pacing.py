"""Standing on a limit and pacing across it (X1, F1)."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.field import Field
from tallgrass.systems.lod import FADE
from tallgrass.systems.show.seen import Seen

Laid = Callable[..., Field]
Look = Callable[..., Seen]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
STEP = 0.1
PERIOD = 3.0


def changing(field: Field) -> int:
    """How many patches in view are on their way to another representation or sub-level."""
    table = field.table
    going = (table.progress < 1.0) | (table.sublevel_progress < 1.0).any(axis=0)
    return int((table.alive & table.visible & going).sum())


def standing() -> Iterator[float]:
    """Where a walker is who does not move."""
    yield from (2.5 for _ in range(600))


def pacing() -> Iterator[float]:
    """Where one is who paces half a metre to and fro."""
    yield from (2.5 + 0.25 * np.sin(time * STEP * 2.0 * np.pi / PERIOD) for time in range(600))


@pytest.mark.parametrize("way", [standing, pacing])
@pytest.mark.parametrize("yaw", [0.0, 0.8, 2.3])
def test_x1_a_minute_on_a_limit_leaves_nothing_in_transition_after_one_duration(
    laid: Laid, look: Look, way: Callable[[], Iterator[float]], yaw: float
) -> None:
    field = laid(terrain=FLAT)
    look(field, 1.3, 2.6, yaw=yaw)
    seen = []
    for z in way():
        look(field, 1.3, z, yaw=yaw, dt=STEP)
        seen.append(changing(field))
    once = round((PERIOD if way is pacing else 0.0) / STEP)
    assert (max(seen) > 0) == (way is pacing)
    assert max(seen[once + round(FADE / STEP) + 1 :]) == 0


def test_x1_a_teleport_settles_everything_at_once(laid: Laid, look: Look) -> None:
    field = laid(terrain=FLAT)
    look(field, 1.3, 2.6)
    look(field, 1.3, 2.4, dt=STEP)
    look(field, 1.3, 2.4, dt=STEP)
    assert changing(field) > 3
    look(field, 21.3, -9.0, dt=STEP, jumped=True)
    assert changing(field) == 0
