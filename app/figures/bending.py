"""Bending of a blade: its postures, and its response over time to wind that starts and stops (figures 6 and 8)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.ticker import MultipleLocator

from ...components.arrays import Doubles, Floats
from ...components.wind import Grass
from ...engine.declared.grass import GrassKind
from ...engine.scene import read_scene
from ...systems.grow.bend import bending
from ...systems.grow.postures import grow_give, grow_postures
from ...systems.grow.record import Postures, Response
from ...systems.grow.response import grow_response
from ...systems.wind.gust import Gust
from .figure import Detail, PaperFigure
from .plot import FAINT, INDEX, INK, SERIES, sheet

SHOWN = (("meadow", "feather"), ("meadow", "fresh"), ("gust", "barley"))
"""Scenes, each with the name of a kind of grass to show."""

STIFFNESS = (0.2, 1.0, 8.0)
"""Stiffnesses of otherwise equal blades."""

POSTURES = 17
"""Number of postures shown of a kind."""


def kinds() -> dict[str, GrassKind]:
    """Return the kinds of grass that are shown, by name."""
    return {name: read_scene(scene).scene.grass[name] for scene, name in SHOWN}


def draw_postures(detail: Detail, /) -> Figure:
    """Return figure 6: blades of several kinds, and of several stiffnesses, in winds of indices from -1 to 1."""
    figure = sheet(4.0, detail)
    upper, lower = np.ravel(figure.subfigures(2, 1, squeeze=False))
    _fans(upper, {f"{name}, {_length(kind):.2f} m": kind for name, kind in kinds().items()})
    _fans(lower, {f"stiffness {each:g}": GrassKind(stiffness=each, height=[0.6, 0.6]) for each in STIFFNESS})
    lower.supxlabel("along the bending direction [m]", fontsize=8.5)
    return figure


def _fans(figure: SubFigure, shown: Mapping[str, GrassKind]) -> None:
    reach = [0.8 * _length(kind) + 0.22 for kind in shown.values()]
    tallest = max(map(_length, shown.values()))
    row = figure.subplots(1, len(shown), sharey=True, width_ratios=reach)
    for axes, far, (title, kind) in zip(row, reach, shown.items(), strict=True):
        _fan(axes, kind, replace(grow_postures(kind, variants=1), give=grow_give(kind)))
        axes.set(title=title, xlim=(-far, far), ylim=(0.0, 1.1 * tallest), aspect="equal")
        axes.xaxis.set_major_locator(MultipleLocator(0.4))
        axes.yaxis.set_major_locator(MultipleLocator(0.2))
    row[0].set_ylabel("height [m]")


def _length(kind: GrassKind) -> float:
    return 0.5 * (kind.height[0] + kind.height[1])


def _fan(axes: Axes, kind: GrassKind, postures: Postures) -> None:
    length = _length(kind)
    index = np.linspace(-1.0, 1.0, POSTURES)
    bent = bending(postures, np.stack([index, np.zeros(POSTURES)], axis=1))[:, 0]
    rows = np.round((0.5 + 0.5 * bent) * (len(postures.index) - 1)).astype(int)
    spines = postures.shape[0, rows].astype(np.float64) * length
    tips = postures.shape[0, :, -1] * length
    axes.plot(*tips.T, color=FAINT, linewidth=0.7, linestyle=(0, (1, 2)))
    blades = PolyCollection([_outline(spine, kind) for spine in spines], linewidth=0.5)
    blades.set(facecolor=INDEX(np.abs(index)), edgecolor=INDEX(np.abs(index)))
    axes.add_collection(blades)
    for number in range(0, POSTURES, (POSTURES - 1) // 4):
        x, y = spines[number, -1]
        if index[number] and abs(x) < 0.15 * length:
            continue  # upright still: there is no room for it beside the 0
        away = np.array([x, y]) / np.hypot(x, y) * 4.0
        text = f"{index[number]:+g}".replace("-", "\N{MINUS SIGN}") if index[number] else "0"
        side = "center" if abs(x) < 0.2 * length else "left" if x > 0.0 else "right"
        low = "bottom" if y > 0.3 * length else "center"
        axes.annotate(
            text, (x, y), away, textcoords="offset points", ha=side, va=low, fontsize=7.5, annotation_clip=False
        )


def _outline(spine: Doubles, kind: GrassKind) -> Doubles:
    """Return the outline of a ribbon around a spine (n, 2) [m], shape (2 n, 2)."""
    along = np.gradient(spine, axis=0)
    aside = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
    left = np.linspace(1.0, 0.0, len(spine)) ** kind.taper
    half = 0.5 * kind.width * left[:, None] * aside
    return np.concatenate([spine + half, (spine - half)[::-1]])


def draw_responses(detail: Detail, /) -> Figure:
    """Return figure 8: index over time as a constant wind starts and stops, and as the profile of a gust in space."""
    curves = {name: grow_response(kind) for name, kind in kinds().items()}
    figure = sheet(4.6, detail)
    parts = figure.subplot_mosaic([["start", "stop"], ["gust", "gust"]], height_ratios=[1.15, 1.0])
    parts["stop"].sharey(parts["start"])
    parts["stop"].tick_params(labelleft=False)
    _over_time(parts["start"], [(name, each, each.rise) for name, each in curves.items()], rest=1.0)
    _over_time(parts["stop"], [(name, each, each.fall) for name, each in curves.items()], rest=0.0)
    parts["start"].set(title="a)  a constant wind starts", ylabel="posture index / final index")
    parts["stop"].set(title="b)  it stops")
    parts["start"].legend(loc="lower right", title="farthest past its rest", alignment="left")
    parts["stop"].legend(loc="upper right", title="farthest past its rest", alignment="left")
    _in_space(parts["gust"], curves)
    return figure


def _over_time(axes: Axes, curves: Sequence[tuple[str, Response, Floats]], *, rest: float) -> None:
    axes.axhline(rest, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
    for color, (name, response, curve) in zip(SERIES, curves, strict=False):
        time = response.step * np.arange(len(curve))
        peak = extreme(response, curve, rest=rest)
        peak_text = f"{peak.index:.2f} at {peak.time:.2f} s".replace("-", "\N{MINUS SIGN}")
        axes.plot(time, curve, color=color, label=f"{name}: {peak_text}")
        axes.plot(peak.time, peak.index, "o", color=color, markersize=3.5)
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.set(xlabel="time [s]", xlim=(-0.3, max(each.step * len(curve) for _, each, curve in curves)))
    axes.grid(visible=True)


@dataclass(frozen=True, slots=True)
class Extreme:
    """The extreme overshoot of a response curve."""

    time: float
    """Time of the extreme [s]."""

    index: float
    """Index there, relative to the final index."""


def extreme(response: Response, curve: Floats, /, *, rest: float) -> Extreme:
    """Return the extreme of a response's curve: its highest point if it rises to 1, its lowest if it falls to 0."""
    row = int(np.argmax(curve) if rest else np.argmin(curve))
    return Extreme(response.step * row, float(curve[row]))


