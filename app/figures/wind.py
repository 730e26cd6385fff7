"""Winds from above: their masks over the patches, and the fields of messages that they send (figures 7 and 10)."""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from ...components.arrays import Floats
from ...components.wind import WindPrimitive
from ...engine.declared.way import Waypoint
from ...engine.scene import read_scene
from ...systems.overlay.masks import EDGE_WEIGHT
from ...systems.prairie import Prairie
from ...systems.wind.blast import Blast, Shape
from ...systems.wind.blow import Blowing
from ...systems.wind.breeze import Breeze
from ...systems.wind.gust import Gust
from ...systems.wind.whirlwind import Whirlwind
from .figure import Detail, PaperFigure
from .plot import FAINT, INDEX, INK, SERIES, seen_from_above, sheet

Span = tuple[float, float]

ACROSS = 8
"""Number of samples of a mask along a patch's side."""

FINE = 400
"""Number of samples of a mask along a map's side, for its outline."""


def windless() -> Prairie:
    """Return a flat prairie without wind, of the coarsest preset, since only winds are shown."""
    loaded = read_scene("plain")
    return Prairie(replace(loaded, scene=loaded.scene.model_copy(update={"wind": []})), preset="low", live=False)


def grid(x: Span, z: Span, spacing: float, /) -> Floats:
    """Return the centres of squares with this side [m], row by row, shape (n, 2)."""
    along = (np.arange(x[0], x[1] - 1e-6, spacing) + spacing / 2, np.arange(z[0], z[1] - 1e-6, spacing) + spacing / 2)
    return np.stack(np.meshgrid(*along), axis=-1).reshape(-1, 2).astype(np.float32)


def mask_of(wind: Blowing, place: Floats, /, *, time: float) -> Floats:
    """Return the weights of a wind's mask at ground positions (n, 2) of the world, shape (n,)."""
    return wind.primitive.mask(wind.pose.inside(place), time=time)


def patch_weights(wind: Blowing, middle: Floats, /, *, patch: float, time: float) -> Floats:
    """Return the mean weight of a mask over each patch, in [0, 1], shape (n,)."""
    inside = grid((-patch / 2, patch / 2), (-patch / 2, patch / 2), patch / ACROSS)
    place = (middle[:, None] + inside[None]).reshape(-1, 2)
    return np.asarray(mask_of(wind, place, time=time).reshape(len(middle), -1).mean(axis=1))


def draw_masks(detail: Detail, /) -> Figure:
    """Return figure 7: the masks of a gust and of a whirlwind over the patches, now and a little earlier."""
    gust = Gust(position=[-30.0, 6.0], direction=70.0, width=24.0, speed=6.0, hold=0.5, tail=1.2, soft=2.0)
    path = [Waypoint(at=0.0, position=[-14.0, 9.0]), Waypoint(at=4.0, position=[2.0, -2.0])]
    whirlwind = Whirlwind(radius=7.0, path=[*path, Waypoint(at=6.0, position=[12.0, -5.0])])
    figure = sheet(3.35, detail)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=[4, 3])
    prairie = windless()
    _over_patches(left, prairie, gust, (-30.0, 20.0), times=(3.4, 6.2), color=SERIES[1])
    _over_patches(right, prairie, whirlwind, (-20.0, 17.5), times=(0.6, 4.0), color=SERIES[3])
    prairie.release()
    left.set_title("a)  gust of wind")
    right.set(title="b)  whirlwind", ylabel="")
    return figure


def _over_patches(
    axes: Axes, prairie: Prairie, primitive: WindPrimitive, x: Span, *, times: tuple[float, float], color: str
) -> None:
    z, patch, handle = (-20.0, 20.0), prairie.site.ground.patch, prairie.add(primitive)
    before, now = ((time, prairie.winds.acting(time)[0]) for time in times)
    middle = grid(x, z, patch)
    weight = patch_weights(now[1], middle, patch=patch, time=now[0])
    corner = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]], np.float32) * np.float32(patch)
    squares = PolyCollection([*(middle[:, None] + corner[None])], edgecolor="#dfe2da", linewidth=0.5)
    squares.set(facecolor=[(color, 0.0 if share <= 0.0 else 0.14 + 0.5 * float(share)) for share in weight])
    axes.add_collection(squares)
    _outline(axes, before[1], x, z, time=before[0], color=color, earlier=True)
    _outline(axes, now[1], x, z, time=now[0], color=color)
    here, there = ((wind.pose.x, wind.pose.z) for _, wind in (before, now))
    axes.annotate("", there, here, arrowprops={"arrowstyle": "-|>", "color": INK, "linewidth": 1.2})
    axes.plot(*here, "o", color=INK, markersize=2.5)
    seen_from_above(axes, x, z)
    prairie.remove(handle)


