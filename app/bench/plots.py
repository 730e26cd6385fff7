"""The plots of `bench all`: one measurement, or two side by side."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ..figures.figure import Detail
from ..figures.plot import FAINT, SERIES, sheet
from .sent import Result

Row = tuple[str, Sequence[float | None]]
"""Name of a quantity, and its value in each measurement, None if missing."""

BAR = 0.36
"""Thickness of a bar, as a fraction of a row's height."""


@dataclass(frozen=True, slots=True)
class Plot:
    """A plot of the page."""

    title: str

    shows: str
    """Caption of one or two sentences."""

    part: str
    """Name of its benchmark."""

    draw: Callable[[Sequence[Result]], Figure]
    """Draws that benchmark's results, the current one last."""


def color(number: int, times: int, /) -> str:
    """Return the colour of a measurement; the last one is the current one."""
    return SERIES[0] if number == times - 1 else FAINT


def bars(axes: Axes, rows: Sequence[Row], /, *, unit: str) -> None:
    """Draw a bar for each value of each row, from the top down, with its number."""
    times = len(rows[0][1]) if rows else 0
    for number in range(times):
        at = np.arange(len(rows)) + (number - (times - 1) / 2.0) * BAR
        values = [row[1][number] for row in rows]
        axes.barh(at, [value or 0.0 for value in values], 0.9 * BAR, color=color(number, times))
        for place, value in zip(at, values, strict=True):
            text = "none" if value is None else f"{value:.3g}"
            axes.annotate(text, (value or 0.0, place), (3, 0), textcoords="offset points", va="center", size=7.0)
    axes.set_yticks(np.arange(len(rows)), [row[0] for row in rows])
    axes.set(ylim=(len(rows) - 0.4, -0.6), xlabel=unit)
    axes.margins(x=0.18)
    axes.grid(visible=True, axis="x")


def _frame(results: Sequence[Result]) -> Figure:
    figure = sheet(2.6, Detail())
    left, right = figure.subplots(1, 2, width_ratios=(3, 2))
    percentiles = [(f"frame {part}", [each["frame_ms"][part] for each in results]) for part in ("p50", "p95", "p99")]
    kinds = (("CPU", "cpu_ms"), ("GPU", "gpu_ms"))
    alone = [(what, [each[key] and each[key]["p50"] for each in results]) for what, key in kinds]
    bars(left, [*percentiles, *alone, ("sky and ground", [each["floor_ms"] for each in results])], unit="ms")
    against = [("all in view", "ratio_to_seen_3d"), ("all there are", "ratio_to_all_3d")]
    bars(right, [(what, [each[key] for each in results]) for what, key in against], unit="every blade in 3D, in frames")
    return figure


def _systems(results: Sequence[Result]) -> Figure:
    found = [each["cpu_by_system_ms"] or each["systems_ms"] for each in results]
    names = list(dict.fromkeys(name for each in reversed(found) for name in each))
    figure = sheet(0.6 + 0.3 * len(names), Detail())
    bars(figure.subplots(), [(name, [each.get(name) for each in found]) for name in names], unit="ms, on the CPU")
    return figure


def _walk(results: Sequence[Result]) -> Figure:
    figure = sheet(2.2, Detail())
    left, right = figure.subplots(1, 2)
    parts = ("p50", "p95", "p99", "max")
    bars(left, [(part, [each["frame_ms"][part] for each in results]) for part in parts], unit="ms")
    bars(right, [(part, [each["rss_mb"][part] for each in results]) for part in ("start", "end")], unit="memory [MB]")
    return figure


def _scale(results: Sequence[Result]) -> Figure:
    figure = sheet(2.4, Detail())
    keys = (("frame_ms", "a frame [ms]"), ("first_frame_ms", "the first frame [ms]"), ("rss_mb", "memory [MB]"))
    for axes, (key, unit) in zip(figure.subplots(1, 3), keys, strict=True):
        for number, each in enumerate(results):
            sides, values = zip(*((row["terrain_m"], row[key] or np.nan) for row in each["rows"]), strict=True)
            axes.plot(sides, values, "o-", color=color(number, len(results)), markersize=4.0)
        axes.set(xscale="log", xlabel="side of the terrain [m]", ylabel=unit, ylim=(0.0, None))
        axes.grid(visible=True)
    return figure


def _picture(results: Sequence[Result]) -> Figure:
    figure = sheet(2.6, Detail())
    left, right = figure.subplots(1, 2)
    names = {"lod": "ours", "msaa": "every blade, smooth", "all_3d": "every blade, hard", "other_seed": "other grass"}
    bars(left, [(name, [each["flip"][key] for each in results]) for key, name in names.items()], unit="FLIP")
    for number, each in enumerate(results):
        middle = [sum(band["distance"]) / 2.0 for band in each["bands"]]
        ratio = [band["luminance_ratio"] for band in each["bands"]]
        right.plot(middle, ratio, "o-", color=color(number, len(results)), markersize=4.0)
    right.axhline(1.0, color=FAINT, linewidth=0.7)
    right.set(xlabel="distance [patches]", ylabel="brightness over the reference's")
    right.grid(visible=True)
    return figure


def _pop(results: Sequence[Result]) -> Figure:
    figure = sheet(2.6, Detail())
    left, right = figure.subplots(1, 2, width_ratios=(2, 3))
    keys = (("flicker", "ratio"), ("drift", "mean"), ("ghosting", "max"))
    rows = [(key, [each[key][part] / each["limits"][key] for each in results]) for key, part in keys]
    bars(left, rows, unit="relative to the limit")
    left.axvline(1.0, color=SERIES[1], linewidth=1.0)
    found = [{row["change"]: row["mean_drift"] for row in each["changes"]} for each in results]
    names = list(dict.fromkeys(name for each in reversed(found) for name in each))
    bars(right, [(name, [each.get(name) for each in found]) for name in names], unit="mean drift")
    return figure


PLOTS = (
    Plot("A frame", "Frame time, and what every blade in 3D takes, in such frames.", "frame", _frame),
    Plot("Systems", "Median time of each system in that frame, on the CPU.", "frame", _systems),
    Plot("A walk", "Frame times of a walk in gusts, and the memory at its beginning and end.", "walk", _walk),
    Plot("Larger terrains", "The same scene on larger and larger ground.", "scale", _scale),
    Plot("A picture", "FLIP against the reference (less is truer), and brightness by distance.", "picture", _picture),
    Plot("Changes of representation", "Relative to their limits: above 1 they can be seen.", "pop", _pop),
)
