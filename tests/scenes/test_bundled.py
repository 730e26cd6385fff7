"""The scenes that come with the package."""

import re
from importlib.resources import files
from itertools import pairwise

import numpy as np
import pytest

import tallgrass.scenes
from tallgrass.engine.scene import bundled_scenes, load_maps, read_scene
from tallgrass.engine.terrain.sample import height_at

NAMES = sorted(bundled_scenes())


def test_the_bundled_scenes_are_those_of_their_package() -> None:
    names = sorted(
        item.name.removesuffix(".yaml") for item in files(tallgrass.scenes).iterdir() if ".yaml" in item.name
    )
    assert names == NAMES
    assert {"hills", "meadow", "plain"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_every_bundled_scene_and_its_maps_can_be_read(name: str) -> None:
    loaded = read_scene(name)
    terrain, density = load_maps(loaded)
    assert loaded.file.parent == loaded.folder
    assert terrain.heights.ndim == 2
    assert len(density.maps) == len(loaded.scene.grass)
    assert density.maps.max(axis=(1, 2)).min() > 0.1


@pytest.mark.parametrize("name", NAMES)
def test_every_bundled_scene_says_its_story_in_its_first_line(name: str) -> None:
    first, second = bundled_scenes()[name].read_text("utf-8").splitlines()[:2]
    assert re.fullmatch(r"# [A-Z].*\.", first)
    assert second == "tallgrass: 2"


def test_r1_the_plain_is_the_papers_field_of_a_hundred_metres() -> None:
    loaded = read_scene("plain")
    terrain, density = load_maps(loaded)
    assert terrain.size == pytest.approx((100.0, 100.0))
    assert np.ptp(terrain.heights) == 0.0
    assert density.maps.min() == 1.0


def test_n5_the_meadow_is_walked_through_at_a_walking_pace() -> None:
    path = read_scene("meadow").scene.camera.path
    assert path[-1].at - path[0].at == pytest.approx(12.0)
    for before, after in pairwise(path):
        speed = np.hypot(*np.subtract(after.position, before.position)) / (after.at - before.at)
        assert 1.2 <= speed <= 1.5


def test_the_hills_rise_above_the_eye_that_looks_at_them() -> None:
    loaded = read_scene("hills")
    terrain, _ = load_maps(loaded)
    camera = loaded.scene.camera
    place = np.array([camera.position], np.float32)
    eye = float(height_at(terrain, place)[0]) + camera.eye
    yaw = np.radians(camera.yaw)
    ahead = np.linspace(20.0, 100.0, 81)[:, None] * np.array([[np.sin(yaw), -np.cos(yaw)]])
    assert np.ptp(terrain.heights) > 10.0
    assert height_at(terrain, place + ahead.astype(np.float32)).max() > eye + 3.0
