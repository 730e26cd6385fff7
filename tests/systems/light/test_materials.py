"""Materials of kinds: reflectance, and transmittance of the canopy (F10)."""

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from tallgrass.engine.declared.grass import GrassKind, Profile
from tallgrass.engine.declared.light import Light
from tallgrass.engine.declared.plant import Head
from tallgrass.engine.declared.quality import PRESETS
from tallgrass.systems.frame.block import FRAME
from tallgrass.systems.grow.bend import profile, ribbon
from tallgrass.systems.grow.raster import rasterise, ribbon_triangles
from tallgrass.systems.grow.record import Growth
from tallgrass.systems.land.record import Figures, figures_of
from tallgrass.systems.light.daylight import daylight
from tallgrass.systems.light.materials import bloom, grain, leaves_of, pigment, understorey, undertone
from tallgrass.systems.space.canopy import canopy_height
from tallgrass.systems.stock.models import grow

Probe = Callable[..., NDArray[np.float32]]

PATCH = 2.5
HEIGHTS = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 0.95])
SAMPLES = 400
FEW = PRESETS["low"].model_copy(update={"models": 1, "strip_rings": PRESETS["low"].strip_rings[-1:]})
"""The preset low with one model and the coarsest strips: light depends on its blades alone."""

KINDS = {
    "meadow": GrassKind(height=[0.4, 0.7]),
    "fescue": GrassKind(height=[0.6, 1.0], width=0.014, taper=0.9, lean=0.2),
}


@pytest.fixture(scope="module", params=KINDS)
def grown(request: pytest.FixtureRequest) -> tuple[GrassKind, Growth]:
    kind = KINDS[request.param]
    return kind, grow(kind, FEW.model_copy(update={"blades": 400}), seed=3)


@given(st.floats(0.01, 5.0), st.floats(0.0, 1.0))
def test_there_is_no_more_of_an_understorey_than_the_canopy_has_room_for(canopy: float, part: float) -> None:
    covered = understorey(GrassKind(understorey=part), canopy)
    assert covered == part if canopy >= 0.25 else covered <= part * canopy / 0.249


def test_f3_low_leaves_have_the_colour_of_leaves_where_that_of_tips_is_that_of_petals() -> None:
    kinds = GrassKind(), GrassKind(plant="forb"), GrassKind(plant="shrub", head=Head(form="spike"))
    grass, forb, heather = (undertone(kind, 1.0) for kind in kinds)
    assert grass == forb > 0.5
    assert 0.0 < heather < 0.1


def met(kind: GrassKind, growth: Growth, elevation: float, height: float, density: float) -> float:
    """Return the sunlit fraction of a height [m] in endless grass of a patch's blades, by brute force."""
    blades = growth.models[0].blades
    edges = ribbon(blades, growth.postures, (0.0, 0.0), points=25, taper=kind.taper)
    stays = blades.rank < density
    triangles = ribbon_triangles(*(edge[stays].astype(np.float64) for edge in edges))
    above = triangles[triangles[:, :, 1].min(axis=1) >= height]
    if not len(above):
        return 1.0
    way = np.array([np.sin(0.7), -np.cos(0.7)]) / np.tan(np.radians(elevation))
    ground = above[:, :, ::2] - way * (above[:, :, 1:2] - height)
    hit = rasterise(ground * (SAMPLES / PATCH), above[:, :, 1], shape=(SAMPLES, SAMPLES), wrap=True)
    return 1.0 - len(hit.sample) / SAMPLES**2


SEEN = """#include "lib/canopy.glsl"
in vec4 row;
out float told;
void main() { told = transmittance(sun_extinction(0, row.x) * leaf_area_above(row.y, vec2(0.0, row.z))); }"""


def closed_form(
    probe: Probe, kind: GrassKind, growth: Growth, elevation: float, density: float
) -> NDArray[np.floating]:
    """Return the shaders' values at HEIGHTS of the canopy."""
    leaves, record = leaves_of(kind, growth, PATCH), np.zeros(1, FRAME)
    record["lying"][0, 0, 0] = leaves.above / leaves.side
    rows = np.zeros((len(HEIGHTS), 4), np.float32)
    rows[:, 0], rows[:, 1], rows[:, 2] = np.sin(np.radians(elevation)), HEIGHTS, leaves.side * density
    return probe(SEEN, rows, record, {}, 1)[:, 0]


@pytest.mark.parametrize("density", [1.0, 0.5, 0.2])
def test_f10_light_reaches_into_the_canopy_as_rays_through_its_blades_do(
    probe: Probe, grown: tuple[GrassKind, Growth], density: float
) -> None:
    kind, growth = grown
    canopy = canopy_height(growth)
    for elevation in (10.0, 20.0, 35.0, 55.0, 80.0):
        rays = np.array([met(kind, growth, elevation, height * canopy, density) for height in HEIGHTS])
        apart = np.abs(closed_form(probe, kind, growth, elevation, density) - rays)
        assert apart.max() < 0.045, elevation
        assert apart.mean() < 0.02, elevation


