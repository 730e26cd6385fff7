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
        self.path = loaded.path
        self._bytes = loaded.path.read_bytes()
        self._names = [*loaded.files]
        self._written: dict[str, Picture] = {}

    def know(self, name: str, picture: Picture) -> None:
        """Remember what is in the file of a map, so that it is not written again."""
        self._written.setdefault(name, picture)

    def write(self, values: dict[str, Any], pictures: Mapping[str, Picture]) -> list[str]:
        """Write what has changed, and return the names of the files. Raises ValueError with a sentence if it cannot."""
        before = decode(self._bytes, file=str(self.path))
        mark = _MARK if self._bytes.startswith(_MARK) else b""
        after = mark + rewritten(before, values).encode()
        maps = {name: each for name, each in pictures.items() if self._written.get(name) is not each}
        maps = {name: each for name, each in maps.items() if name in maps_of(values)}
        if after == self._bytes and not maps:
            return []
        try:
            self._must_be_ours()
            folder = self._moved()
            for name, picture in maps.items():
                _put(folder / name, picture_bytes(picture, name))
            scene = [self.path.name] if after != self._bytes or folder != self.path.parent else []
            if scene:
                _put(folder / self.path.name, after)
        except OSError as error:
            raise ValueError(f"{error.filename}: {error.strerror}") from error
        self.path, self._bytes = folder / self.path.name, after
        self._written.update(maps)
        return [*scene, *maps]

    def new_map(self, kind: str, taken: Container[str]) -> str:
        """Return a name for the map of a kind of grass that neither a file nor a map has yet."""
        stem = f"{self.path.stem}-{re.sub(r'[^A-Za-z0-9_-]+', '-', kind)}"
        names = (f"{stem}{'' if number == 1 else f'-{number}'}.png" for number in count(1))
        return next(name for name in names if name not in taken and not (self.path.parent / name).exists())

    def _must_be_ours(self) -> None:
        if self.path.read_bytes() != self._bytes:
            raise ValueError(
                f"{self.path.name} has been changed by somebody else: F5 reads it again, and what is not saved is gone"
            )

    def _moved(self) -> Path:
        """Return the folder to write into: a bundled scene is copied to the working folder, with what it names."""
        if self.path not in bundled_scenes().values():
            return self.path.parent
        folder = Path.cwd()
        if (folder / self.path.name).exists():
            raise ValueError(f"{self.path.name} is in this folder already; walk in that one, or move it away")
        for name in self._names:
            if (self.path.parent / name).is_file() and not (folder / name).exists():
                shutil.copyfile(self.path.parent / name, folder / name)
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


def _put(path: Path, data: bytes) -> None:
    """Write a file in one step: nobody ever finds half of it."""
    part = path.with_name(path.name + ".part")
    try:
        part.write_bytes(data)
        part.replace(path)
    finally:
        part.unlink(missing_ok=True)
