"""Pictures of many scenes, compared by workers on this machine or on others."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from ...engine.scene import read_scene
from ..farm.hire import hired
from ..farm.parcel import Parcel, packed, unpack
from ..farm.worker import in_drawing_thread, told_in_lines
from ..studio.progress import unseen
from ..studio.take import Take
from .picture import measured


@dataclass(frozen=True, slots=True, eq=False)
class Compared:
    """What a worker found out about a scene's picture."""

    told: dict[str, Any]
    """The benchmark's figures."""

    beside: bytes | None
    """The picture beside its reference as a PNG file, where it was asked for."""


def measured_on(on: str, takes: Sequence[Take], /, *, output: str | None = None) -> Iterator[dict[str, Any]]:
    """Yield what the benchmark tells of each scene, in their order, as the workers of a place find it out.

    `on` is a place as `hired` takes it. Into the folder `output`, which is there, goes each picture beside its
    reference. Raises what `hired` raises, and InputError where a scene names a file outside its folder.
    """
    parcels = [packed(take, read_scene(take.scene)) for take in takes]
    with hired(on, most=len(takes)) as hands:
        done = hands.in_order(compared, ((parcel, output is not None) for parcel in parcels))
        for take, each in zip(takes, done, strict=True):
            if output is not None and each.beside is not None:
                (Path(output) / _picture_of(take)).write_bytes(each.beside)
            yield {**each.told, "scene": take.scene}


def compared(parcel: Parcel, beside: bool, /) -> Compared:  # noqa: FBT001 - Dask hands on what it is given in order
    """Compare the picture of a parcel's scene with its reference, in a worker of Dask's."""
    scratch = str(import_module("distributed").get_worker().local_directory)
    return in_drawing_thread(lambda: _compared(parcel, scratch, beside=beside))


def _compared(parcel: Parcel, scratch: str, *, beside: bool) -> Compared:
    with TemporaryDirectory(prefix="scene-", dir=scratch) as folder, told_in_lines(), unseen():
        take = unpack(parcel, Path(folder))
        told: dict[str, Any] = measured(take, folder if beside else None)
        return Compared(told, (Path(folder) / _picture_of(take)).read_bytes() if beside else None)


def _picture_of(take: Take) -> str:
    """Return the file that `measured` writes into a folder."""
    return f"{Path(take.scene).stem}.png"
