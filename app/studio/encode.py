"""Writing pictures and films to files."""

import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryFile
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from PIL import ExifTags, Image
from PIL.PngImagePlugin import PngInfo

from ...engine.kept import replacing
from .errors import InputError, needed

Picture = NDArray[np.uint8]
"""sRGB, top row first, shape (height, width, 3)."""


Frame = Picture | bytes
"""A picture; or, for a folder of pictures, the bytes of its file, as `png` returns them."""


@dataclass(frozen=True, slots=True)
class Reel:
    """The frames of a film, drawn as they are asked for."""

    frames: Iterator[Frame]
    """Frames of one size, `count` of them."""

    count: int
    """Number of frames."""

    fps: int
    """Frames per second."""

    about: Mapping[str, str]
    """Metadata of the film: `seed`, `scene`, `version` and the like."""

    first: int = 0
    """Index of its first frame, which shows the time `first / fps` [s]."""


def picture_writer(output: str, /) -> Callable[[Picture, Mapping[str, str]], None]:
    """Return a function that writes a picture to `output` as PNG, with its metadata as text entries.

    Raises InputError where `output` does not end in .png or cannot be written.
    """
    path = Path(output)
    if path.suffix.lower() != ".png":
        raise InputError(f"-o: {output}: a picture ends in .png")
    make_room(path)
    return lambda picture, about: _write_bytes(png(picture, about), path)


ENDINGS = (".webp", ".gif", ".mp4")
"""Endings of films in a single file."""


def film_writer(output: str, size: tuple[int, int], fps: int, /) -> Callable[[Reel], None]:
    """Return a function that writes a film to `output`, in the format of its ending; a folder takes numbered PNG files.

    `size` is (width, height) [pixels]. A name that ends in / becomes a folder; a name with one of `ENDINGS` is a folder
    only with that /.
    Raises InputError where `output` cannot be written or hold such a film, MachineError where its encoder is missing.
    """
    path = Path(output)
    ending = path.suffix.lower()
    write: Callable[[Reel], None]
    if is_folder(output):
        make_folder(path)
        return lambda reel: _write_folder(reel, path)
    if ending == ".webp":
        if max(size) > 16383:
            raise InputError(f"--size: {size[0]}x{size[1]}: a .webp has at most 16383 pixels along a side")
        write = partial(_write_webp, path=path)
    elif ending == ".gif":
        if fps > 50:
            raise InputError(f"--fps: {fps}: a .gif shows at most 50 frames per second")
        write = partial(_write_gif, path=path)
    elif ending == ".mp4":
        if size[0] % 2 or size[1] % 2:
            raise InputError(f"--size: {size[0]}x{size[1]}: an .mp4 needs an even width and height")
        ffmpeg = needed("imageio_ffmpeg", "an .mp4 is written by ffmpeg, a .webp without it", extra="video")
        write = partial(_write_mp4, path=path, size=size, ffmpeg=ffmpeg)
    else:
        raise InputError(f"-o: {output}: a film ends in .webp, .gif or .mp4, or is a folder, which ends in /")
    make_room(path)
    return write


def is_folder(output: str, /) -> bool:
    """Return whether a film goes into a folder, as numbered pictures."""
    return output.endswith(("/", os.sep)) or (Path(output).is_dir() and Path(output).suffix.lower() not in ENDINGS)


class _Animation(Image.Image):
    """An image of many frames that draws a frame when an encoder seeks it, so that only one is in memory."""

    def __init__(self, reel: Reel) -> None:
        super().__init__()
        self._reel = reel
        self._at = -1
        self.n_frames = reel.count
        self.is_animated = True
        self.seek(0)

    def seek(self, frame: int) -> None:
        if frame >= self.n_frames:
            raise EOFError
        while self._at < frame:
            image = Image.fromarray(np.asarray(next(self._reel.frames)))
            self.im, self._mode, self._size = image.im, image.mode, image.size
            self._at += 1

    def tell(self) -> int:
        return self._at


def make_folder(folder: Path, /) -> None:
    """Make a folder and those above it; raises InputError, as of `-o`, where it cannot be made or written to."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise InputError(f"-o: {error.filename}: is a file, not a folder") from None
    except OSError as error:
        raise InputError(f"-o: {error.filename}: {error.strerror}") from None
    try:
        with TemporaryFile(dir=folder):
            pass
    except OSError:
        raise InputError(f"-o: {folder}: this folder cannot be written to") from None


def make_room(path: Path, /) -> None:
    """Make the folder that a file is to be in; raises InputError, as of `-o`, where the file cannot be written."""
    make_folder(path.parent)
    if path.is_dir():
        raise InputError(f"-o: {path}: is a folder, not a file")


def png(picture: Picture, about: Mapping[str, str], /) -> bytes:
    """Return a picture as the bytes of a PNG file, with text entries that say how it was made."""
    info, file = PngInfo(), BytesIO()
    for key, text in about.items():
        info.add_itxt(key, text)
    Image.fromarray(picture).save(file, "PNG", pnginfo=info)
    return file.getvalue()


def at_frame(about: Mapping[str, str], number: int, fps: int, /) -> dict[str, str]:
    """Return the metadata of a film's frame."""
    return {**about, "time": f"{number / fps:.6g}"}


def _write_bytes(data: bytes, path: Path) -> None:
    with replacing(path) as part:
        part.write_bytes(data)


def _write_folder(reel: Reel, folder: Path) -> None:
    for number, frame in enumerate(reel.frames, reel.first):
        data = frame if isinstance(frame, bytes) else png(frame, at_frame(reel.about, number, reel.fps))
        _write_bytes(data, folder / f"{number:05d}.png")


def _write_webp(reel: Reel, path: Path) -> None:
    exif = Image.Exif()
    exif[ExifTags.Base.ImageDescription] = _sentence(reel.about)
    duration = 1000.0 / reel.fps
    with replacing(path) as part:
        _Animation(reel).save(part, "WEBP", save_all=True, duration=duration, loop=0, quality=80, method=4, exif=exif)


def _write_gif(reel: Reel, path: Path) -> None:
    ticks = [round(100.0 * k / reel.fps) for k in range(reel.first, reel.first + reel.count + 1)]
    durations = [10 * (after - before) for before, after in pairwise(ticks)]
    comment = _sentence(reel.about).encode()
    with replacing(path) as part:
        _Animation(reel).save(part, "GIF", save_all=True, duration=durations, loop=0, comment=comment)


def _write_mp4(reel: Reel, path: Path, size: tuple[int, int], ffmpeg: ModuleType) -> None:
    about = ["-f", "mp4", "-crf", "20", "-metadata", f"comment={_sentence(reel.about)}"]
    with replacing(path) as part:
        sink = ffmpeg.write_frames(
            str(part), size, fps=reel.fps, codec="libx264", macro_block_size=1, quality=None, output_params=about
        )
        sink.send(None)
        for frame in reel.frames:
            sink.send(frame)
        sink.close()


def write_whole(text: str, path: Path, /) -> None:
    """Write a text file, which takes the place of another only once it is whole."""
    _write_bytes(text.encode(), path)


def _sentence(about: Mapping[str, str]) -> str:
    return ", ".join(f"{key} {text}" for key, text in about.items())
