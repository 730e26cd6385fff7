"""One picture from the command line."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass import __version__
from tallgrass.app.cli import run

Take = Callable[..., NDArray[np.uint8]]
pytestmark = [pytest.mark.gl, pytest.mark.usefixtures("ctx")]


@pytest.fixture
def take(scene: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Take:
    """Take a small picture of the small scene, with some options."""
    monkeypatch.chdir(scene.parent)

    def shoot(*options: object) -> NDArray[np.uint8]:
        assert run(["shot", scene.name, "-o", "a.png", "--size", "96x54", *map(str, options)]) == 0
        assert capsys.readouterr() == ("", "")
        with Image.open(scene.parent / "a.png") as image:
            return np.asarray(image)

    return shoot


def difference(a: NDArray[np.uint8], b: NDArray[np.uint8]) -> float:
    return float(np.abs(a.astype(float) - b).mean())


def test_n5_a_shot_has_its_size_and_its_story_and_comes_out_the_same_again(take: Take, scene: Path) -> None:
    first = take("--time", 1.5)
    assert first.shape == (54, 96, 3)
    assert first.std() > 5
    with Image.open(scene.parent / "a.png") as image:
        story = dict(image.info)
    assert story["seed"] == "5"
    assert (story["scene"], story["time"], story["version"]) == ("little", "1.5", __version__)
    again = take("--time", 1.5)
    np.testing.assert_array_equal(first, again)
    np.testing.assert_array_equal(first, take("--time", 1.5, "--camera", story["camera"]))


def test_the_wind_and_the_camera_change_the_picture(take: Take) -> None:
    first = take()
    assert difference(first, take("--time", 2)) > 0.1
    assert difference(first, take("--camera", "0,3,20,180,-10")) > 2


def test_a_camera_that_looks_up_sees_the_sky(take: Take) -> None:
    up = take("--camera", "0,3,0,0,80")
    assert up[..., 2].mean() > up[..., 1].mean()


def test_one_who_puts_the_camera_under_the_ground_is_told(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    picture = scene.parent / "a.png"
    assert run(["shot", str(scene), "-o", str(picture), "--size", "32x18", "--camera", "0,-40,0,0,0"]) == 0
    assert "m below the ground: y is a height in the scene" in capsys.readouterr().err


def test_each_representation_can_be_shown_alone(take: Take) -> None:
    pictures = [take("--lod", lod) for lod in ("auto", "blades", "strips", "carpet")]
    apart = [difference(a, b) for i, a in enumerate(pictures) for b in pictures[:i]]
    assert min(apart) > 0.05


def test_n3_the_reference_is_every_blade_supersampled(take: Take) -> None:
    reference = take("--reference")
    assert reference.shape == (54, 96, 3)
    assert difference(reference, take("--lod", "blades")) < difference(reference, take("--camera", "0,3,20,180,-10"))


def test_r1_a_preset_takes_the_place_of_the_scenes_quality(take: Take) -> None:
    assert difference(take(), take("--preset", "paper-low")) > 0.5


def test_n8_an_overlay_is_laid_over_the_picture(take: Take) -> None:
    plain, levels = take(), take("--overlay", "levels")
    assert difference(plain, levels) > 5
    assert difference(levels, take("--overlay", "levels,map")) > 1
    np.testing.assert_array_equal(take("--overlay", "map,levels"), take("--overlay", "levels,map"))


def test_no_picture_takes_the_place_of_a_map_of_its_scene(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    kept = scene.parent / "map.png"
    Image.new("L", (2, 2), 255).save(kept)
    scene.write_text("tallgrass: 2\ngrass: { meadow: { place: { map: map.png } } }\n", "utf-8")
    before = kept.read_bytes()
    assert run(["shot", str(scene), "-o", str(scene.parent / "." / "map.png"), "--size", "96x54"]) == 2
    assert "the scene reads 'map.png': choose another name" in capsys.readouterr().err
    assert kept.read_bytes() == before
