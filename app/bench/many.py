"""Benchmarks of a scene, or of all scenes in a folder in one table; by this process, or by workers."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..studio.encode import make_folder
from ..studio.errors import InputError
from ..studio.progress import counted
from ..studio.take import Take
from .machine import tell
from .sent import Asked, Measure, Told, measured_on

COMMON = ("machine", "size", "frames")
"""What is told once of all scenes in a folder."""


@dataclass(frozen=True, slots=True)
class Survey:
    """A benchmark that many scenes can be put to."""

    measure: Measure

    doing: str
    """What is being done, as a bar says it."""

    cells: Callable[[Told], dict[str, object]]
    """Returns a scene's line of the table by its columns, but for the scene and the preset."""

    kept: Sequence[str]
    """What of the figures goes into JSON besides."""

    asked: Asked | None = None
    """What workers are asked instead, where that is something else."""

    folders: bool = False
    """Whether the pictures of each scene in a folder have a folder of their own."""

    need: Callable[[], object] = lambda: None
    """Raises MachineError where it cannot be done on this machine."""


def bench_many(take: Take, survey: Survey, /, *, json: bool, output: str | None = None, on: str | None = None) -> None:
    """Put a take to a benchmark and print the figures, or of a folder all its scenes, and print a table.

    Into the folder `output` go its pictures. With `on`, workers do it. Before anything is drawn it raises MachineError
    where this machine cannot do it, and InputError where pictures cannot be written, or the folder has no scenes.
    """
    survey.need()
    if output is not None:
        make_folder(Path(output))
    if not Path(take.scene).is_dir():
        (told,) = _measured(survey, [take], [output], on)
        tell(told, as_json=json)
        return
    paths = sorted(Path(take.scene).glob("*.yaml"))
    if not paths:
        raise InputError(f"{take.scene}: there is no scene in this folder")
    takes = [replace(take, scene=str(path)) for path in paths]
    outputs = [output and str(Path(output) / path.stem if survey.folders else Path(output)) for path in paths]
    rows: list[Told] = []
    for told in counted(_measured(survey, takes, outputs, on), total=len(takes), doing=survey.doing):
        rows.append(told)
        if not json:
            _print_row(row(survey, told), head=len(rows) == 1)
    if json:
        common = {name: rows[0][name] for name in COMMON}
        kept = [{**row(survey, told), **{name: told[name] for name in survey.kept}} for told in rows]
        tell({**common, "rows": kept}, as_json=True)


def _measured(survey: Survey, takes: list[Take], outputs: list[str | None], on: str | None) -> Iterator[Told]:
    """Yield what the benchmark tells of each scene: as this process finds it out, or the workers of a place."""
    if on is None:
        for take, output in zip(takes, outputs, strict=True):
            if output is not None:
                make_folder(Path(output))
            yield survey.measure(take, output)
        return
    yield from measured_on(on, survey.asked or Asked(survey.measure), takes, outputs)


def row(survey: Survey, told: Told, /) -> dict[str, object]:
    """Return a scene's line of the table by its columns."""
    return {"camera": Path(told["scene"]).stem, "preset": told["preset"], **survey.cells(told)}


def _print_row(cells: dict[str, object], *, head: bool) -> None:
    if head:
        print("  ".join(f"{name:>12}" for name in cells))
    print("  ".join(f"{'-' if cell is None else str(cell):>12}" for cell in cells.values()), flush=True)
