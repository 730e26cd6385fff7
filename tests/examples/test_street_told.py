"""The example plugin's wind in a drawn prairie: its twin sends the same messages as its numpy."""

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import moderngl
import numpy as np
import pytest

from tallgrass.systems.prairie import Prairie
from tallgrass.testing import little_prairie, stage

pytestmark = pytest.mark.packaging

EXAMPLE = Path(__file__).parents[2] / "examples" / "vortex-street"


@pytest.mark.parametrize("twinned", [True, False], ids=["with its twin", "without"])
def test_d5_receivers_are_told_the_same_on_the_graphics_card_with_and_without_a_twin(
    ctx: moderngl.Context, on_card: Callable[[Prairie], Any], monkeypatch: pytest.MonkeyPatch, *, twinned: bool
) -> None:
    monkeypatch.syspath_prepend(EXAMPLE)
    street: Any = importlib.import_module("vortex_street").VortexStreet
    wind = street if twinned else type("Untwinned", (street,), {"twin": None})
    longest = []
    with stage(ctx) as made, little_prairie(wind(position=[0.0, 19.0], rock=3.0), ctx=ctx) as prairie:
        for _ in range(4):
            prairie.advance(7.0)
            made.shot(prairie)
            for receiving, texels in on_card(prairie):
                heard = receiving.messages.heard(receiving.slots)
                np.testing.assert_allclose(texels[..., :2].reshape(-1, 2), heard, atol=1e-3, rtol=0.0)
                longest.append(np.linalg.norm(heard, axis=1).max(initial=0.0))
        assert not prairie.winds.quarantine.reasons
    assert np.median(longest) > 0.5