def gust_profile(response: Response, gust: Gust, behind: Floats, /) -> Floats:
    """Return the signed index along a gust's travel, at distances `behind` (n,) its front [m], shape (n,)."""
    grass = Grass(
        np.zeros(len(behind), np.intp), np.array([response.step], np.float32), response.rise[None], response.fall[None]
    )
    place = np.stack([np.zeros_like(behind), behind], axis=1)
    return -gust.action(place, time=0.0, seed=0, grass=grass)[:, 1]


def _in_space(axes: Axes, curves: dict[str, Response]) -> None:
    gust = Gust(speed=8.0, hold=1.0, tail=3.0, strength=0.7, ragged=0.0)
    depth = gust.speed * (gust.hold + gust.tail)
    behind = np.linspace(-2.0, depth + 1.0, 600, dtype=np.float32)
    for color, (name, response) in zip(SERIES, curves.items(), strict=False):
        axes.plot(behind, gust_profile(response, gust, behind), color=color, label=name)
    axes.axhline(0.0, color=FAINT, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.axvline(0.0, color=INK, linewidth=0.8)
    axes.set(
        title=f"c)  the same curves as the profile of a gust that travels to the right at {gust.speed:g} m/s",
        xlabel="distance behind its front [m]", ylabel="posture index", xlim=(depth + 1.0, -2.0),
    )  # fmt: skip
    axes.grid(visible=True)
    axes.legend(loc="upper left", ncols=3)


FIGURES = (
    PaperFigure(
        6,
        "Precomputed postures",
        "Blades of three kinds in winds of posture indices from \N{MINUS SIGN}1 over 0, upright, to 1, which lays "
        "grass of stiffness 1 flat; below, blades that differ in their stiffness alone.",
        "A simulated chain of springs is bent by a wind that slowly grows; each posture keeps the blade's length. "
        "The dotted line is the way of the tip till it lies flat.",
        draw_postures,
    ),
    PaperFigure(
        8,
        "Posture index over time",
        "How blades of three kinds answer a constant wind that starts and stops: they overshoot, swing, and come to "
        "rest, each in its own time.",
        "The simulation's own curves, of the wind's final index; below, a gust reads them as a profile in space.",
        draw_responses,
    ),
)
