"""Response of grass to a wind that starts and stops (W4, W12)."""

from collections.abc import Callable
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.components.wind import Grass
from tallgrass.systems.grow.record import Response

Answer = Callable[..., Grass]


def simulated(response: Response, curve: NDArray[Any], elapsed: NDArray[np.float32]) -> NDArray[np.float64]:
    index: NDArray[np.float64] = np.interp(
        elapsed.astype(float), np.arange(len(curve)) * float(response.step), curve.astype(float)
    )
    return index


@given(kind=st.integers(0, 1), elapsed=st.lists(st.floats(-5.0, 60.0, width=32), min_size=1, max_size=30))
def test_w4_grass_reads_the_curves_that_the_simulation_gave(
    responses: list[Response], answer: Answer, kind: int, elapsed: list[float]
) -> None:
    times, grass = np.array(elapsed, np.float32), answer(len(elapsed), kind=kind)
    response = responses[kind]
    np.testing.assert_allclose(grass.after_start(times), simulated(response, response.rise, times), atol=2e-4)
    np.testing.assert_allclose(grass.after_stop(times), simulated(response, response.fall, times), atol=2e-4)


def test_w4_it_overshoots_and_settles_after_a_start_and_swings_past_rest_after_a_stop(answer: Answer) -> None:
    for kind in (0, 1):
        times = np.linspace(-1.0, 40.0, 4000, dtype=np.float32)
        grass = answer(len(times), kind=kind)
        rise, fall = grass.after_start(times), grass.after_stop(times)
        assert (rise[times <= 0.0] == 0.0).all()
        assert (fall[times <= 0.0] > 0.999).all()
        assert rise.max() > 1.05
        assert fall.min() < -0.05
        np.testing.assert_allclose([rise[-1], fall[-1]], [1.0, 0.0], atol=1e-3)


def test_w12_each_receiver_is_answered_for_by_its_own_kind(answer: Answer) -> None:
    times = np.linspace(0.0, 3.0, 50, dtype=np.float32)
    soft, stiff = answer(50, kind=0), answer(50, kind=1)
    mixed = Grass(np.arange(50) % 2, soft.step, soft.rise, soft.fall)
    both = np.where(np.arange(50) % 2, stiff.after_start(times), soft.after_start(times))
    np.testing.assert_array_equal(mixed.after_start(times), both)
    assert np.abs(soft.after_start(times) - stiff.after_start(times)).max() > 0.2


def test_w4_the_grass_at_some_receivers_is_theirs(answer: Answer) -> None:
    soft = answer(6)
    mixed = Grass(np.array([0, 1, 0, 1, 1, 0]), soft.step, soft.rise, soft.fall)
    rows, times = np.array([4, 0, 1]), np.full(3, 0.4, np.float32)
    np.testing.assert_array_equal(
        mixed.at(rows).after_start(times), mixed.after_start(np.full(6, 0.4, np.float32))[rows]
    )
