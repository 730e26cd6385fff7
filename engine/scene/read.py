"""Reading scenes: by path, by the name of a bundled one, or from a program's values."""

import os
from atexit import register
from collections.abc import Container, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
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
from ..declared.scene import Scene
from .compose import MOST_BYTES, decode, read_document
from .document import Document, Where
from .problem import MOST_PROBLEMS, Problem, SceneError
from .unusable import unusable
from .validate import validate
from .values import values_document

SceneLike = str | Path | Mapping[str, Any] | Scene
"""What names or is a scene: the path of a file, the name of a bundled one, its keys and values, or a `Scene`."""

Stamp = tuple[int, int]
"""When a file was last changed [ns], and its size [bytes]."""

LONGEST_NAME = 255
"""Most characters of a file's name that is looked for."""

SUFFIXES = (".yaml", ".yml")
"""What a scene file's name ends with."""


@dataclass(frozen=True, slots=True, eq=False)
class LoadedScene:
    """A scene, and where it comes from."""

    scene: Scene

    path: Path | None
    """The file it was read from; None where a program has handed it in."""

    folder: Path
    """What the scene's own file names are relative to."""

    document: Document = field(repr=False)
    """Its values with their places, for problems that show later."""

    files: Mapping[str, Stamp] = field(default_factory=dict)
    """The files that the scene names, as it names them, and what they were like when it was read."""

    pictures: Mapping[str, NDArray[np.uint8]] = field(default_factory=dict, repr=False)
    """Density maps in place of files of these names, (rows, columns, 3 or 4) each; another array is another map."""

    @property
    def file(self) -> Path:
        """The file it was read from. Raises ValueError where a program has handed it in."""
        if self.path is None:
            raise ValueError("this scene was made from a program's values: what writes or sends it needs a file")
        return self.path

    @property
    def paths(self) -> dict[str, Path]:
        """The scene's file, if it has one, and those that it names, by the names that it calls them."""
        own = {} if self.path is None else {self.path.name: self.path}
        return own | {name: self.folder / name for name in self.files}


def bundled_scenes() -> dict[str, Path]:
    """Return the bundled scenes: name and file."""
    return {path.stem: path for path in sorted(_bundle().glob("*.yaml"))}


@cache
def _bundle() -> Path:
    """Return the folder of the bundled scenes; those in a zip file are unpacked for as long as the program runs."""
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
    """Return the scene in a file, the bundled scene of a name, or the one that a program's values declare.

    The files that the scene names must exist; `load_maps` reads them. Those that values name lie in the current folder.
    Raises SceneError with all problems, and then with those of its maps too, as far as they can be known; TypeError for
    what is no scene.
    """
    path, document = _document(scene)
    try:
        return load_document(document, path)
    except SceneError as error:
        told = {(problem.line, problem.column) for problem in error.problems}
        found = unusable(document, _folder(path))
        more = [problem for problem in found if (problem.line, problem.column) not in told]
        if not more or len(error.problems) > MOST_PROBLEMS:  # the last counts the rest
            raise
        raise SceneError([*error.problems, *more]) from error


def read_again(before: LoadedScene, scene: SceneLike | LoadedScene | None, /) -> LoadedScene:
    """Return another reading of a scene, or of the one that is to take its place; what has been read already stays.

    Raises what `read_scene` raises, and ValueError for a scene that there is no file to read again from.
    """
    if isinstance(scene, LoadedScene):
        return scene
    if scene is not None:
        return read_scene(scene)
    if before.path is None:
        raise ValueError("this prairie was made from a program's values: hand reload the scene that it is to become")
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
    """Return the scene that values declare, with `pictures` in place of the files of their names.

    `path` is the file that they stand in. Raises SceneError with all problems.
    """
    given, folder = pictures or {}, _folder(path)
    missing = _missing_files(document, folder, given)
    scene = validate(document, folder=folder, also=missing)
    files = {name: stamp for name in _names(document.root.data) if (stamp := stamp_of(folder / name))}
    return LoadedScene(scene, path, folder, document, files, given)


def stamp_of(path: Path, /) -> Stamp | None:
    """Return what changes when a file does; None where there is no file."""
    try:
        found = path.stat()
    except (OSError, ValueError):
        return None
    return (found.st_mtime_ns, found.st_size) if S_ISREG(found.st_mode) else None


def parse_scene(text: str, /, *, file: str = "<scene>") -> Scene:
    """Return the scene that a text declares; the files it names are not looked for. Raises SceneError."""
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
        near = get_close_matches(text, bundled, n=1)
        guess = f"; did you mean '{near[0]}'?" if near else ";"
        raise _no_file(f"no scene file '{text}'{guess} bundled: {', '.join(bundled)}")
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
            yield document.problem(where, f"no file '{name}' relative to the scene{_guess(folder / name)}")


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
    """Return the texts among values that could name a file beside the scene."""
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
    """Return what a path is, as `stat` tells it; 0 where there is nothing or where no file can be."""
    try:
        return path.stat().st_mode
    except (OSError, ValueError):
        return 0


def _irregular(mode: int) -> str:
    """Return what a sentence calls something of this mode that is no regular file."""
    return "a folder" if S_ISDIR(mode) else "a device, a pipe or a socket"


def _guess(path: Path) -> str:
    """Return what follows a missing file's name: the file beside it whose name is near."""
    try:
        names = [other.name for other in path.parent.iterdir()]
    except (OSError, ValueError):
        names = []
    near = get_close_matches(path.name, names, n=1, cutoff=0.8)
    return f", did you mean '{near[0]}'?" if near else ""


def must_be_read(thing: object, /) -> None:
    """Raise TypeError for what is no scene that has been read."""
    if isinstance(thing, str | Path):
        raise TypeError(f"Prairie takes a scene that has been read; load one by Prairie.load({str(thing)!r})")
    if not isinstance(thing, LoadedScene):
        raise TypeError(f"Prairie takes a scene that has been read, not {shortened(thing)}; use Prairie.load")