@pytest.mark.parametrize("section", ["blade", "rush"])
def test_on_twice_the_side_as_many_leaves_cover_a_quarter_of_the_ground(section: Profile) -> None:
    kind = GrassKind(profile=section)
    growth = grow(kind, FEW, seed=3)
    near, wide = leaves_of(kind, growth, PATCH), leaves_of(kind, growth, 2.0 * PATCH)
    assert (wide.side, wide.above) == pytest.approx((near.side / 4.0, near.above / 4.0))
    assert 0.0 < near.above < near.side


def test_figures_of_a_kind_that_changes_go_from_its_own_to_those_that_it_will_have(
    grown: tuple[GrassKind, Growth],
) -> None:
    kind = GrassKind(height=[0.2, 0.3], stiffness=2.0)
    before, after = figures_of(*grown, PATCH), figures_of(kind, grow(kind, FEW, seed=3), PATCH)

    def numbers(figures: Figures) -> NDArray[np.floating]:
        return np.array([figures.crown, figures.leaves.side, figures.leaves.above, figures.bloom, *figures.give])

    for fraction in (0.0, 0.3, 1.0):
        due = (1.0 - fraction) * numbers(before) + fraction * numbers(after)
        np.testing.assert_allclose(numbers(before.toward(after, fraction)), due, atol=1e-6)
    assert np.abs(numbers(after) - numbers(before)).max() > 0.1


def test_a_blade_is_narrower_where_it_leaves_the_ground_and_ends_in_a_tip() -> None:
    along = np.linspace(0.0, 1.0, 101)
    width = profile(along, 0.6)
    assert width[0] == pytest.approx(0.45)
    assert width[-1] == 0.0
    assert 0.1 <= along[np.argmax(width)] <= 0.2
    assert (np.diff(width[20:]) < 0.0).all()


@settings(max_examples=12)
@given(st.floats(0.0, 360.0), st.floats(0.0, 90.0), st.floats(0.0, 0.6))
def test_blades_that_face_all_ways_have_the_pigment_of_their_mean(
    azimuth: float, elevation: float, variety: float
) -> None:
    light = daylight(Light(azimuth=azimuth, elevation=elevation))
    cosine, sine = grain(GrassKind(variety=variety), light)
    angle = np.linspace(-np.pi, np.pi, 360, endpoint=False)
    factor = 1.0 + np.cos(2.0 * angle)[:, None] * cosine + np.sin(2.0 * angle)[:, None] * sine
    np.testing.assert_allclose(factor.mean(axis=0), 1.0, atol=1e-9)


def test_both_sides_of_a_blade_are_lit_alike() -> None:
    light = daylight(Light(azimuth=30.0, elevation=20.0))
    cosine, sine = grain(GrassKind(variety=0.0), light)
    toward = np.radians(30.0) - np.pi / 2.0  # azimuth of the sun from +x towards +z
    lit = 1.0 + np.cos(2.0 * toward) * cosine + np.sin(2.0 * toward) * sine
    aside = 1.0 + np.cos(2.0 * toward + np.pi) * cosine + np.sin(2.0 * toward + np.pi) * sine
    assert (lit > 1.05).all()
    assert (aside < 0.95).all()


def test_a_pigment_is_the_root_of_an_albedo() -> None:
    np.testing.assert_allclose(pigment("#ffffff"), 1.0)
    np.testing.assert_allclose(pigment("#bcbcbc") ** 2, 0.5, atol=0.005)


def test_f3_grass_has_all_of_its_tip_and_a_flower_as_much_as_its_petals_show() -> None:
    flower = GrassKind(plant="flower")
    grown = (GrassKind(), flower, GrassKind(plant="flower", head=Head(petals=24, size=[0.08, 0.1])))
    some = [bloom(kind, grow(kind, FEW, seed=3)) for kind in grown]
    assert some[0] == 1.0
    assert 0.1 < some[1] < some[2] <= 1.0


def test_f3_the_canopy_of_flowers_is_as_high_as_its_heads_and_not_as_its_leaves() -> None:
    flower = GrassKind(plant="flower", height=[0.5, 0.6], leaves=20, leaf=[0.05, 0.1])
    assert 0.5 <= canopy_height(grow(flower, FEW, seed=3)) <= 0.6


STRAIGHT = """#define PIXELS_ASK
#include "lib/surface.glsl"
in vec4 row;
out vec4 told;
void main() {
    Reflectance sent = leaf_reflectance(0, vec2(row.w, 0.0), eye + 7.0 * row.xyz, row.xyz, max(row.y, 0.0));
    told = vec4(sent.sun.r, sent.sky.r, sent.gloss, 1.0);
}"""


