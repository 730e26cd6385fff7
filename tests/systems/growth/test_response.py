"""Response: index over time (paper, section 3.3, figure 8)."""

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow import response
from tallgrass.systems.grow.record import Response
from tallgrass.systems.grow.response import grow_response

KINDS = {
    "meadow": GrassKind(),
    "soft": GrassKind(stiffness=0.3),
    "stiff": GrassKind(stiffness=4.0),
    "lawn": GrassKind(height=[0.08, 0.14], width=0.004),
    "reed": GrassKind(height=[1.4, 2.4], width=0.03),
}


@pytest.fixture(scope="module")
def responses() -> dict[str, Response]:
    return {name: grow_response(kind) for name, kind in KINDS.items()}


def crossings(curve: NDArray[Any], level: float) -> NDArray[Any]:
    return np.flatnonzero(np.diff(np.sign(curve - level)) != 0)


@pytest.mark.parametrize("name", KINDS)
def test_w4_a_wind_that_starts_bends_the_blade_too_far_and_back(responses: dict[str, Response], name: str) -> None:
    rise = responses[name].rise
    assert rise[0] == 0.0
    assert 1.03 < rise.max() < 1.8
    top = int(np.argmax(rise))
    assert rise[top:].min() < 0.995
    assert rise[-1] == pytest.approx(1.0, abs=1e-6)
    assert np.abs(rise[-rise.size // 6 :] - 1.0).max() < 0.02


@pytest.mark.parametrize("name", KINDS)
def test_w4_a_wind_that_stops_leaves_the_blade_swinging_till_it_rests(
    responses: dict[str, Response], name: str
) -> None:
    fall = responses[name].fall
    assert fall[0] == pytest.approx(1.0, abs=1e-3)
    assert fall.min() < -0.1
    assert len(crossings(fall[: fall.size * 3 // 4], 0.0)) >= 3
    assert fall[-1] == pytest.approx(0.0, abs=1e-6)
    assert np.abs(fall[-fall.size // 6 :]).max() < 0.03


@pytest.mark.parametrize("name", KINDS)
def test_w4_each_swing_is_smaller_than_the_last(responses: dict[str, Response], name: str) -> None:
    fall = responses[name].fall
    cuts = [0, *crossings(fall, 0.0)]
    peaks = [np.abs(fall[a : b + 1]).max() for a, b in pairwise(cuts)]
    peaks = [peak for peak in peaks if peak > 0.03]
    assert all(later < earlier for earlier, later in pairwise(peaks))


def half_swing(response: Response) -> float:
    cuts = crossings(response.fall, 0.0)
    return float((cuts[2] - cuts[0]) / 2 * response.step)


def test_w12_stiff_and_short_kinds_swing_faster_than_soft_and_tall_ones(responses: dict[str, Response]) -> None:
    half = {name: half_swing(response) for name, response in responses.items()}
    assert half["stiff"] < half["meadow"] < half["soft"]
    assert half["lawn"] < half["meadow"] < half["reed"]
    assert 0.15 < half["meadow"] < 1.0


def test_w12_more_damping_means_fewer_and_smaller_swings(responses: dict[str, Response]) -> None:
    heavy = grow_response(GrassKind(damping=3.0))
    assert heavy.fall.min() > responses["meadow"].fall.min() + 0.1
    assert heavy.rise.max() < responses["meadow"].rise.max()


@pytest.mark.parametrize("damping", [0.02, 100.0])
def test_w4_the_response_ends_at_rest_however_a_kind_is_damped(damping: float) -> None:
    response = grow_response(GrassKind(damping=damping))
    assert np.isfinite(response.rise).all()
    assert np.isfinite(response.fall).all()
    assert response.rise[-1] == pytest.approx(1.0, abs=1e-6)
    assert response.fall[-1] == pytest.approx(0.0, abs=1e-6)
    assert response.fall.dtype == np.float32


@pytest.mark.parametrize("name", KINDS)
def test_a_simulation_that_ends_once_all_is_still_misses_nothing(
    responses: dict[str, Response], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(response, "_STILL", np.inf)
    short, whole = responses[name], grow_response(KINDS[name])
    assert short.step == whole.step
    assert (short.rise == whole.rise).all()
    assert (short.fall == whole.fall).all()
