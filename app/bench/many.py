"""Benchmarks of a scene, or of all scenes in a folder in one table; by this process, or by workers."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ..studio.encode import make_folder
from ..studio.errors import InputError
from ..studio.progress import counted
from ..studio.take import Take
from .machine import tell
from .sent import Job, Measure, Result, measured_on

COMMON = ("machine", "size", "frames")
"""Figures that JSON has once for all scenes in a folder."""


@dataclass(frozen=True, slots=True)
class Survey:
    """A benchmark that can run for many scenes."""

    measure: Measure

    doing: str
    """Description of the work, for a progress bar."""

    cells: Callable[[Result], dict[str, object]]
    """Returns a scene's cells of the table by column, without the scene and the preset."""

    kept: Sequence[str]
    """Figures of each scene that JSON has in addition to the table's."""

    job: Job | None = None
    """Benchmark that workers run, where it is not `measure`."""

    folders: bool = False
    """Whether each scene's pictures go into a folder of their own."""

    need: Callable[[], object] = lambda: None
    """Raises MachineError where this machine cannot run it."""


def bench_many(take: Take, survey: Survey, /, *, json: bool, on: str | None, output: str | None = None) -> None:
    """Run a benchmark for a take and print its figures, or for all scenes of a folder and print a table.

    Pictures go into the folder `output`. With `on`, workers measure. Before anything is drawn it raises MachineError
    where this machine cannot run it, and InputError where pictures cannot be written or the folder has no scenes.
    """
    survey.need()
    if output is not None:
        make_folder(Path(output))
    if not Path(take.scene).is_dir():
        (result,) = _measured(survey, [take], [output], on)
        tell(result, as_json=json)
        return
    paths = sorted(Path(take.scene).glob("*.yaml"))
    if not paths:
        raise InputError(f"{take.scene}: there is no scene in this folder")
    takes = [replace(take, scene=str(path)) for path in paths]
    outputs = [output and str(Path(output) / path.stem if survey.folders else Path(output)) for path in paths]
    rows: list[Result] = []
    for result in counted(_measured(survey, takes, outputs, on), total=len(takes), doing=survey.doing):
        rows.append(result)
        if not json:
            _print_row(row(survey, result), head=len(rows) == 1)
    if json:
        common = {name: rows[0][name] for name in COMMON}
        scene_rows = [{**row(survey, result), **{name: result[name] for name in survey.kept}} for result in rows]
        tell({**common, "rows": scene_rows}, as_json=True)


def _measured(survey: Survey, takes: list[Take], outputs: list[str | None], on: str | None) -> Iterator[Result]:
    """Yield the result of each scene, measured by this process, or by the workers of the place `on`."""
    if on is None:
        for take, output in zip(takes, outputs, strict=True):
            if output is not None:
                make_folder(Path(output))
            yield survey.measure(take, output)
        return
    yield from measured_on(on, survey.job or Job(survey.measure), takes, outputs)


def row(survey: Survey, result: Result, /) -> dict[str, object]:
    """Return a scene's cells of the table by column."""
    return {"camera": Path(result["scene"]).stem, "preset": result["preset"], **survey.cells(result)}


def _print_row(cells: dict[str, object], *, head: bool) -> None:
    if head:
        print("  ".join(f"{name:>12}" for name in cells))
    print("  ".join(f"{'-' if cell is None else str(cell):>12}" for cell in cells.values()), flush=True)
