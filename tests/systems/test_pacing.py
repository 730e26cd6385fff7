"""Standing on a limit of representations, and pacing across it (X1, F1)."""

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from tallgrass.engine.terrain.record import Terrain
from tallgrass.systems.around.outlook import Outlook
from tallgrass.systems.site import Site
from tallgrass.systems.transition import FADE

Laid = Callable[..., Site]
Look = Callable[..., Outlook]

FLAT = Terrain(np.zeros((81, 81), np.float32), 1.0)
STEP = 0.1
PERIOD = 3.0


def changing(outlook: Outlook) -> int:
    """Return the number of visible patches that change representation or sub-level."""
    patches = outlook.patches
    going = (patches.progress < 1.0) | (patches.sublevel_progress < 1.0).any(axis=0)
    return int((patches.shown & going).sum())


def standing() -> Iterator[float]:
    """Return the place of a walker that stands."""
    yield from (2.5 for _ in range(600))


def pacing() -> Iterator[float]:
    """Return the place of a walker that paces half a metre to and fro."""
    yield from (2.5 + 0.25 * np.sin(time * STEP * 2.0 * np.pi / PERIOD) for time in range(600))


@pytest.mark.parametrize("way", [standing, pacing])
def test_x1_a_minute_on_a_limit_leaves_nothing_in_transition_after_one_duration(
    laid: Laid, look: Look, way: Callable[[], Iterator[float]]
) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.3, 2.6, yaw=0.8)
    seen = [changing(look(site, 1.3, z, yaw=0.8, dt=STEP)) for z in way()]
    once = round((PERIOD if way is pacing else 0.0) / STEP)
    assert (max(np.diff(seen)) > 0) == (way is pacing), "who stands starts nothing more"
    assert max(seen[once + round(FADE / STEP) + 1 :]) == 0


def test_x1_a_teleport_settles_everything_at_once(laid: Laid, look: Look) -> None:
    site = laid(terrain=FLAT)
    look(site, 1.3, 2.6)
    look(site, 1.3, 2.4, dt=STEP)
    assert changing(look(site, 1.3, 2.4, dt=STEP)) > 3
    assert changing(look(site, 21.3, -9.0, dt=STEP, jumped=True)) == 0
