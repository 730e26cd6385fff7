"""The walk of benchmarks: the same every time, in any scene."""

from pathlib import Path

import numpy as np
import pytest

from tallgrass.app.bench.stroll import (
    LEAD,
    PACE,
    RATE,
    SECONDS,
    ahead,
    find_crest,
    first_border,
    legs,
    moments,
    raise_gusts,
)
from tallgrass.app.studio.walker import EYE
from tallgrass.systems.prairie import Prairie

SMALL = """\
quality:
  blades: 20
  models: 1
  blade_rings: [{ to: 1, segments: 1 }]
  strip_rings: [{ to: 4, strips: 2, columns: 1, sections: 1, texel: 0.05 }]
  carpet_to: 6
  carpet: 8
"""


def load(folder: Path, terrain: str, position: str = "[3, 20]") -> Prairie:
    path = folder / "scene.yaml"
    camera = f"camera: {{ position: {position}, yaw: 35 }}"
    path.write_text(f"tallgrass: 2\nterrain: {terrain}\ngrass: {{ green: {{}} }}\n{camera}\n{SMALL}")
    return Prairie.load(path)


@pytest.fixture
def hilly(tmp_path: Path) -> Prairie:
    return load(tmp_path, "{ noise: hills, size: [150, 150], feature: 60, scale: 12 }")


def test_the_walk_is_the_same_every_time(tmp_path: Path, hilly: Prairie) -> None:
    again = load(tmp_path, "{ noise: hills, size: [150, 150], feature: 60, scale: 12 }")
    walk = [list(moments(hilly, leg)) for leg in legs(hilly)]
    assert walk == [list(moments(again, leg)) for leg in legs(again)]
    assert [leg[0].leg.name for leg in walk] == ["ahead", "aside", "turning", "below", "far", "over"]


def test_flat_ground_has_no_crest_and_the_walk_none_to_go_over(tmp_path: Path) -> None:
    prairie = load(tmp_path, "{ noise: flat, size: [80, 80] }")
    assert find_crest(prairie, np.zeros(2)) is None
    assert [leg.name for leg in legs(prairie)] == ["ahead", "aside", "turning"]


def test_from_a_crest_the_ground_falls_before_and_behind(hilly: Prairie) -> None:
    found = find_crest(hilly, np.zeros(2))
    assert found is not None
    top, over = found
    way = np.linspace(-12.0, 12.0, 3)[:, None] * ahead(over)
    before, there, behind = hilly.height_at(top + way)
    assert there > max(before, behind) + 0.5


def test_each_leg_comes_to_a_border_between_patches_at_the_same_time(hilly: Prairie) -> None:
    patch = hilly.site.ground.patch
    for leg in legs(hilly):
        assert first_border(np.array(leg.place), leg.heading, patch=patch) == pytest.approx(PACE * LEAD, abs=1e-6)
        places = np.array([moment.camera.position for moment in moments(hilly, leg)])
        crossed = np.flatnonzero((np.diff(np.floor(places[:, ::2] / patch), axis=0) != 0).any(axis=1))
        assert crossed[0] == pytest.approx(LEAD * RATE, abs=1)


def test_the_walker_keeps_a_walkers_pace_and_height_on_the_terrain(hilly: Prairie) -> None:
    for leg in legs(hilly):
        frames = list(moments(hilly, leg))
        assert len(frames) == round(SECONDS * RATE) + 1
        places = np.array([moment.camera.position for moment in frames])
        np.testing.assert_allclose(places[:, 1] - hilly.height_at(places[:, ::2]), EYE, atol=1e-4)
        assert (np.abs(places[:, ::2]) < 75.0).all()
        np.testing.assert_allclose(
            np.linalg.norm(np.diff(places[:, ::2], axis=0), axis=1).max() * RATE, PACE, rtol=1e-3
        )
        assert (np.ptp([moment.camera.yaw for moment in frames]) > 0.1) == (leg.name == "turning")


def test_one_leg_goes_aside_and_comes_back(hilly: Prairie) -> None:
    (aside,) = (leg for leg in legs(hilly) if leg.name == "aside")
    places = np.array([moment.camera.position for moment in moments(hilly, aside)])[:, ::2]
    np.testing.assert_allclose(places[0], places[-1], atol=1e-5)
    across = (places[len(places) // 2] - places[0]) @ ahead(aside.yaw)
    assert abs(across) < 1e-3


def test_a_camera_at_the_edge_of_the_terrain_starts_a_walk_that_stays_on_it(tmp_path: Path) -> None:
    prairie = load(tmp_path, "{ noise: flat, size: [60, 60] }", position="[29, -29]")
    for leg in legs(prairie):
        places = np.array([moment.camera.position for moment in moments(prairie, leg)])[:, ::2]
        assert (np.abs(places) <= 30.0).all()


def test_a_gust_blows_on_every_leg(hilly: Prairie) -> None:
    walk = legs(hilly)
    raise_gusts(hilly, walk)
    for leg in walk:
        seen = np.array(leg.place) + np.arange(2.0, 30.0)[:, None] * ahead(leg.yaw)
        for part in (0.0, 0.5, 1.0):
            felt = np.linalg.norm(hilly.wind_at(seen, leg.start + part * SECONDS), axis=1)
            assert felt.max() > 0.5
        assert np.linalg.norm(hilly.wind_at(seen, leg.start - 1.0), axis=1).max() < 0.5
