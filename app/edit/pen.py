"""Writing the changes of a draft back into its files."""

import re
import shutil
from collections.abc import Container, Mapping
from io import BytesIO
from itertools import count
from pathlib import Path
from stat import S_IWGRP, S_IWOTH, S_IWUSR
from typing import Any

from PIL import Image

from ...engine.kept import replacing
from ...engine.scene import LoadedScene, bundled_scenes
from ...engine.scene.compose import decode
from ...engine.terrain.density import Picture
from .rewrite import rewritten
from .values import value_at, with_value

_BOM = b"\xef\xbb\xbf"

WRITABLE = S_IWUSR | S_IWGRP | S_IWOTH
"""Permissions of a file, any of which lets somebody write it."""


class Pen:
    """Writes drafts of one scene; a bundled scene is copied into the working folder first."""

    def __init__(self, loaded: LoadedScene) -> None:
        self.path = loaded.file
        self._bytes = self.path.read_bytes()
        self._names = [*loaded.files]
        self._written: dict[str, Picture] = {}
        self._files: dict[str, bytes] = {}
        """Contents of the painted maps' files, by name."""

    def know(self, name: str, picture: Picture) -> None:
        """Remember a map and its file: an unchanged map is not written, nor a file that others have changed."""
        if name not in self._written:
            self._written[name], self._files[name] = picture, (self.path.parent / name).read_bytes()

    def write(self, values: dict[str, Any], pictures: Mapping[str, Picture]) -> list[str]:
        """Write what has changed, and return the names of the files. Raises ValueError with a sentence on failure."""
        before = decode(self._bytes, file=str(self.path))
        bom = _BOM if self._bytes.startswith(_BOM) else b""
        after = bom + rewritten(before, values).encode()
        maps = self._painted(values, pictures)
        same = after == self._bytes and self.path.exists()
        if same and not maps:
            return []
        painted = {name: picture_bytes(picture, name) for name, picture in maps.items()}
        try:
            _require(self.path, self._bytes)
            folder = self._copied()
            scene = [] if same and folder == self.path.parent else [self.path.name]
            for name in painted:
                _require(folder / name, self._files.get(name))
            for name in [*scene, *painted]:
                _require_writable(folder / name)
            for name, data in painted.items():
                _write(folder / name, data)
                self._written[name], self._files[name] = maps[name], data
            if scene:
                _write(folder / self.path.name, after)
        except OSError as error:
            raise ValueError(f"{self.folder} cannot be written to: {error.strerror}") from error
        self.path, self._bytes = folder / self.path.name, after
        return [*scene, *maps]

    def copy(self, values: dict[str, Any], pictures: Mapping[str, Picture], name: str) -> list[Path]:
        """Write the scene as a file of this name beside its own, with painted maps; return the files, the scene first.

        Painted maps get names that begin with the copy's. Raises ValueError or OSError on failure.
        """
        painted = {
            each: (f"{Path(name).stem}-{Path(each).name}", picture_bytes(picture, each))
            for each, picture in self._painted(values, pictures).items()
        }
        for kind, grass in values.get("grass", {}).items():
            way = "grass", kind, "place", "map"
            if value_at(grass, way[2:]) in painted:
                values = with_value(values, way, painted[value_at(grass, way[2:])][0])
        after = rewritten(decode(self._bytes, file=str(self.path)), values).encode()
        for each in self._names if self._is_bundled else ():
            if not (self.folder / each).exists():
                shutil.copyfile(self.path.parent / each, self.folder / each)
        contents = {name: after, **dict(painted.values())}
        for each, data in contents.items():
            _write(self.folder / each, data)
        return [self.folder / each for each in contents]

    def _painted(self, values: dict[str, Any], pictures: Mapping[str, Picture]) -> dict[str, Picture]:
        """Return those maps of a scene's values that are not written as they are painted."""
        maps = {name: each for name, each in pictures.items() if self._written.get(name) is not each}
        return {name: each for name, each in maps.items() if name in maps_of(values)}

    def new_map(self, kind: str, taken: Container[str]) -> str:
        """Return an unused file name for the map of a kind of grass."""
        stem = f"{self.path.stem}-{re.sub(r'[^A-Za-z0-9_-]+', '-', kind)}"
        names = (f"{stem}{'' if number == 1 else f'-{number}'}.png" for number in count(1))
        return next(name for name in names if name not in taken and not (self.folder / name).exists())

    @property
    def _is_bundled(self) -> bool:
        return self.path in bundled_scenes().values()

    @property
    def folder(self) -> Path:
        """Folder to write into: for a bundled scene the working folder, else the scene's own."""
        return Path.cwd() if self._is_bundled else self.path.parent

    def _copied(self) -> Path:
        """Return the folder to write into, after copying a bundled scene's files there."""
        folder = self.folder
        if not self._is_bundled:
            return folder
        if (folder / self.path.name).exists():
            raise ValueError(f"{self.path.name} is in this folder already; walk in that one, or move it away")
        for name in self._names:
            there, here = self.path.parent / name, folder / name
            if there.is_file() and here.exists() and here.read_bytes() != there.read_bytes():
                raise ValueError(f"another {name} is in this folder already; move it away")
            if there.is_file() and not here.exists():
                shutil.copyfile(there, here)
        return folder


def maps_of(values: dict[str, Any], /) -> set[str]:
    """Return the names of the density maps in the values of a scene."""
    kinds = values.get("grass")
    places = [value_at(kind, ("place", "map")) for kind in kinds.values()] if isinstance(kinds, dict) else []
    return {name for name in places if isinstance(name, str)}


def picture_bytes(picture: Picture, name: str, /) -> bytes:
    """Return a density map encoded by its name's ending. Raises ValueError for a lossy format."""
    ending = Path(name).suffix.lower()
    if ending not in (".png", ".bmp", ".tga", ".tif", ".tiff"):
        raise ValueError(f"{name}: a painted map is written as .png; let the scene name one")
    stream = BytesIO()
    Image.fromarray(picture).save(stream, Image.registered_extensions()[ending])
    return stream.getvalue()


def _require(path: Path, data: bytes | None) -> None:
    """Raise ValueError where a file that is there does not contain `data`."""
    if path.exists() and path.read_bytes() != data:
        raise ValueError(
            f"{path.name} has been changed by somebody else: F5 reads it again, and what is not saved is gone"
        )


def _require_writable(path: Path) -> None:
    """Raise ValueError for a file that nobody may write: as a new one takes its place, the system would allow it."""
    if path.exists() and not path.stat().st_mode & WRITABLE:
        raise ValueError(f"{path.name} is read-only: allow writing it, and save again")


def _write(path: Path, data: bytes) -> None:
    """Write a file atomically. A link stays a link, and permissions stay."""
    path = path.resolve()
    with replacing(path) as part:
        part.write_bytes(data)
        if path.exists():
            shutil.copymode(path, part)
