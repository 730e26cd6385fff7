"""Films from the command line."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

Tallgrass = Callable[..., subprocess.CompletedProcess[str]]
pytestmark = pytest.mark.gl


def pixels(path: Path) -> NDArray[np.uint8]:
    with Image.open(path) as image:
        return np.asarray(image)


def test_n5_a_film_lasts_as_long_as_the_path_and_replays_bit_for_bit(tallgrass: Tallgrass, scene: Path) -> None:
    for folder in ("first", "second"):
        done = tallgrass("film", scene, "-o", f"{folder}/", "--fps", 4, "--size", "96x54")
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    first, second = (sorted((scene.parent / folder).iterdir()) for folder in ("first", "second"))
    assert [path.name for path in first] == [f"{k:05d}.png" for k in range(6)]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in second]
    assert len({path.read_bytes() for path in first}) == 6


@pytest.mark.parametrize("overlay", [(), ("--overlay", "all")], ids=["plain", "n8_overlay"])
def test_a_frame_of_a_still_camera_is_the_shot_of_its_time(
    tallgrass: Tallgrass, scene: Path, overlay: tuple[str, ...]
) -> None:
    before, _, after = scene.read_text().partition("  path:\n")
    scene.write_text(before + after[after.index("quality:") :])
    options = ("--size", "96x54", *overlay)
    assert tallgrass("film", scene, "-o", "film/", "--seconds", 1, "--fps", 4, *options).returncode == 0
    assert tallgrass("shot", scene, "-o", "shot.png", "--time", 0.75, *options).returncode == 0
    np.testing.assert_array_equal(pixels(scene.parent / "film" / "00003.png"), pixels(scene.parent / "shot.png"))


@pytest.mark.parametrize("options", [(), ("--reference", "--preset", "low")], ids=["drawn", "reference"])
def test_a_film_is_one_moving_picture(tallgrass: Tallgrass, scene: Path, options: tuple[str, ...]) -> None:
    done = tallgrass("film", scene, "-o", "a.webp", "--seconds", 0.5, "--fps", 6, "--size", "48x28", *options)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    with Image.open(scene.parent / "a.webp") as film:
        assert (film.size, getattr(film, "n_frames", 1)) == ((48, 28), 3)