def _outline(
    axes: Axes, wind: Blowing, x: Span, z: Span, *, time: float, color: str, earlier: bool = False, thin: float = 1.6
) -> None:
    step = (x[1] - x[0]) / FINE
    place = grid(x, z, step)
    weight = mask_of(wind, place, time=time).reshape(-1, FINE)
    at_x, at_z = place[:, 0].reshape(-1, FINE), place[:, 1].reshape(-1, FINE)
    line, width = ("dashed", 0.6 * thin) if earlier else ("solid", thin)
    axes.contour(at_x, at_z, weight, levels=[EDGE_WEIGHT], colors=[color], linewidths=width, linestyles=line)


def draw_fields(detail: Detail, /) -> Figure:
    """Return figure 10: the messages of each kind of wind, as arrows."""
    figure = sheet(5.0, detail)
    prairie = windless()
    outline = Shape(polygon=[[-3.4, 2.6], [-2.6, -2.0], [0.0, -3.8], [2.6, -2.0], [3.4, 2.6], [0.0, 1.6]])
    winds: list[tuple[WindPrimitive, float, float]] = [
        (Breeze(direction=70.0, strength=0.4, gustiness=0.8), 24.0, 7.0),
        (Gust(position=[-26.0, 0.0], direction=80.0, width=21.0, speed=8.0, hold=0.8, tail=2.2), 24.0, 4.4),
        (Whirlwind(radius=6.0), 9.0, 1.0),
        (Blast(outline=outline, yaw=20.0), 5.6, 1.0),
    ]
    panels = figure.subplots(2, 2)
    for letter, axes, (wind, half, time) in zip("abcd", panels.flat, winds, strict=True):
        _field(axes, prairie, wind, half=half, time=time)
        axes.set_title(f"{letter})  {wind.kind}")
    prairie.release()
    bar = figure.colorbar(ScalarMappable(Normalize(0.0, 1.0), INDEX), ax=panels, shrink=0.5, pad=0.02, aspect=28)
    bar.set_label("posture index")
    return figure


def _field(axes: Axes, prairie: Prairie, primitive: WindPrimitive, *, half: float, time: float) -> None:
    x, z = (-half, half), (-0.75 * half, 0.75 * half)
    spacing = half / 13.0
    handle = prairie.add(primitive)
    place = grid(x, z, spacing)
    message = prairie.wind_at(place, time)
    index = np.hypot(*message.T)
    wind = prairie.winds.acting(time)[0]
    prairie.remove(handle)
    if wind.extent is not None:
        _outline(axes, wind, x, z, time=time, color=FAINT, thin=0.9)
    felt = index > 0.02
    axes.quiver(
        *place[felt].T, *message[felt].T, index[felt], cmap=INDEX, norm=Normalize(0.0, 1.0), angles="xy",
        scale_units="xy", scale=0.6 / spacing, width=0.0042, headwidth=3.6, headlength=4.0, headaxislength=3.6,
        minlength=0.1, pivot="mid",
    )  # fmt: skip
    seen_from_above(axes, x, z)


FIGURES = (
    PaperFigure(
        7,
        "Masks over the patches",
        "The masks of a gust and of a whirlwind from above; a patch is the darker the more of it the mask holds.",
        "Each mask is asked all over the 2.5 m patches; winds send their messages only to receivers on patches that "
        "the mask meets. Dashed, where the mask was a moment ago.",
        draw_masks,
    ),
    PaperFigure(
        10,
        "Winds as vector fields",
        "What grass feels of a breeze, a gust, a whirlwind and a blast: arrows point along the bending direction, and "
        "their length and colour are the posture index.",
        "The messages that receivers on a grid would get at one instant, small oscillations included; the lines are "
        "the edges of the masks.",
        draw_fields,
    ),
)
