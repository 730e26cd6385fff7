"""Profiles: growth and light of round and folded blades."""

from dataclasses import replace

import numpy as np
import pytest

from tallgrass.engine.declared.grass import GrassKind
from tallgrass.engine.declared.light import Light
from tallgrass.systems.grow.bend import profile, ribbon, widths
from tallgrass.systems.grow.blades import grow_blades
from tallgrass.systems.grow.postures import grow_postures
from tallgrass.systems.grow.record import Blades, Growth, PatchModel
from tallgrass.systems.grow.response import grow_response
from tallgrass.systems.grow.section import SECTIONS
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.materials import grain, leaves_of
from tallgrass.systems.show.carpet.grow import grow_carpet
from tallgrass.systems.show.strips.grow import grow_strips

PATCH = 1.0
RUSH = GrassKind(profile="rush", width=0.012, variety=0.0)
POSTURES = grow_postures(RUSH, seed=3)
BLADES = grow_blades(RUSH, count=60, patch=PATCH, variants=4, seed=3)
TURNED = replace(BLADES, facing=np.roll(BLADES.facing, 7))


def test_a_rush_leaves_the_ground_as_wide_as_it_is_and_hardly_tapers() -> None:
    width = profile(np.linspace(0.0, 1.0, 11), RUSH.taper, SECTIONS["rush"])
    assert width[0] == 1.0
    assert width[8] > 0.55
    assert width[-1] == 0.0
    assert GrassKind(profile="rush", taper=0.9).taper == 0.9


def test_a_rush_is_as_wide_from_all_sides() -> None:
    along = np.linspace(0.0, 1.0, 5)
    due = widths(BLADES, along, RUSH.taper, SECTIONS["rush"])
    for side in ((1.0, 0.0, 0.0), (0.6, 0.0, 0.8)):
        left, right = ribbon(
            BLADES, POSTURES, (0.0, 0.0), points=5, taper=RUSH.taper, section=SECTIONS["rush"], side=side
        )
        wide = (right - left) @ np.array(side)
        np.testing.assert_allclose(wide[:, :-1], due[:, :-1], atol=1e-6)
        assert np.all((wide[:, -1] > 0.0) & (wide[:, -1] < 0.5 * wide[:, -2]))


def drawn(blades: Blades) -> tuple[np.ndarray, np.ndarray]:
    """Return the coverage of rushes on strips and on the carpet."""
    section, taper = SECTIONS["rush"], RUSH.taper
    strips = grow_strips(
        blades, POSTURES, patch=PATCH, strips=2, texel=0.01, taper=taper, margin=0.2, section=section
    )  # fmt: skip
    carpet = grow_carpet(blades, POSTURES, patch=PATCH, texels=32, taper=taper, slopes=(0.3,), section=section)
    return strips.texels[..., 3], carpet.texels[..., 3]


def test_strips_and_carpet_show_as_much_of_a_rush_whichever_way_it_faces() -> None:
    for one, other in zip(drawn(BLADES), drawn(TURNED), strict=True):
        np.testing.assert_array_equal(one, other)


def test_from_the_side_there_is_more_of_round_leaves_than_of_flat_ones() -> None:
    growth = Growth(POSTURES, grow_response(RUSH), (PatchModel(BLADES, {}),))
    flat = RUSH.model_copy(update={"profile": "blade"})
    full = widths(BLADES, np.linspace(0.0625, 0.9375, 8), RUSH.taper, SECTIONS["rush"]).mean(axis=1) @ BLADES.height
    side = leaves_of(RUSH, growth, PATCH).side
    assert 0.9 * full < side <= full
    assert side > 1.4 * leaves_of(flat, growth, PATCH).side


@pytest.mark.parametrize("elevation", [10.0, 50.0])
def test_both_faces_of_a_fold_have_together_the_light_of_its_grain(elevation: float) -> None:
    light = daylight(Light(azimuth=20.0, elevation=elevation))
    flat, folded = (grain(GrassKind(profile=name, variety=0.0), light) for name in ("blade", "fold"))
    angle, turned = np.linspace(0.0, np.pi, 9)[:, None], SECTIONS["fold"].folded

    def lit(cosine: np.ndarray, sine: np.ndarray, azimuth: np.ndarray) -> np.ndarray:
        return np.asarray(np.cos(2.0 * azimuth) * cosine + np.sin(2.0 * azimuth) * sine)

    faces = 0.5 * (lit(*flat, angle + turned) + lit(*flat, angle - turned))
    np.testing.assert_allclose(lit(*folded, angle), faces, atol=1e-12)


def test_a_round_stem_is_lit_alike_whichever_way_it_faces() -> None:
    assert np.abs(grain(RUSH, daylight(Light(elevation=20.0)))).max() == 0.0


def test_grass_alone_has_a_profile() -> None:
    with pytest.raises(ValueError, match="grass alone has a profile"):
        GrassKind(plant="flower", profile="rush")
