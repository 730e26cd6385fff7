"""Benchmarks of many scenes, done by workers on this machine or on others."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from platform import node
from tempfile import TemporaryDirectory
from typing import Any

from ...engine.scene import read_scene
from ..farm.dask import need_distributed
from ..farm.hire import hired
from ..farm.parcel import Parcel, packed, unpack
from ..farm.worker import in_drawing_thread, told_in_lines
from ..studio.encode import make_folder
from ..studio.progress import unseen
from ..studio.take import Take

Told = dict[str, Any]

Measure = Callable[[Take, str | None], Told]
"""Returns what a benchmark tells of a take; where a folder is given, its pictures go there."""


@dataclass(frozen=True, slots=True)
class Asked:
    """What workers are asked for each scene."""

    measure: Measure
    """It is a function of a module, or a part of one: by its name workers find it."""

    timed: bool = False
    """Whether it tells of time: then no machine does it for two scenes at once."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What a worker found out about a scene."""

    told: dict[str, Any]
    """The benchmark's figures."""

    pictures: Mapping[str, bytes]
    """Its pictures as files, by their names, where they were asked for."""


def measured_on(
    on: str, asked: Asked, takes: Sequence[Take], outputs: Sequence[str | None], /
) -> Iterator[dict[str, Any]]:
    """Yield what a benchmark tells of each scene, in their order, as the workers of a place find it out.

    `on` is a place as `hired` takes it. Into the folders `outputs`, one for each scene, go its pictures; None is
    nowhere. Raises what `hired` raises, and InputError where a scene names a file outside its folder.
    """
    parcels = [packed(take, read_scene(take.scene)) for take in takes]
    with hired(on, most=1 if asked.timed else len(takes)) as hands:
        pieces = ((parcel, asked, output is not None) for parcel, output in zip(parcels, outputs, strict=True))
        for take, output, each in zip(takes, outputs, hands.in_order(found, pieces), strict=True):
            if output is not None:
                make_folder(Path(output))
                for name, data in each.pictures.items():
                    (Path(output) / name).write_bytes(data)
            yield {**each.told, "scene": take.scene}


def found(parcel: Parcel, asked: Asked, pictures: bool, /) -> Found:  # noqa: FBT001 - Dask hands on what it is given in order
    """Do a benchmark for the scene of a parcel, in a worker of Dask's."""
    scratch = str(need_distributed().get_worker().local_directory)
    with _alone() if asked.timed else nullcontext():
        return in_drawing_thread(lambda: _found(parcel, asked.measure, scratch, pictures=pictures))


def _alone() -> AbstractContextManager[Any]:
    """Return what no two workers of a machine are in at a time; of one that is lost, it is taken away."""
    turn: AbstractContextManager[Any] = need_distributed().Semaphore(max_leases=1, name=f"tallgrass on {node()}")
    return turn


def _found(parcel: Parcel, measure: Measure, scratch: str, *, pictures: bool) -> Found:
    with TemporaryDirectory(prefix="scene-", dir=scratch) as folder, told_in_lines(), unseen():
        take = unpack(parcel, Path(folder))
        drawn = Path(folder) / "pictures"
        if not pictures:
            return Found(measure(take, None), {})
        drawn.mkdir()
        told = measure(take, str(drawn))
        return Found(told, {path.name: path.read_bytes() for path in sorted(drawn.iterdir())})
