"""Pictures and films as files."""

import sys
import weakref
from collections.abc import Iterator
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from PIL import Image

from tallgrass.app.studio.encode import Picture, Reel, film_writer, picture_writer
from tallgrass.app.studio.errors import InputError, MachineError

ABOUT = {"scene": "somewhere", "seed": "7"}
SIZE = (32, 18)


def picture(number: int) -> Picture:
    """A dark picture with a bright column at `number`."""
    pixels = np.full((SIZE[1], SIZE[0], 3), (10, 60, 20), np.uint8)
    pixels[:, number] = 250
    return pixels


def reel(count: int = 6, fps: int = 24) -> Reel:
    return Reel((picture(k) for k in range(count)), count, fps, ABOUT)


def frames_of(path: Path) -> tuple[list[Picture], list[int]]:
    """Return a film's pictures and durations [ms]."""
    with Image.open(path) as film:
        pictures, durations = [], []
        for number in range(getattr(film, "n_frames", 1)):
            film.seek(number)
            pictures.append(np.asarray(film.convert("RGB")))
            durations.append(cast("int", film.info.get("duration", 0)))
    return pictures, durations


def columns(pictures: list[Picture]) -> list[int]:
    return [int(pixels[:, :, 0].sum(0).argmax()) for pixels in pictures]


def test_a_picture_is_written_as_it_is_with_its_story(tmp_path: Path) -> None:
    path = tmp_path / "new" / "folder" / "a.png"
    picture_writer(str(path))(picture(3), ABOUT)
    with Image.open(path) as image:
        np.testing.assert_array_equal(np.asarray(image), picture(3))
        assert {key: image.info[key] for key in ABOUT} == ABOUT
    assert [file.name for file in path.parent.iterdir()] == ["a.png"]


@pytest.mark.parametrize("name", ["a.webp", "a.gif"])
def test_a_film_shows_every_frame_in_order_for_its_time(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    film_writer(str(path), SIZE, 24)(reel())
    pictures, durations = frames_of(path)
    assert columns(pictures) == [0, 1, 2, 3, 4, 5]
    assert sum(durations) == pytest.approx(6 * 1000 / 24, abs=5)
    assert max(durations) - min(durations) <= 10
    assert b"scene somewhere, seed 7" in path.read_bytes()


@pytest.mark.parametrize("name", ["a.webp", "a.gif"])
def test_a_film_of_one_frame_is_one_picture(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    film_writer(str(path), SIZE, 24)(reel(1))
    assert columns(frames_of(path)[0]) == [0]


@pytest.mark.parametrize("name", ["there", "frames/", "frames.of.mine/"])
def test_a_folder_takes_numbered_pictures_that_know_their_time(tmp_path: Path, name: str) -> None:
    (tmp_path / "there").mkdir()
    film_writer(f"{tmp_path}/{name}", SIZE, 8)(reel(3, fps=8))
    files = sorted((tmp_path / name).iterdir())
    assert [file.name for file in files] == ["00000.png", "00001.png", "00002.png"]
    with Image.open(files[2]) as image:
        np.testing.assert_array_equal(np.asarray(image), picture(2))
        assert (image.info["time"], image.info["seed"]) == ("0.25", "7")


@pytest.mark.parametrize("name", ["a.webp", "a.gif", "frames/"])
def test_frames_are_drawn_as_they_are_written_and_then_let_go(tmp_path: Path, name: str) -> None:
    drawn: list[weakref.ref[Picture]] = []
    kept: list[int] = []

    def frames() -> Iterator[Picture]:
        for number in range(12):
            kept.append(sum(frame() is not None for frame in drawn))
            pixels = picture(number)
            drawn.append(weakref.ref(pixels))
            yield pixels
            del pixels

    film_writer(f"{tmp_path}/{name}", SIZE, 24)(Reel(frames(), 12, 24, ABOUT))
    assert len(kept) == 12
    assert max(kept) <= 2


def test_a_film_that_breaks_off_leaves_the_older_one(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    path.write_bytes(b"older")

    def frames() -> Iterator[Picture]:
        yield picture(0)
        raise RuntimeError("the lamp went out")

    with pytest.raises(RuntimeError, match="the lamp"):
        film_writer(str(path), SIZE, 24)(Reel(frames(), 2, 24, ABOUT))
    assert [file.name for file in tmp_path.iterdir()] == ["a.gif"]
    assert path.read_bytes() == b"older"


@pytest.mark.parametrize(
    ("name", "size", "fps", "says"),
    [
        ("a.avi", SIZE, 24, r"-o: .*a\.avi: a film ends in \.webp, \.gif or \.mp4, or is a folder, which ends in /$"),
        ("noext", SIZE, 24, r"-o: .*noext: a film ends in \.webp, \.gif or \.mp4, or is a folder, which ends in /$"),
        ("a.gif", SIZE, 60, r"--fps: 60: a \.gif shows at most 50"),
        ("a.mp4", (33, 18), 24, r"--size: 33x18: an \.mp4 needs an even width and height"),
        ("a.webp", (16384, 2), 24, r"--size: 16384x2: a \.webp has at most 16383"),
        ("file/a.gif", SIZE, 24, r"-o: .*file: is a file, not a folder"),
        ("file/", SIZE, 24, r"-o: .*file: is a file, not a folder"),
        ("folder.webp", SIZE, 24, r"-o: .*folder\.webp: is a folder, not a file"),
    ],
)
def test_what_a_film_cannot_be_is_told_before_it_is_drawn(
    tmp_path: Path, name: str, size: tuple[int, int], fps: int, says: str
) -> None:
    (tmp_path / "file").write_text("in the way")
    (tmp_path / "folder.webp").mkdir()
    with pytest.raises(InputError, match=says):
        film_writer(f"{tmp_path}/{name}", size, fps)


@pytest.mark.parametrize(("name", "says"), [("a.jpg", r"ends in \.png"), ("folder.png", "is a folder, not a file")])
def test_where_a_picture_cannot_go_is_told_before_it_is_drawn(tmp_path: Path, name: str, says: str) -> None:
    (tmp_path / "folder.png").mkdir()
    with pytest.raises(InputError, match=says):
        picture_writer(str(tmp_path / name))


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="a folder is needed that not even root can write to")
def test_a_folder_that_cannot_be_written_to_is_told_before_anything_is_drawn() -> None:
    with pytest.raises(InputError, match=r"^-o: /proc/self: this folder cannot be written to$"):
        picture_writer("/proc/self/a.png")


def test_without_ffmpeg_an_mp4_says_what_installs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    with pytest.raises(MachineError, match=r"pip install 'tallgrass\[video\]'"):
        film_writer(str(tmp_path / "a.mp4"), SIZE, 24)


def test_an_mp4_is_written_where_ffmpeg_is(tmp_path: Path) -> None:
    ffmpeg = pytest.importorskip("imageio_ffmpeg", reason="the extra 'video' is not installed")
    path = tmp_path / "a.mp4"
    film_writer(str(path), SIZE, 24)(reel())
    assert [file.name for file in tmp_path.iterdir()] == ["a.mp4"]
    assert ffmpeg.count_frames_and_secs(str(path)) == (6, pytest.approx(0.25))
