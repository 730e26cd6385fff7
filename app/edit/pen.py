"""Writing a draft back into the files that it came from, and nothing into them but what has changed."""

import re
import shutil
from collections.abc import Container, Mapping
from io import BytesIO
from itertools import count
from pathlib import Path
from typing import Any

from PIL import Image

from ...engine.scene import LoadedScene, bundled_scenes
from ...engine.scene.compose import decode
from ...engine.terrain.density import Picture
from .rewrite import rewritten
from .values import value_at

_MARK = b"\xef\xbb\xbf"


class Pen:
    """Writes drafts of one scene; a bundled one is written as a copy of its own, into the working folder."""

    def __init__(self, loaded: LoadedScene) -> None:
        self.path = loaded.file
        self._bytes = self.path.read_bytes()
        self._names = [*loaded.files]
        self._written: dict[str, Picture] = {}
        self._files: dict[str, bytes] = {}
        """What was in the files of maps that are painted."""

    def know(self, name: str, picture: Picture) -> None:
        """Remember a map's file as it is: it is not written again unchanged, and never over another's changes."""
        if name not in self._written:
            self._written[name], self._files[name] = picture, (self.path.parent / name).read_bytes()

    def write(self, values: dict[str, Any], pictures: Mapping[str, Picture]) -> list[str]:
        """Write what has changed, and return the names of the files. Raises ValueError with a sentence if it cannot."""
        before = decode(self._bytes, file=str(self.path))
        mark = _MARK if self._bytes.startswith(_MARK) else b""
        after = mark + rewritten(before, values).encode()
        maps = {name: each for name, each in pictures.items() if self._written.get(name) is not each}
        maps = {name: each for name, each in maps.items() if name in maps_of(values)}
        if after == self._bytes and not maps:
            return []
        painted = {name: picture_bytes(picture, name) for name, picture in maps.items()}
        try:
            _must_be(self.path, self._bytes)
            folder = self._moved()
            for name in painted:
                if (folder / name).exists():
                    _must_be(folder / name, self._files.get(name))
            for name, data in painted.items():
                _put(folder / name, data)
            scene = [self.path.name] if after != self._bytes or folder != self.path.parent else []
            if scene:
                _put(folder / self.path.name, after)
        except OSError as error:
            raise ValueError(f"{error.filename}: {error.strerror}") from error
        self.path, self._bytes = folder / self.path.name, after
        self._written.update(maps)
        self._files.update(painted)
        return [*scene, *maps]

    def new_map(self, kind: str, taken: Container[str]) -> str:
        """Return a name for the map of a kind of grass that neither a file nor a map has yet."""
        stem = f"{self.path.stem}-{re.sub(r'[^A-Za-z0-9_-]+', '-', kind)}"
        names = (f"{stem}{'' if number == 1 else f'-{number}'}.png" for number in count(1))
        return next(name for name in names if name not in taken and not (self._folder / name).exists())

    @property
    def _is_bundled(self) -> bool:
        return self.path in bundled_scenes().values()

    @property
    def _folder(self) -> Path:
        """The folder to write into: of a bundled scene it is the working folder."""
        return Path.cwd() if self._is_bundled else self.path.parent

    def _moved(self) -> Path:
        """Return the folder to write into: a bundled scene is copied there, with what it names."""
        folder = self._folder
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
    """Return the names of the density maps that the values of a scene name."""
    kinds = values.get("grass")
    places = [value_at(kind, ("place", "map")) for kind in kinds.values()] if isinstance(kinds, dict) else []
    return {name for name in places if isinstance(name, str)}


def picture_bytes(picture: Picture, name: str, /) -> bytes:
    """Return a density map as a file of its name's kind. Raises ValueError for one that loses what is painted."""
    ending = Path(name).suffix.lower()
    if ending not in (".png", ".bmp", ".tga", ".tif", ".tiff"):
        raise ValueError(f"{name}: a painted map is written as .png; let the scene name one")
    stream = BytesIO()
    Image.fromarray(picture).save(stream, Image.registered_extensions()[ending])
    return stream.getvalue()


def _must_be(path: Path, data: bytes | None) -> None:
    """Raise ValueError where there is something else in a file than what is known of it."""
    if path.read_bytes() != data:
        raise ValueError(
            f"{path.name} has been changed by somebody else: F5 reads it again, and what is not saved is gone"
        )


def _put(path: Path, data: bytes) -> None:
    """Write a file in one step: nobody ever finds half of it. A link stays one, and who may read it."""
    path = path.resolve()
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(data)
        if path.exists():
            shutil.copymode(path, part)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
