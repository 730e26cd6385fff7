"""`tallgrass bench picture FOLDER`: how true the pictures of many scenes are, in one table."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ..studio.errors import InputError
from ..studio.progress import counted
from ..studio.take import Take
from .machine import tell
from .picture import measured

COLUMNS = ("camera", "preset", "luminance", "hue", "contrast", "flip", "flip_msaa", "score", "score_msaa")


def bench_cameras(
    folder: str, *, preset: str | None, size: tuple[int, int], json: bool, output: str | None, on: str | None = None
) -> int:
    """Compare the picture of every scene in a folder with its reference, print a table, and return the exit status.

    With `on`, workers do it. Raises InputError where the folder has no scenes.
    """
    paths = sorted(Path(folder).glob("*.yaml"))
    if not paths:
        raise InputError(f"{folder}: there is no scene in this folder")
    told: list[dict[str, Any]] = []
    takes = [Take(str(path), size, preset=preset) for path in paths]
    for each in counted(measured_by(on, takes, output), total=len(takes), doing="drawing every blade"):
        told.append(each)
        if not json:
            _print_row(told[-1], head=len(told) == 1)
    if json:
        common = {name: told[0][name] for name in ("machine", "size", "frames")}
        tell({**common, "rows": [{**row(each), "bands": each["bands"]} for each in told]}, as_json=True)
    return 0


def measured_by(on: str | None, takes: list[Take], output: str | None, /) -> Iterator[dict[str, Any]]:
    """Yield what the benchmark tells of each scene: as this process finds it out, or the workers of a place."""
    if on is None:
        yield from (measured(take, output) for take in takes)
        return
    from .sent import measured_on

    yield from measured_on(on, takes, output=output)


def row(told: dict[str, Any], /) -> dict[str, object]:
    """Return a scene's row of the table: of its bands the luminance ratio and hue that are farthest off."""
    bands = told["bands"]
    ratios = [band["luminance_ratio"] for band in bands]
    return {
        "camera": Path(told["scene"]).stem,
        "preset": told["preset"],
        "luminance": max(ratios, key=lambda ratio: abs(ratio - 1.0), default=None),
        "hue": max((band["hue_degrees"] for band in bands), default=None),
        "contrast": told["contrast"],
        "flip": told["flip"]["lod"],
        "flip_msaa": told["flip"]["msaa"],
        "score": told["score"],
        "score_msaa": told["score_msaa"],
    }


def _print_row(told: dict[str, Any], *, head: bool) -> None:
    if head:
        print("  ".join(f"{name:>12}" for name in COLUMNS))
    cells = ("-" if cell is None else cell for cell in row(told).values())
    print("  ".join(f"{cell:>12}" for cell in cells), flush=True)
