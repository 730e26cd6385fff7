"""The morph of blades to their painted places: blades, targets, and paths (figures 13, 14 and 15)."""

from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...systems.around.appearance import appearance
from ...systems.around.transitions import SEAMLESS
from ...systems.grow.bend import spine
from ...systems.grow.record import Blades
from ...systems.transition import FADE
from ...systems.wind.gust import Gust
from .figure import Detail, PaperFigure
from .patch import CLOSE, Sample, edges, oblique, on_strip, painted, ribbons, sample
from .plot import FAINT, INK, PAPER, SERIES, sheet
from .wind import windless

FOLLOWED = 3
"""Number of blades that are followed."""

STAGES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Morph values of the shown stages, 0 to 1."""

DASHES = (0.0, (4.0, 2.0))
"""Dash pattern of a strip's outline."""

FINE = 240
"""Number of instants of a path."""

BENT = (np.array([0.20, 0.05]), np.array([0.42, 0.36]))
"""Messages of the first and the last edge in figure 14."""

GUST = Gust(position=[-9.9, -3.6], direction=112.0, width=60.0, speed=9.0, hold=0.25, tail=0.8, strength=0.62)
"""Wind during the morph."""

BEGINS = 1.55
"""Instant at which the morph begins [s]."""


def followed(one: Sample, /) -> NDArray[np.intp]:
    """Return the rows of the blades with the longest paths in the middle of the slice, from left to right."""
    rows = one.rows
    rows = rows[np.argsort(one.blades.root[rows, 0])]
    away = np.abs(one.blades.root[:, 1] - one.strips.plane[CLOSE]) * (0.5 + one.blades.height)
    first = round(0.36 * len(rows))
    middle = rows[first : max(round(0.64 * len(rows)), first + FOLLOWED)]
    return np.array([part[np.argmax(away[part])] for part in np.array_split(middle, FOLLOWED)])


def draw_pair(detail: Detail, /) -> Figure:
    """Return figure 13: the blades of one slice, and the texture of the strip that shows the same blades."""
    one = sample(detail)
    figure = sheet(4.7, detail)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[1.25, 1.0])
    chosen = followed(one)
    _geometry(upper, one, chosen)
    _painted(lower, one, chosen)
    key = (
        Line2D([], [], color=SERIES[3], linewidth=1.5, label="the same blades in both"),
        Line2D([], [], color=INK, linewidth=0.9, linestyle=DASHES, label="the strip"),
        Line2D([], [], color=FAINT, linewidth=5.0, alpha=0.35, label="ground of the slice"),
    )
    figure.legend(handles=key, loc="outside lower center", ncols=len(key))
    return figure


def _geometry(axes: Axes, one: Sample, chosen: NDArray[np.intp]) -> None:
    rows, seen = one.rows, partial(oblique, plane=float(one.strips.plane[CLOSE]))
    _ground(axes, one)
    axes.add_collection(ribbons(one, rows[np.argsort(one.blades.root[rows, 1])], seen))
    points = one.targets.shape[2]
    own = spine(one.blades, one.growth.postures, (0.0, 0.0), points=points)[chosen]
    axes.add_collection(LineCollection([*seen(own)], color=SERIES[3], linewidth=1.5))
    axes.plot(*seen(own[:, 0]).T, "o", color=SERIES[3], markersize=3.0)
    axes.add_patch(_strip_outline(one))
    axes.set(title=f"a)  geometry: the {len(rows)} blades between two planes", aspect="equal")
    axes.set_axis_off()


def _painted(axes: Axes, one: Sample, chosen: NDArray[np.intp]) -> None:
    low, high, tall = -one.strips.margin, one.quality.patch + one.strips.margin, one.strips.height
    picture = painted(one, one.strips.texels[0, CLOSE])
    axes.imshow(picture, origin="lower", extent=(low, high, 0.0, tall), interpolation="nearest")
    at = one.targets[0, chosen] * np.array([high - low, tall]) + np.array([low, 0.0])
    axes.add_collection(LineCollection([*at], color=SERIES[3], linewidth=1.1))
    axes.add_patch(_strip_outline(one))
    axes.set(title="b)  texture: the same blades, painted on the strip", aspect="equal")
    axes.set(xlim=(low - 0.12, high + 0.12), ylim=(-0.01, 1.01 * tall))
    axes.set_axis_off()


def _strip_outline(one: Sample) -> Rectangle:
    return Rectangle(
        (-one.strips.margin, 0.0),
        one.wide,
        one.strips.height,
        fill=False,
        edgecolor=INK,
        linewidth=0.9,
        linestyle=DASHES,
        clip_on=False,
    )


