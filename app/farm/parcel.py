"""A parcel: a take with all its files, for workers that have none of them."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from hashlib import sha256
from pathlib import Path, PurePath

from ...engine.scene import LoadedScene, read_scene
from ..studio.errors import InputError
from ..studio.take import Take


@dataclass(frozen=True, slots=True, eq=False)
class Parcel:
    """A take with the bytes of its scene and of all files that the scene names."""

    take: Take
    """The take; its scene is a name in `files`."""

    files: Mapping[str, bytes]
    """Contents of files by name, relative to the scene's folder."""

    mark: str
    """Hash of the take and its files."""


def packed(take: Take, loaded: LoadedScene, /) -> Parcel:
    """Return the parcel of a take whose scene has been read; raises InputError for a file outside its folder."""
    for name in loaded.files:
        if not _is_inside(loaded.folder, name):
            raise InputError(f"--on: {take.scene}: '{name}' lies outside the scene's folder: workers get no such file")
    files = {name: path.read_bytes() for name, path in loaded.paths.items()}
    sent = replace(take, scene=loaded.file.name)
    mark = sha256(repr((sent, [(name, sha256(data).digest()) for name, data in sorted(files.items())])).encode())
    return Parcel(sent, files, mark.hexdigest())


def unpack(parcel: Parcel, folder: Path, /) -> Take:
    """Write a parcel's files into a folder, and return the take of the scene in that folder.

    Raises InputError where the scene names a file that was not sent, though this machine has one of that name.
    """
    for name, data in parcel.files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    take = replace(parcel.take, scene=str(folder / parcel.take.scene))
    for name in read_scene(take.scene).files:
        if name not in parcel.files:
            raise InputError(f"--on: {parcel.take.scene}: '{name}' was not sent to the worker")
    return take


def _is_inside(folder: Path, name: str) -> bool:
    plain = not PurePath(name).is_absolute() and ".." not in PurePath(name).parts
    return plain and (folder / name).resolve().is_relative_to(folder.resolve())
