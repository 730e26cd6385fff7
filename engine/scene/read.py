"""Reading scenes: by path, by the name of a bundled one, or from a program's values."""

import os
from atexit import register
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path
from reprlib import repr as shortened
from shutil import rmtree
from stat import S_ISDIR, S_ISREG
from tempfile import mkdtemp
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ... import scenes
from ...components.words import guess, no_file
from ..declared.scene import Scene
from .compose import MOST_BYTES, decode, read_document
from .document import Document, Where
from .problem import MOST_PROBLEMS, Problem, SceneError
from .unusable import unusable
from .validate import validate
from .values import values_document

SceneLike = str | Path | Mapping[str, Any] | Scene
"""A scene: the path of its file, the name of a bundled one, its keys and values, or a `Scene`."""

Stamp = tuple[int, int]
"""A file's time of last change [ns], and its size [bytes]."""

LONGEST_NAME = 255
"""Greatest length of a text that could name a file [characters]."""

SUFFIXES = (".yaml", ".yml")
"""Suffixes of scene files."""


@dataclass(frozen=True, slots=True, eq=False)
class LoadedScene:
    """A scene, and its source."""

    scene: Scene

    path: Path | None
    """File it was read from; None where a program has handed it in."""

    folder: Path
    """Folder to which the file names in the scene are relative."""

    document: Document = field(repr=False)
    """Its values with their positions, for problems that are found later."""

    files: Mapping[str, Stamp] = field(default_factory=dict)
    """Stamps of the files that the scene names, by name, from when it was read."""

    pictures: Mapping[str, NDArray[np.uint8]] = field(default_factory=dict, repr=False)
    """Density maps that replace files, by name, each (rows, columns, 3 or 4); compared by identity."""

    @property
    def file(self) -> Path:
        """File it was read from. Raises ValueError where a program has handed it in."""
        if self.path is None:
            raise ValueError("this scene was made from a program's values; it has no file to write or send")
        return self.path

    @property
    def paths(self) -> dict[str, Path]:
        """The scene's file, if it has one, and the files that it names, by name."""
        own = {} if self.path is None else {self.path.name: self.path}
        return own | {name: self.folder / name for name in self.files}


def bundled_scenes() -> dict[str, Path]:
    """Return the bundled scenes: name and file."""
    return {path.stem: path for path in sorted(_bundle().glob("*.yaml"))}


@cache
def _bundle() -> Path:
    """Return the folder of the bundled scenes; from a zip file they are unpacked into a temporary folder until exit."""
    found = files(scenes)
    folder = Path(str(found))
    if folder.is_dir():
        return folder
    unpacked = Path(mkdtemp(prefix="tallgrass-scenes-"))
    register(rmtree, unpacked, ignore_errors=True)
    for each in found.iterdir():
        if each.is_file():
            (unpacked / each.name).write_bytes(each.read_bytes())
    return unpacked


def read_scene(scene: SceneLike, /) -> LoadedScene:
    """Return the scene of a file, of a bundled scene's name, or of a program's values.

    The files that the scene names must exist; `load_maps` reads them. Files that values name are relative to the
    current folder. Raises SceneError with all problems, including those of its maps that can be found; TypeError for
    anything but a scene.
    """
    path, document = _document(scene)
    try:
        return load_document(document, path)
    except SceneError as error:
        reported = {(problem.line, problem.column) for problem in error.problems}
        found = unusable(document, _folder(path))
        more = [problem for problem in found if (problem.line, problem.column) not in reported]
        if not more or len(error.problems) > MOST_PROBLEMS:  # the last counts the rest
            raise
        raise SceneError([*error.problems, *more]) from error


def read_again(before: LoadedScene, scene: SceneLike | LoadedScene | None, /) -> LoadedScene:
    """Return `scene`, read unless it has been read already; None reads the file of the scene `before` again.

    Raises as `read_scene` does, and ValueError for None if the scene `before` has no file.
    """
    if isinstance(scene, LoadedScene):
        return scene
    if scene is not None:
        return read_scene(scene)
    if before.path is None:
        raise ValueError("this prairie was made from a program's values: call reload with a scene")
    return read_scene(before.path)


def _document(scene: object) -> tuple[Path | None, Document]:
    if isinstance(scene, Mapping | Scene):
        return None, values_document(scene)
    if not isinstance(scene, str | os.PathLike):
        due = "the path of a file, the name of a bundled one, a mapping of its keys or a Scene"
        raise TypeError(f"a scene is {due}, unlike {shortened(scene)}")
    path = _path(scene if isinstance(scene, str) else Path(scene))
    return path, read_document(decode(_bytes(path), file=str(path)), file=str(path))