def _ground(axes: Axes, one: Sample) -> None:
    """Draw the ground between the two planes of the slice."""
    patch, count, plane = one.quality.patch, len(one.strips.plane), float(one.strips.plane[CLOSE])
    near, far = patch / count * (CLOSE + 1), patch / count * CLOSE
    corner = np.array([[0.0, 0.0, near], [patch, 0.0, near], [patch, 0.0, far], [0.0, 0.0, far]])
    axes.add_collection(PolyCollection([oblique(corner, plane)], facecolor=(FAINT, 0.3), edgecolor=FAINT))
    low = float(oblique(corner, plane)[:, 1].min())
    axes.set_ylim(low - 0.03, 1.12 * one.strips.height)


def slender(one: Sample, /) -> int:
    """Return the row of a blade that shows its face, leans, and is painted apart from the others."""
    rows, at = one.rows, one.targets[0].astype(np.float64)
    place = at[rows] * np.array([one.wide, one.strips.height])
    lean = np.abs(place[:, -1, 0] - place[:, 0, 0])
    apart = np.abs(place[:, None, :, 0] - place[None, :, :, 0]).mean(axis=2) + 9.0 * np.eye(len(rows))
    face = np.abs(np.sin(one.blades.facing[rows].astype(np.float64)))
    return int(rows[np.argmax(np.minimum(lean, 0.25) + 2.0 * np.minimum(apart.min(axis=1), 0.08) + 0.3 * face)])


def draw_coordinates(detail: Detail, /) -> Figure:
    """Return figure 14: a painted blade with its control points, in texture coordinates and on the moving strip."""
    one = sample(detail)
    at = one.targets[0, slender(one)].astype(np.float64)
    figure = sheet(3.7, detail)
    parts = figure.subplot_mosaic([["whole", "close"], ["moved", "close"]], width_ratios=[2.15, 1.0])
    half = 0.5 * max(0.3, 1.3 * float(np.ptp(at[:, 0])) * one.wide) / one.wide
    middle = 0.5 * float(at[:, 0].min() + at[:, 0].max())
    box = (middle - half, middle + half)
    for name, strong in (("whole", 0.6), ("close", 1.0)):
        _texture(parts[name], one, strong)
        parts[name].set(xlabel="u", ylabel="v", aspect=one.strips.height / one.wide)
    parts["whole"].add_patch(Rectangle((box[0], 0.0), 2.0 * half, 1.0, fill=False, edgecolor=INK, linewidth=0.9))
    parts["whole"].plot(*at.T, color=SERIES[3], linewidth=1.2)
    parts["whole"].set_title("a)  a blade in the texture of its strip")
    _points(parts["close"], at, box)
    _moved(parts["moved"], one, at)
    return figure


def _texture(axes: Axes, one: Sample, strong: float) -> None:
    picture = painted(one, one.strips.texels[0, CLOSE])
    axes.imshow(picture, origin="lower", extent=(0.0, 1.0, 0.0, 1.0), interpolation="nearest", alpha=strong)


def _points(axes: Axes, at: Doubles, box: tuple[float, float]) -> None:
    axes.plot(*at.T, color=SERIES[3], marker="o", markersize=3.0, markerfacecolor=PAPER, linewidth=0.4, clip_on=False)
    for u, v in at[::2]:
        axes.annotate(
            f"({u:.3f}, {v:.3f})", (box[1], v), (6.0, 0.0), textcoords="offset points", va="center", fontsize=7.0,
            annotation_clip=False,
        )  # fmt: skip
        axes.plot((u, box[1]), (v, v), color=FAINT, linewidth=0.5, linestyle=(0, (1, 2)))
    axes.set(title="b)  its control points (u, v)", xlim=box, ylim=(0.0, 1.0))