def test_d6_a_leaf_that_stands_straight_before_the_sun_sends_light_that_is_a_number(probe: Probe) -> None:
    """The half vector of sun and eye is 0: GLSL leaves open what its unit vector is."""
    record, rows = np.zeros(1, FRAME), np.zeros((6, 4), np.float32)
    record["eye"], record["kinds"]["gloss"], record["kinds"]["through"] = (3.0, 1.7, 5.0), 0.4, 0.5
    rows[:, :3] = [(0, 0, -1), (0, 1, 0), (1, 0, 0), (0.6, 0.8, 0), (0, 0.6, -0.8), (0.48, 0.6, 0.64)]
    rows[3:, 3] = 0.5
    sent = probe(STRAIGHT, rows, record, {}, 4)
    assert np.isfinite(sent).all()
    assert (sent[:, :2] > 0.0).all()


BENT = """#include "lib/surface.glsl"
in vec4 row;
out vec4 told;
void main() {
    Reflectance sent = leaf_reflectance(0, row.xy, eye + vec3(0.0, -1.0, -7.0), vec3(0.0, 1.0, 0.0), 1.0);
    told = vec4(sent.sun.r, sent.sky.r, sent.gloss, 1.0);
}"""


def test_f6_grass_that_lies_shows_its_faces_to_the_sky_and_most_to_an_eye_that_it_leans_away_from(probe: Probe) -> None:
    record, rows = np.zeros(1, FRAME), np.zeros((4, 4), np.float32)
    record["eye"], record["kinds"]["through"] = (3.0, 1.7, 5.0), 0.5
    rows[1:, :2] = [(0.8, 0.0), (0.0, -0.8), (0.0, 0.8)]
    for sent in probe(BENT, rows, record, {}, 4).T[:2]:
        upright, aside, away, towards = sent
        assert aside > 1.05 * upright
        assert away > 1.05 * aside
        assert towards < 0.95 * aside


SHADED = """#include "lib/surface.glsl"
in vec4 row;  // visibility of the sun; its part of the light from sun and lamps; part that something lets through; haze
out vec3 told;
void main() {
    Light light = Light(vec3(0.8), vec3(0.3), vec3(0.0), 0.5, 0.6, vec2(0.4, 1.1));
    if (row.w > 0.0)
        light = hazed(light, eye + vec3(0.0, 0.0, -1.0 / row.w));
    told = shade(leaf_surface(vec3(0.6), 0.5), shadowed(light, row.x, row.y), row.z);
}"""


def test_f10_in_full_shadow_light_of_sky_and_lamps_is_left_and_none_of_the_sun(probe: Probe) -> None:
    record = np.zeros(1, FRAME)
    record["sunlight"], record["crown"] = 1.0, 0.5

    def at(seen: float, suns: float, passes: float = 1.0) -> float:
        return float(probe(SHADED, np.array([(seen, suns, passes, 0.0)], np.float32), record, {}, 3)[0, 0])

    lit, sky, lamps = at(1.0, 1.0), at(0.0, 1.0), at(0.0, 0.25)
    assert at(1.0, 1.0, 0.0) == pytest.approx(sky, rel=1e-5)
    assert at(0.5, 1.0) == pytest.approx(0.5 * (lit + sky), rel=1e-5)
    assert sky < lamps < lit
    record["sunlight"] = 0.0  # a lamp's light is mirrored by nothing
    assert at(0.0, 0.25) == pytest.approx(lamps, rel=1e-5)
    assert at(1.0, 1.0) < 0.9 * lit


def test_haze_dims_all_light_of_a_surface_alike(probe: Probe) -> None:
    record, rows = np.zeros(1, FRAME), np.zeros((2, 4), np.float32)
    record["sunlight"], record["crown"], record["haze_density"] = 1.0, 0.5, 0.01
    rows[:, :3], rows[1, 3] = 1.0, 0.01
    near, far = probe(SHADED, rows, record, {}, 3)[:, 0]
    assert far == pytest.approx(near * np.exp(-1.0), rel=0.01)


HAZE = """#include "lib/haze.glsl"
in vec4 row;
out vec3 told;
void main() { told = haze_radiance(eye + row.xyz); }"""


def test_f5_the_steeper_one_looks_down_the_less_the_azimuth_counts_for_the_haze(probe: Probe) -> None:
    record, angles = np.zeros(1, FRAME), np.radians([0.0, 90.0, 180.0, 270.0])
    record["sun"], record["horizon"][0, :, :3] = (0.8, 0.6, 0.0), [[1.0], [0.5], [0.2], [0.3]]
    level = np.column_stack([np.cos(angles), 0.0 * angles, np.sin(angles), 0.0 * angles])
    spread = [
        np.ptp(probe(HAZE, (7.0 * level - (0.0, down, 0.0, 0.0)).astype(np.float32), record, {}, 3)[:, 0])
        for down in (0.0, 7.0, 70.0, 7000.0)
    ]
    assert spread[0] > 1.3 * spread[1] > 5.0 * spread[2] > 0.0
    assert spread[3] < 0.002
