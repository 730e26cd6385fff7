"""Versions of the scene format."""

import pytest

from tallgrass.engine.declared.scene import FORMAT
from tallgrass.engine.scene.version import STEPS, upgrade


def test_a_scene_of_todays_version_stays_as_it_is() -> None:
    values = {"tallgrass": 2, "grass": {}}
    assert upgrade(values, 2) is values


def test_there_is_a_step_from_every_format_to_the_next() -> None:
    assert len(STEPS) == FORMAT - 1


def test_a_newer_scene_asks_for_a_newer_release() -> None:
    with pytest.raises(ValueError, match="this scene is of format 9, this release reads up to 2; update tallgrass"):
        upgrade({}, 9)


@pytest.mark.parametrize("version", [0, -5, -(10**60)])
def test_a_version_that_never_was_is_refused(version: int) -> None:
    with pytest.raises(ValueError, match=f"there is no scene format {version}"):
        upgrade({}, version)


def test_a_scene_of_format_1_keeps_its_sky_and_the_breadth_of_its_grass() -> None:
    old = {"tallgrass": 1, "grass": {"reed": {"width": 0.03}, "sedge": None}, "light": {"haze": 300}}
    new = upgrade(old, 1)
    assert new["tallgrass"] == 2
    assert new["grass"]["reed"] == {"width": 0.03, "taper": 1.0, "clumping": 0.0}
    assert new["grass"]["sedge"] == {"width": 0.012, "taper": 1.0, "clumping": 0.0}
    assert new["light"] == {"sun": "#fff1d6", "zenith": "#4f86c6", "horizon": "#cfdfe8", "haze": 300}


@pytest.mark.parametrize("values", [{"grass": 3}, {"grass": {"reed": 5}, "light": "dark"}, {"light": None}])
def test_what_is_wrong_in_a_scene_of_format_1_stays_to_be_told(values: dict[str, object]) -> None:
    new = upgrade({"tallgrass": 1, **values}, 1)
    assert new.get("grass") == values.get("grass")
    assert new["light"] == values["light"] if isinstance(values.get("light"), str) else isinstance(new["light"], dict)