def _moved(axes: Axes, one: Sample, at: Doubles) -> None:
    quality, plane = one.quality.strip_rings[0], float(one.strips.plane[CLOSE])
    message = np.linspace(*BENT, quality.columns + 1, dtype=np.float32)
    edge = edges(one, message, points=quality.sections + 1)
    line = np.linspace(0.0, 1.0, 49)
    steps = np.linspace(0.0, 1.0, 11)
    for across in (False, True):
        grid = np.stack(np.meshgrid(steps, line, indexing="ij")[:: -1 if across else 1], axis=-1)
        mesh = oblique(on_strip(edge, grid.astype(np.float32)), plane)
        axes.add_collection(LineCollection([*mesh], color=FAINT, linewidth=0.5))
    axes.add_collection(LineCollection([*oblique(edge, plane)], color=SERIES[1], linewidth=2.0))
    place = oblique(on_strip(edge, at.astype(np.float32)), plane)
    axes.plot(*place.T, color=SERIES[3], marker="o", markersize=2.6, linewidth=1.2)
    axes.set(title="c)  the same coordinates while the strip moves", aspect="equal")
    axes.autoscale_view()
    axes.set_axis_off()


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """Blades that morph from their own places to their painted places, while both move in the wind."""

    time: Floats
    """Instants [s], shape (t,)."""

    morph: Floats
    """Morph value at each instant, 0 to 1, shape (t,)."""

    edge: Floats
    """Points of the strip's edges, shape (t, columns + 1, sections + 1, 3) [m]."""

    own: Floats
    """Points along the blades in their own places, shape (t, blades, points, 3) [m]."""

    target: Doubles
    """Points along the blades in their painted places, in the same shape [m]."""

    @property
    def shown(self) -> Doubles:
        """Points along the blades as drawn, shape (t, blades, points, 3) [m]."""
        part = self.morph[:, None, None, None]
        return np.asarray(self.own * (1.0 - part) + self.target * part, np.float64)

    def stage(self, morph: float, /) -> int:
        """Return the instant of a morph value."""
        return int(np.searchsorted(self.morph, morph - 1e-6))


def morph_over_time() -> tuple[Floats, Floats]:
    """Return times since the start of a change [s], and morph values, up to the arrival of the blades."""
    part = np.linspace(0.0, 1.0, 4 * FINE, endpoint=False, dtype=np.float32)
    weight = np.stack([1.0 - part, part, 0.0 * part]).astype(np.float32)
    morph = appearance(weight, np.ones_like(part), transitions=SEAMLESS).morph
    last = int(np.argmax(morph >= morph.max()))
    chosen = np.round(np.linspace(0, last, FINE)).astype(int)
    return (part[chosen] * np.float32(FADE)).astype(np.float32), morph[chosen]


def way(one: Sample, rows: NDArray[np.intp], /, *, frozen: bool = False) -> Way:
    """Return the morph of blades in a gust; if `frozen`, in the wind of the first instant."""
    prairie = windless()
    prairie.add(GUST)
    ring, blades = one.quality.strip_rings[0], _only(one.blades, rows)
    foot = edges(one, np.zeros((ring.columns + 1, 2), np.float32), points=2)[:, 0, ::2]
    elapsed, morph = morph_over_time()
    edge, own = [], []
    for time in elapsed.tolist():
        now = BEGINS + (0.0 if frozen else time)
        edge.append(edges(one, prairie.wind_at(foot, now), points=ring.sections + 1))
        points = one.targets.shape[2]
        own.append(spine(blades, one.growth.postures, prairie.wind_at(blades.root, now), points=points))
    prairie.release()
    target = np.stack([on_strip(each, one.targets[0, rows]) for each in edge])
    return Way(elapsed, morph, np.stack(edge), np.stack(own), target)


def _only(blades: Blades, rows: NDArray[np.intp]) -> Blades:
    return Blades(
        root=blades.root[rows], height=blades.height[rows], width=blades.width[rows], facing=blades.facing[rows],
        rest=blades.rest[rows], variant=blades.variant[rows], rank=blades.rank[rows],
    )  # fmt: skip


def by_plane(path: Doubles, /) -> Doubles:
    """Return a path (t, 3) in the axes of its best-fitting plane and the plane's normal, shape (t, 3)."""
    centred = path - path.mean(axis=0)
    _, _, axes = np.linalg.svd(centred, full_matrices=False)
    return np.asarray(centred @ axes.T)


def draw_way(detail: Detail, /) -> Figure:
    """Return figure 15: blades at five stages of the morph, and the deviation of a tip's path from a plane."""
    one = sample(detail)
    rows = followed(one)
    moving, still = way(one, rows), way(one, rows, frozen=True)
    figure = sheet(4.9, detail)
    top, bottom = np.asarray(figure.subfigures(2, 1, height_ratios=[1.0, 2.1]), np.object_)
    for number, (axes, morph) in enumerate(zip(top.subplots(1, len(STAGES)), STAGES, strict=True)):
        _stage(axes, one, moving, morph)
        axes.set_title(f"a)  w = {morph:g}" if not number else f"w = {morph:g}")
    left, right = bottom.subplots(1, 2, width_ratios=[1.0, 1.15])
    _from_above(left, moving, still)
    _edge_on(right, moving)
    return figure


