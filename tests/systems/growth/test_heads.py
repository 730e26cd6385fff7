"""Heights of heads in the canopy, for the carpet."""

import numpy as np
import pytest

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.grow.bend import spine
from tallgrass.systems.grow.headed import headed
from tallgrass.systems.grow.organs import HEADS, any_heads
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.show.carpet.heads import HEIGHTS, HIGHEST, profile_of
from tallgrass.systems.space.canopy import canopy_height
from tallgrass.systems.stock.models import grow

SMALL = PRESETS["low"].model_copy(update={"models": 1, "carpet": 16, "strip_rings": PRESETS["low"].strip_rings[-1:]})


def grown(**values: object) -> Growth:
    return grow(GrassKind.model_validate(values), SMALL, seed=5)


def test_f3_grass_and_forbs_bear_no_heads_and_flowers_do() -> None:
    growths = [grown(blades=40), grown(plant="forb")]
    assert [profile_of(growth)[0].tolist() for growth in growths] == [pytest.approx([1.0, 0.0])] * 2
    assert not any_heads(growths)
    assert any_heads([*growths, grown(plant="flower")])


@pytest.mark.parametrize("plant", ["grass", "flower", "shrub"])
def test_f3_leaf_area_above_a_height_falls_to_nothing_at_the_top(plant: str) -> None:
    profile = profile_of(grown(plant=plant, head={"form": "spike"} if plant != "grass" else None))
    assert (np.diff(profile, axis=0) <= 1e-12).all()
    assert (profile[:, 1] <= profile[:, 0] + 1e-12).all()
    assert profile[-1].tolist() == [0.0, 0.0]
    assert 0.4 < profile[0, 0] <= 1.0 + 1e-6


@pytest.mark.parametrize("form", ["disc", "spike", "umbel"])
def test_f3_heads_are_as_high_as_their_petals(form: str) -> None:
    growth = grown(plant="flower", height=[0.4, 0.6], head={"form": form})
    above = profile_of(growth)[:, 1]
    blades = growth.models[0].blades
    points = spine(blades, growth.postures, (0.0, 0.0), points=9)[np.isin(blades.organ, HEADS)]
    low, high = np.quantile(points[:, :, 1], (0.0, 1.0)) * (HEIGHTS / (HIGHEST * canopy_height(growth)))
    assert above[int(low)] == pytest.approx(above[0], rel=0.02)
    assert above[min(int(high) + 2, HEIGHTS)] == pytest.approx(0.0, abs=0.02 * above[0])
    assert 0.0 < above[0] < 1.0


def test_f3_petals_behind_petals_do_not_count_again() -> None:
    few, many = (
        grown(plant="flower", leaves=0, head=Head(petals=petals, size=[0.08, 0.08], open=1.0).model_dump())
        for petals in (4, 40)
    )
    assert profile_of(many)[0, 0] < profile_of(few)[0, 0] <= 1.0


def test_f3_a_bush_hides_the_more_of_itself_the_more_leaves_it_has() -> None:
    few, many = (grown(plant="shrub", leaves=leaves, head={"form": "spike"}) for leaves in (1, 6))
    assert profile_of(many)[0, 0] < profile_of(few)[0, 0]


@pytest.mark.parametrize(("petals", "layers"), [(4, (1.2, 2.2)), (24, (2.0, 4.0))])
def test_f3_an_open_disc_is_a_disc_from_above_and_flat_from_the_side(petals: int, layers: tuple[float, float]) -> None:
    head = Head(petals=petals, size=[0.08, 0.08], open=1.0).model_dump()
    found = headed(grown(plant="flower", leaves=0, lean=0, head=head))
    assert found is not None
    assert found.above == pytest.approx(np.pi * 0.04**2, rel=0.4)
    assert found.aside < 0.55 * found.above
    assert layers[0] < found.layers < layers[1]


def test_f3_what_bears_no_heads_is_told_to_bear_none() -> None:
    assert headed(grown(blades=40)) is None
