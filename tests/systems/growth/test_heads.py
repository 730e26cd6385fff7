"""Where heads are in the canopy, for the carpet."""

import numpy as np
import pytest

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.around.canopy import canopy_height
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.grow.organs import HEADS
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.show.carpet.heads import NO_HEADS, any_heads, heads_of
from tallgrass.systems.stock.models import grow

SMALL = PRESETS["low"].model_copy(update={"models": 1, "carpet": 16, "strip_rings": PRESETS["low"].strip_rings[-1:]})


def grown(**values: object) -> Growth:
    return grow(GrassKind.model_validate(values), SMALL, seed=5)


def test_f3_grass_and_forbs_without_heads_have_none() -> None:
    growths = [grown(blades=40), grown(plant="forb")]
    assert [heads_of(growth) for growth in growths] == [NO_HEADS, NO_HEADS]
    assert not any_heads(growths)
    assert any_heads([*growths, grown(plant="flower")])


@pytest.mark.parametrize("form", ["disc", "spike", "umbel"])
def test_f3_heads_are_as_high_as_their_petals_and_leaves_make_up_the_rest(form: str) -> None:
    growth = grown(plant="flower", height=[0.4, 0.6], head={"form": form})
    others, heads, low, high = heads_of(growth)
    blades = growth.models[0].blades
    points = spine(blades, growth.postures, (0.0, 0.0), points=9)[np.isin(blades.organ, HEADS)]
    tall = points[:, :, 1] / canopy_height(growth)
    assert tall.min() <= low < high
    assert tall.min() < 0.5 * (low + high) < tall.max()
    assert 0.0 < heads <= 1.0 - others < 1.0


def test_f3_petals_behind_petals_do_not_count_again() -> None:
    few, many = (
        grown(plant="flower", leaves=0, head=Head(petals=petals, size=[0.08, 0.08], open=1.0).model_dump())
        for petals in (4, 40)
    )
    part = [heads / (1.0 - others) for others, heads, _, _ in map(heads_of, (few, many))]
    assert part[1] < part[0] <= 1.0
