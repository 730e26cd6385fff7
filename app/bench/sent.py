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
from ..farm.worker import in_drawing_thread, problems_as_lines
from ..studio.encode import make_folder
from ..studio.progress import unseen
from ..studio.take import Take

Result = dict[str, Any]
"""Figures of a benchmark, as its JSON has them."""

Measure = Callable[[Take, str | None], Result]
"""Measures a take; if a folder is given, writes the benchmark's pictures there."""


@dataclass(frozen=True, slots=True)
class Job:
    """A benchmark that workers run for each scene."""

    measure: Measure
    """A function of a module, or a `partial` of one: workers import it by name."""

    timed: bool = False
    """Whether it measures time: then no machine runs it for two scenes at once."""


@dataclass(frozen=True, slots=True, eq=False)
class Finding:
    """A worker's result for a scene."""

    result: Result
    """Figures of the benchmark."""

    pictures: Mapping[str, bytes]
    """Contents of its picture files by name; empty unless they were asked for."""


def measured_on(on: str, job: Job, takes: Sequence[Take], outputs: Sequence[str | None], /) -> Iterator[Result]:
    """Yield the result of each scene, in the order of `takes`, measured by workers.

    `on` is a place as `hired` takes it. `outputs` are the folders for each scene's pictures, None for no pictures.
    Raises what `hired` raises, and InputError where a scene names a file outside its folder.
    """
    parcels = [packed(take, read_scene(take.scene)) for take in takes]
    with hired(on, most=1 if job.timed else len(takes)) as hands:
        pieces = ((parcel, job, output is not None) for parcel, output in zip(parcels, outputs, strict=True))
        for take, output, finding in zip(takes, outputs, hands.in_order(measured_here, pieces), strict=True):
            if output is not None:
                make_folder(Path(output))
                for name, data in finding.pictures.items():
                    (Path(output) / name).write_bytes(data)
            yield {**finding.result, "scene": take.scene}


def measured_here(parcel: Parcel, job: Job, pictures: bool, /) -> Finding:  # noqa: FBT001 - Dask passes arguments by position
    """Run a benchmark for the scene of a parcel, in a Dask worker."""
    scratch = str(need_distributed().get_worker().local_directory)
    with _machine_lock() if job.timed else nullcontext():
        return in_drawing_thread(lambda: _measured(parcel, job.measure, scratch, pictures=pictures))


def _machine_lock() -> AbstractContextManager[Any]:
    """Return a lock that one worker of a machine holds at a time; a lost worker loses it."""
    lock: AbstractContextManager[Any] = need_distributed().Semaphore(max_leases=1, name=f"tallgrass on {node()}")
    return lock


def _measured(parcel: Parcel, measure: Measure, scratch: str, *, pictures: bool) -> Finding:
    with TemporaryDirectory(prefix="scene-", dir=scratch) as folder, problems_as_lines(), unseen():
        take = unpack(parcel, Path(folder))
        drawn = Path(folder) / "pictures"
        if not pictures:
            return Finding(measure(take, None), {})
        drawn.mkdir()
        result = measure(take, str(drawn))
        return Finding(result, {path.name: path.read_bytes() for path in sorted(drawn.iterdir())})
