"""Give: posture indices of a kind by message (W12)."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.systems.grow.bend import bending, spine
from tallgrass.systems.grow.blades import grow_blades
from tallgrass.systems.grow.postures import NEAR_FLAT, chord_angle, grow_give, grow_postures
from tallgrass.systems.grow.record import GIVES, Postures
from tallgrass.systems.grow.simulate import LINKS, build_chain, damp, settle, simulate

LEVEL = np.linspace(0.0, 1.0, GIVES)
SHAPES = st.fixed_dictionaries(
    {
        "height": st.floats(0.03, 4.0).map(lambda tall: [tall, tall]),
        "width": st.floats(0.001, 0.1),
        "taper": st.floats(0.2, 4.0),
    }
)


@settings(max_examples=5)
@given(SHAPES)
def test_w12_grass_of_stiffness_one_is_bent_as_far_as_the_message_says(shape: dict[str, Any]) -> None:
    np.testing.assert_allclose(grow_give(GrassKind(**shape)), LEVEL, atol=1e-6)


@settings(max_examples=6)
@given(SHAPES, st.floats(0.02, 80.0), st.floats(1.1, 20.0))
def test_w12_the_stiffer_of_two_kinds_gives_way_less_to_every_message(
    shape: dict[str, Any], soft: float, more: float
) -> None:
    stiff = min(soft * more, 100.0)
    yields, stands = (grow_give(GrassKind(**shape, stiffness=each)) for each in (soft, stiff))
    assert yields[0] == stands[0] == 0.0
    assert yields.max() <= 1.0
    assert (np.diff(yields) >= 0.0).all()
    assert (np.diff(stands) >= 0.0).all()
    lying = yields == 1.0
    assert (yields[1:] > stands[1:])[~lying[1:]].all()
    assert (yields >= stands).all()


@pytest.mark.parametrize("stiffness", [0.2, 8.0])
def test_w12_a_kind_bends_as_the_simulation_does_in_the_wind_that_bends_common_grass_so_far(stiffness: float) -> None:
    levels = np.array([0.25, 0.5, 0.75])
    common, own = (build_chain(GrassKind(stiffness=each), np.ones((1, LINKS))) for each in (1.0, stiffness))
    winds = np.linspace(0.02, 16.0, 800)
    rest = settle(common, winds)[:, 0]
    flat = int(np.argmax(rest[:, -1] >= NEAR_FLAT))
    wind = np.interp(levels * chord_angle(rest[flat]), chord_angle(rest[: flat + 1]), winds[: flat + 1])
    blades = build_chain(GrassKind(stiffness=stiffness), np.ones((len(levels), LINKS)))
    still = np.zeros((len(levels), LINKS))
    history, _ = simulate(damp(blades, ratio=0.7), still, still, np.tile(wind, (4000, 1)), step=0.02)
    own_rest = settle(own, np.linspace(0.02, 32.0, 800))[:, 0]
    own_flat = own_rest[int(np.argmax(own_rest[:, -1] >= NEAR_FLAT))]
    expected = np.minimum(chord_angle(history[-1]) / chord_angle(own_flat), 1.0)
    np.testing.assert_allclose(np.interp(levels, LEVEL, grow_give(GrassKind(stiffness=stiffness))), expected, atol=0.02)


def test_w12_at_half_the_force_that_lays_common_grass_the_stiff_tip_stands_a_quarter_of_its_length_higher() -> None:
    tips = []
    for stiffness in (0.2, 1.0, 8.0):
        kind = GrassKind(stiffness=stiffness, height=[1.0, 1.0], lean=0.0)
        grown = grow_postures(kind, seed=1)
        postures = Postures(grown.index, grown.shape, grow_give(kind))
        blades = grow_blades(kind, count=40, patch=2.5, variants=4, seed=1)
        tips.append(spine(blades, postures, (0.5, 0.0), points=17)[:, -1, 1].mean())
    assert tips[2] - tips[0] > 0.25
    assert tips[0] < tips[1] < tips[2]


def test_bending_keeps_the_direction_of_a_message_and_stops_at_flat() -> None:
    postures = Postures(np.zeros(0, np.float32), np.zeros(0, np.float32), (LEVEL**2).astype(np.float32))
    message = np.array([[0.3, -0.4], [0.0, 0.0], [0.0, 1.0], [-3.0, 0.0]])
    expected = [[0.15, -0.2], [0.0, 0.0], [0.0, 1.0], [-1.0, 0.0]]
    np.testing.assert_allclose(bending(postures, message), expected, atol=1e-6)