def _stage(axes: Axes, one: Sample, moving: Way, morph: float) -> None:
    at, plane = moving.stage(morph), float(one.strips.plane[CLOSE])
    seen = partial(oblique, plane=plane)
    edge = seen(moving.edge[at])
    outline = np.concatenate([edge[0], edge[1:, -1], edge[-1, ::-1], edge[-2::-1, 0]])
    axes.add_collection(PolyCollection([outline], facecolor=(SERIES[1], 0.10), linewidth=0.0))
    axes.add_collection(LineCollection([*edge], color=(SERIES[1], 0.8), linewidth=1.4))
    axes.add_collection(LineCollection([*edge.transpose(1, 0, 2)], color=(INK, 0.5), linewidth=0.5))
    for places, color in ((moving.own[at], SERIES[0]), (moving.target[at], SERIES[1])):
        axes.add_collection(LineCollection([*seen(places)], color=(color, 0.75), linewidth=0.8, linestyle=(0, (2, 1))))
    axes.add_collection(LineCollection([*seen(moving.shown[at])], color=SERIES[3], linewidth=1.8))
    for blade in range(moving.own.shape[1]):
        axes.plot(*seen(moving.shown[: at + 1, blade, -1]).T, color=(SERIES[3], 0.5), linewidth=0.7)
    everything = seen(np.concatenate([moving.own, moving.target]).reshape(-1, 3))
    (low_x, low_y), (high_x, high_y) = everything.min(axis=0) - 0.05, everything.max(axis=0) + 0.05
    axes.set(xlim=(low_x, high_x), ylim=(low_y, high_y), aspect="equal")
    axes.set_axis_off()


def _from_above(axes: Axes, moving: Way, still: Way) -> None:
    longest = 1
    for path, color, text in (
        (moving.own, SERIES[0], "in its own place"),
        (moving.target, SERIES[1], "in its painted place"),
        (moving.shown, SERIES[3], "on its way"),
    ):
        tip = path[:, longest, -1]
        axes.plot(tip[:, 0], tip[:, 2], color=color, linewidth=1.4, label=text)
    tip = still.shown[:, longest, -1]
    axes.plot(tip[:, 0], tip[:, 2], color=FAINT, linewidth=1.0, linestyle=(0, (4, 3)), label="if the wind stood still")
    stages = [moving.stage(morph) for morph in STAGES]
    tip = moving.shown[stages, longest, -1]
    axes.plot(tip[:, 0], tip[:, 2], "o", color=SERIES[3], markersize=3.0)
    axes.set(title="b)  a tip from above", xlabel="x [m]", ylabel="z [m]")
    axes.set_aspect("equal", adjustable="datalim")
    axes.invert_yaxis()
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.2), ncols=2)


def _edge_on(axes: Axes, moving: Way) -> None:
    for number, color in enumerate((SERIES[2], SERIES[3], INK)):
        along, _, across = 1000.0 * by_plane(moving.shown[:, number, -1]).T
        axes.plot(along, across, color=color, label=f"{np.abs(across).max():.0f} of {np.ptp(along):.0f} mm")
    axes.set(xlabel="along the plane [mm]", ylabel="across it [mm]")
    axes.set_title("c)  three tips, edge-on to their planes")
    axes.grid(visible=True)
    axes.legend(
        loc="upper center",
        bbox_to_anchor=(0.5, -0.2),
        ncols=FOLLOWED,
        title="farthest from its plane, of the length along it",
        columnspacing=1.6,
    )


FIGURES = (
    PaperFigure(
        13,
        "What is morphed into what",
        "The blades of one slice of a patch, and the texture of the strip that shows these same blades.",
        "One patch model of the bundled scene plain: every strip is the image of the blades between two planes, so "
        "that each blade has a painted place to go to.",
        draw_pair,
    ),
    PaperFigure(
        14,
        "Texture coordinates",
        "Where the control points of a painted blade lie on its strip: they are found once, and stay as they are "
        "however the strip bends.",
        "A blade of the same slice; every second of its points is labelled. Below, the strip in the wind with lines of "
        "equal u and v a tenth apart.",
        draw_coordinates,
    ),
    PaperFigure(
        15,
        "The way of a blade",
        "Three blades go from their own places to their painted places on a strip while a gust bends both; the ways of "
        "their tips do not lie in a plane.",
        "Each point is interpolated linearly between two places that move, as on the graphics card; dashed are the "
        "two places, and the dots in b) are the five stages of a).",
        draw_way,
    ),
)
