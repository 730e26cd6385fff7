"""Versions of the scene format."""

import pytest

from tallgrass.engine.scene.version import STEPS, Steps, upgrade

STEPS_TO_THREE: Steps = {
    1: lambda values: {("winds" if key == "wind" else key): value for key, value in values.items()},
    2: lambda values: values | {"season": "summer"},
}


def test_an_older_scene_goes_through_every_step_in_order() -> None:
    old = {"tallgrass": 1, "wind": []}
    assert upgrade(old, 1, steps=STEPS_TO_THREE, to=3) == {"tallgrass": 3, "winds": [], "season": "summer"}
    assert upgrade({"tallgrass": 2}, 2, steps=STEPS_TO_THREE, to=3) == {"tallgrass": 3, "season": "summer"}
    assert old == {"tallgrass": 1, "wind": []}


def test_a_scene_of_todays_version_stays_as_it_is() -> None:
    values = {"tallgrass": 1, "grass": {}}
    assert upgrade(values, 1) is values


def test_a_newer_scene_asks_for_a_newer_release() -> None:
    with pytest.raises(ValueError, match="this scene is of format 9, this release reads up to 1; update tallgrass"):
        upgrade({}, 9)


@pytest.mark.parametrize("version", [0, -5, -(10**60)])
def test_a_version_that_never_was_is_refused(version: int) -> None:
    assert version not in STEPS
    with pytest.raises(ValueError, match=f"there is no scene format {version}"):
        upgrade({}, version)
