"""Films from the command line."""

import hashlib
import json
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from tallgrass.app.cli import run

MANIFEST = (Path(__file__).parents[2] / "docs" / "farm.md").read_text("utf-8")

Tallgrass = Callable[..., subprocess.CompletedProcess[str]]
pytestmark = [pytest.mark.gl, pytest.mark.usefixtures("ctx")]


@pytest.fixture
def tallgrass(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Tallgrass:
    """Return the function that runs the command in a folder of its own, in this process."""
    monkeypatch.chdir(tmp_path)

    def done(*arguments: object) -> subprocess.CompletedProcess[str]:
        words = [*map(str, arguments)]
        status = run(words)
        return subprocess.CompletedProcess(words, status, *capsys.readouterr())

    return done


def pixels(path: Path) -> NDArray[np.uint8]:
    with Image.open(path) as image:
        return np.asarray(image)


def test_a_folder_where_the_manifest_goes_is_told_before_anything_is_drawn(tallgrass: Tallgrass, scene: Path) -> None:
    (scene.parent / "film.webp.json").mkdir()
    done = tallgrass("film", scene, "-o", scene.parent / "film.webp")
    assert (done.returncode, done.stderr.count("\n")) == (2, 1)
    assert "film.webp.json: is a folder, not a file" in done.stderr
    assert not (scene.parent / "film.webp").exists()


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
    scene.write_text(before.replace("\ncamera:", f"{PRESSERS.rstrip()}\ncamera:") + after[after.index("quality:") :])
    options = ("--size", "96x54", *overlay)
    assert tallgrass("film", scene, "-o", "film/", "--seconds", 1, "--fps", 4, *options).returncode == 0
    assert tallgrass("shot", scene, "-o", "shot.png", "--time", 0.75, *options).returncode == 0
    np.testing.assert_array_equal(pixels(scene.parent / "film" / "00003.png"), pixels(scene.parent / "shot.png"))


@pytest.mark.parametrize(
    "options",
    [(), pytest.param(("--reference", "--preset", "low"), marks=pytest.mark.slow)],
    ids=["drawn", "reference"],
)
def test_a_film_is_one_moving_picture(tallgrass: Tallgrass, scene: Path, options: tuple[str, ...]) -> None:
    done = tallgrass("film", scene, "-o", "a.webp", "--seconds", 0.5, "--fps", 6, "--size", "48x28", *options)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    with Image.open(scene.parent / "a.webp") as film:
        assert (film.size, getattr(film, "n_frames", 1)) == ((48, 28), 3)


PATH = """
    - { at: 0, position: [0, 22], pitch: -18 }
    - { at: 2, position: [3, 8], pitch: -18, yaw: 40 }
    - { at: 4, position: [-9, -6], pitch: -18, yaw: 100 }
"""
WINDS = """
  - { kind: gust, position: [-20, 0], speed: 9, reach: 60, width: 50, every: [1, 2], wander: 10 }
  - { kind: whirlwind, path: [{ at: 0, position: [-4, 4] }, { at: 3, position: [6, 0] }] }
  - kind: blast
    body: saucer
    outline: { image: ring.png }
    path: [{ at: 0, position: [9, 0] }, { at: 4, position: [0, 9] }]
"""
PRESSERS = """
pressers:
  - { radius: 0.5, path: [{ at: 0, position: [-2, 16] }, { at: 2, position: [3, 12] }, { at: 4, position: [-6, -8] }] }
"""


@pytest.fixture
def stormy(scene: Path) -> Path:
    """A scene with every wind, and a camera that makes patches change all the time."""
    before, _, after = scene.read_text().partition("  path:\n")
    before = before.replace("\ncamera:", f"{WINDS.rstrip()}\n{PRESSERS.rstrip()}\ncamera:")
    scene.write_text(before + "  path:" + PATH + after[after.index("quality:") :])
    ring = np.zeros((32, 32), np.uint8)
    ring[8:24, 8:24] = 255
    Image.fromarray(ring).save(scene.parent / "ring.png")
    return scene


def test_n5_a_range_of_frames_is_that_of_the_whole_film_byte_for_byte(tallgrass: Tallgrass, stormy: Path) -> None:
    folder, options = stormy.parent, ("--fps", 4, "--size", "96x54")
    assert tallgrass("film", stormy, "-o", "whole/", *options).returncode == 0
    for span in ("5:8", "14:"):
        done = tallgrass("film", stormy, "-o", f"part-{span}/", "--frames", span, *options)
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    whole = {path.name: path.read_bytes() for path in (folder / "whole").iterdir()}
    assert len(whole) == len(set(whole.values())) == 16
    for span, numbers in (("5:8", range(5, 8)), ("14:", range(14, 16))):
        part = {path.name: path.read_bytes() for path in (folder / f"part-{span}").iterdir()}
        assert part == {name: whole[name] for name in (f"{number:05d}.png" for number in numbers)}


def test_n5_a_manifest_says_what_a_film_was_made_from(tallgrass: Tallgrass, stormy: Path) -> None:
    folder, options = stormy.parent, ("--fps", 4, "--size", "48x28", "--seconds", 1)
    assert tallgrass("film", stormy, "-o", "a.webp", *options).returncode == 0
    assert tallgrass("film", stormy, "-o", "part/", "--frames", "1:3", *options).returncode == 0
    whole, part = (json.loads((folder / name).read_text()) for name in ("a.webp.json", "part.1-3.json"))
    assert whole["frames"] == {"first": 0, "end": 4, "of": 4}
    assert part["frames"] == {"first": 1, "end": 3, "of": 4}
    assert part["pictures"] == whole["pictures"][1:3]
    assert part["pictures"][0]["time"] == 0.25
    for row in part["pictures"]:
        drawn = pixels(folder / "part" / f"{row['frame']:05d}.png")
        assert hashlib.sha256(drawn.tobytes()).hexdigest() == row["sha256"]
    for same in ("tallgrass", "scene", "seed", "size", "fps", "quality", "renderer", "files"):
        assert whole[same] == part[same]
    assert whole["files"] == {
        name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in (stormy.name, "ring.png")
    }
    assert str(folder) not in (folder / "a.webp.json").read_text()
    told = {key for line in MANIFEST.splitlines() if line.startswith("| `") for key in re.findall("`(\\w+)`", line)}
    assert whole.keys() | whole["frames"].keys() | whole["pictures"][0].keys() <= told, "the page tells of every key"


@pytest.mark.parametrize(
    ("span", "told"),
    [
        ("3", "--frames: '3' is not a range of frames like 100:130"),
        ("5:5", "--frames: '5:5': there is no frame from 5 to before 5"),
        ("4:90", "--frames: 4:90: the film has the frames 0:6"),
        ("6:", "--frames: 6:: the film has the frames 0:6"),
    ],
)
def test_frames_that_a_film_has_not_are_one_line(tallgrass: Tallgrass, scene: Path, span: str, told: str) -> None:
    done = tallgrass("film", scene, "-o", "a/", "--frames", span, "--fps", 4, "--size", "96x54")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", told + "\n")


@pytest.mark.skipif(sys.platform == "win32", reason="a process is ended there without being asked")
@pytest.mark.parametrize("name", ["a.webp", *(pytest.param(name, marks=pytest.mark.slow) for name in ("a.gif", "a/"))])
def test_a_film_that_is_asked_to_end_leaves_no_part_of_a_file(scene: Path, name: str) -> None:
    words = [sys.executable, "-m", "tallgrass.app.cli", "film", scene.name, "-o", name, "--seconds", "3600"]
    folder = scene.parent / "a" if name == "a/" else scene.parent
    with subprocess.Popen([*words, "--size", "96x54"], cwd=scene.parent, stderr=subprocess.PIPE, text=True) as filming:
        while filming.poll() is None and not [*folder.glob(".*.part"), *folder.glob("*.png")]:
            time.sleep(0.02)
        filming.send_signal(signal.SIGTERM)
        _, told = filming.communicate(timeout=60)
    assert filming.returncode == 143
    assert "Traceback" not in told
    assert not [path.name for path in folder.iterdir() if ".part" in path.name]
    left = {path.name for path in scene.parent.iterdir()} - {scene.name, "a"}
    assert left == set()
    for picture in folder.glob("*.png"):
        assert pixels(picture).shape == (54, 96, 3), "what is there is whole"