def _folder(path: Path | None) -> Path:
    return Path() if path is None else path.parent


def load_document(
    document: Document, path: Path | None, /, *, pictures: Mapping[str, NDArray[np.uint8]] | None = None
) -> LoadedScene:
    """Return the scene of a document, with `pictures` in place of the files of these names.

    `path` is the document's file. Raises SceneError with all problems.
    """
    given, folder = pictures or {}, _folder(path)
    missing = _missing_files(document, folder, given)
    scene = validate(document, folder=folder, also=missing)
    files = {name: stamp for name in _names(document.root.data) if (stamp := stamp_of(folder / name))}
    return LoadedScene(scene, path, folder, document, files, given)


def stamp_of(path: Path, /) -> Stamp | None:
    """Return the stamp of a file, which changes with the file; None where there is none."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return (found.st_mtime_ns, found.st_size) if S_ISREG(found.st_mode) else None


def parse_scene(text: str, /, *, file: str = "<scene>") -> Scene:
    """Return the scene of a text, without looking for the files that it names. Raises SceneError."""
    return validate(read_document(text, file=file))


def _path(scene: str | Path) -> Path:
    text = str(scene)
    is_name = isinstance(scene, str) and not text.endswith(SUFFIXES) and not {"/", os.sep} & set(text)
    bundled = bundled_scenes()
    if is_name and text in bundled:
        return bundled[text]
    if not text:
        raise _no_file("this is an empty text, and no scene file's name")
    path = Path(scene)
    mode = _mode(path)
    if S_ISREG(mode):
        return path
    if mode:
        raise _no_file(f"'{text}' is {_irregular(mode)}, not a scene file")
    if is_name:
        raise _no_file(f"no scene file '{text}'{guess(text.lower(), bundled) or ';'} bundled: {', '.join(bundled)}")
    bundle = f"; '{path.stem}' alone is a bundled scene" if path.stem in bundled else ""
    raise _no_file(f"no scene file '{text}'{_guess(path) or bundle}")


def _no_file(message: str) -> SceneError:
    return SceneError([Problem("", 1, 1, message)])


def _bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as stream:
            return stream.read(MOST_BYTES + 1)
    except OSError as error:
        raise _no_file(f"'{path}' cannot be read: {error.strerror}") from error


def _missing_files(document: Document, folder: Path, given: Container[str]) -> Iterator[Problem]:
    for where, name in _named_files(document.root.data):
        if name in given:
            continue
        mode = _mode(folder / name)
        if mode and not S_ISREG(mode):
            yield document.problem(where, f"'{name}' is {_irregular(mode)}, not a map file")
        elif not mode:
            yield document.problem(where, no_file(name) + _guess(folder / name))


def _named_files(values: object) -> Iterator[tuple[Where, str]]:
    match values:
        case {"terrain": {"heights": str(name)}} if name:
            yield ("terrain", "heights"), name
    match values:
        case {"terrain": {"holes": str(name)}} if name:
            yield ("terrain", "holes"), name
    match values:
        case {"grass": dict(kinds)}:
            for kind, declared in kinds.items():
                match declared:
                    case {"place": {"map": str(name)}} if name:
                        yield ("grass", kind, "place", "map"), name


def _names(values: object) -> set[str]:
    """Return the texts among values that could be names of files."""
    names, left = set(), [values]
    while left:
        value = left.pop()
        if isinstance(value, str):
            names |= {value} if "." in value and len(value) <= LONGEST_NAME else set()
        elif isinstance(value, dict):
            left += value.values()
        elif isinstance(value, list):
            left += value
    return names


def _mode(path: Path) -> int:
    """Return a path's mode of `stat`; 0 where nothing exists, or where no file can be."""
    try:
        return path.stat().st_mode
    except (OSError, ValueError):
        return 0


def _irregular(mode: int) -> str:
    """Return the word in messages for something of this mode that is no regular file."""
    return "a folder" if S_ISDIR(mode) else "a device, a pipe or a socket"


def _guess(path: Path) -> str:
    """Return the end of a message on a missing file: the most similar name in its folder."""
    try:
        names = [other.name for other in path.parent.iterdir()]
    except (OSError, ValueError):
        names = []
    return guess(path.name, names, cutoff=0.8)


def must_be_read(thing: object, /) -> None:
    """Raise TypeError for anything but a scene that has been read."""
    if isinstance(thing, str | Path):
        raise TypeError(f"Prairie takes a scene that has been read; load one by Prairie.load({str(thing)!r})")
    if not isinstance(thing, LoadedScene):
        raise TypeError(f"Prairie takes a scene that has been read, not {shortened(thing)}; use Prairie.load")
