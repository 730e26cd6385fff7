"""A patch of grass in 3D and in 2.5D: blades, strips, and how strips are animated (figures 2, 3 and 4)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...engine.declared.grass import GrassKind
from ...engine.declared.light import Light
from ...engine.declared.quality import LodName, Quality
from ...systems.grow.bend import ribbon, spine
from ...systems.grow.record import Blades, Growth
from ...systems.light.color import display
from ...systems.light.daylight import daylight
from ...systems.light.materials import grain, pigment
from ...systems.prairie import Prairie
from ...systems.show.strips.grow import Strips, strips_of, targets_on
from ..studio.encode import Picture
from ..studio.studio import Studio
from ..studio.take import Take
from .figure import Detail, PaperFigure
from .plot import INK, SERIES, sheet
from .scenery import Viewpoint

SCENE = "plain"
WALKER = Viewpoint((0.0, 14.0), 1.3, 0.0, -9.0)
SEGMENTS = 8
"""Segments of a drawn ribbon."""

SOIL = "#2c2f1b"
"""Background colour of blades from above."""

CLOSE = 1
"""Index of the strip, or slice, that is shown."""

BENT = (np.array([0.30, -0.12]), np.array([0.75, 0.25]))
"""Messages of the first and the last edge in figure 3; the others are interpolated."""


@dataclass(frozen=True, slots=True, eq=False)
class Sample:
    """The growth of one kind, and its light."""

    kind: GrassKind
    light: Light
    quality: Quality
    growth: Growth

    @property
    def blades(self) -> Blades:
        """Blades of the first patch model."""
        return self.growth.models[0].blades

    @property
    def strips(self) -> Strips:
        """Finest strips of the first patch model."""
        return strips_of(self.growth.models[0])[0]

    @property
    def wide(self) -> float:
        """Width of the strips' texture [m]."""
        return self.quality.patch + 2.0 * self.strips.margin

    @property
    def rows(self) -> NDArray[np.intp]:
        """Rows of the blades on the shown strip."""
        return np.flatnonzero(self.strips.slice[0] == CLOSE)

    @property
    def targets(self) -> Floats:
        """Texture coordinates (u, v) of the blades' control points on the strips, shape (2, n, points, 2)."""
        return targets_on(self.strips, self.blades, self.growth.postures)


def sample(detail: Detail, /) -> Sample:
    """Return the growth of the figures' kind."""
    prairie = Prairie.load(SCENE, preset=detail.preset)
    site = prairie.site
    prairie.release()
    return Sample(next(iter(site.scene.grass.values())), site.scene.light, site.quality, site.growths[0])


def walkers_view(detail: Detail, lod: LodName, /) -> Picture:
    """Return a walker's view of the scene in one representation."""
    with Studio(Take(SCENE, detail.size, detail.preset, lod)) as studio:
        return studio.picture(WALKER.camera(studio))


def from_front(place: NDArray[np.floating], /) -> Doubles:
    """Project points (..., 3) along z, shape (..., 2)."""
    return np.asarray(place[..., (0, 1)], np.float64)


def from_above(place: NDArray[np.floating], /) -> Doubles:
    """Project points (..., 3) along y, shape (..., 2)."""
    return np.asarray(place[..., (0, 2)], np.float64)


def ribbons(one: Sample, rows: NDArray[np.intp], /, seen: Callable[[Floats], Doubles]) -> PolyCollection:
    """Return blades at rest, in the order of `rows`; `seen` projects points (..., 3) to (..., 2)."""
    edge = ribbon(one.blades, one.growth.postures, (0.0, 0.0), points=SEGMENTS + 1, taper=one.kind.taper)
    left, right = (seen(side[rows]) for side in edge)
    quads = np.stack([left[:, :-1], left[:, 1:], right[:, 1:], right[:, :-1]], axis=2)
    along = (np.arange(SEGMENTS) + 0.5) / SEGMENTS
    facing = one.blades.facing[rows].astype(np.float64)
    color = shade(one, along[None, :, None], np.cos(facing)[:, None, None], np.sin(facing)[:, None, None])
    return PolyCollection([*quads.reshape(-1, 4, 2)], facecolor=color.reshape(-1, 3), linewidth=0.0)


def shade(one: Sample, along: Doubles, normal_x: Doubles, normal_z: Doubles, /) -> Doubles:
    """Return display colours (..., 3) in full light, from the place along a blade and its face normal, all (..., 1)."""
    foot, tip, light = pigment(one.kind.root), pigment(one.kind.tip), daylight(one.light)
    cosine, sine = grain(one.kind, light)
    own = 1.0 + cosine * (normal_x**2 - normal_z**2) + sine * (2.0 * normal_x * normal_z)
    return display(((foot + (tip - foot) * along) * own) ** 2 * (light.sun + light.down))


def draw_blades(detail: Detail, /) -> Figure:
    """Return figure 2: a blade, a slice of a patch, a patch from above, and the walker's view."""
    one = sample(detail)
    patch = one.quality.patch
    figure = sheet(4.5, detail)
    parts = figure.subplot_mosaic(
        [["blade", "slice"], ["above", "view"]], width_ratios=[1, 1.9], height_ratios=[1, 1.5]
    )
    _blade(parts["blade"], one)
    for name in ("blade", "slice"):
        parts[name].set_anchor("S")
    tall = 1.08 * float(one.strips.height)
    inside = one.rows
    parts["slice"].add_collection(ribbons(one, inside[np.argsort(one.blades.root[inside, 1])], from_front))
    parts["slice"].set(
        title=f"b)  the {len(inside)} blades in a slice", xlim=(-0.3, patch + 0.3), ylim=(0.0, tall), aspect="equal",
        xlabel="x [m]", ylabel="height [m]",
    )  # fmt: skip
    parts["above"].add_collection(ribbons(one, np.argsort(one.blades.height), from_above))
    near, far = (patch / len(one.strips.plane) * (CLOSE + side) for side in (0, 1))
    parts["above"].axhspan(near, far, facecolor="none", edgecolor=SERIES[1], linewidth=1.2)
    _patch(parts["above"], patch, title=f"c)  {len(one.blades.height)} blades from above", ground=SOIL)
    _view(parts["view"], walkers_view(detail, "blades"), title="d)  3D blades, as a walker sees them")
    return figure


def _blade(axes: Axes, one: Sample) -> None:
    row = int(np.argmax(np.hypot(*one.blades.rest.T) * one.blades.height))
    count = one.quality.blade_rings[0].segments
    chain = spine(one.blades, one.growth.postures, (0.0, 0.0), points=count + 1)[row]
    along = np.hypot(*(chain[:, ::2] - chain[0, ::2]).T)
    axes.plot(along, chain[:, 1], color=SERIES[0], marker="o", markersize=3.0, linewidth=1.3)
    axes.set(
        title=f"a)  a blade, {count} segments", xlim=(-0.15, 0.45), ylim=(0.0, 1.15 * chain[:, 1].max()),
        aspect="equal", xlabel="along [m]", ylabel="height [m]",
    )  # fmt: skip


def _patch(axes: Axes, patch: float, *, title: str, ground: str = "none") -> None:
    axes.add_patch(Rectangle((0.0, 0.0), patch, patch, facecolor=ground, edgecolor=INK, linewidth=0.8, zorder=0.5))
    axes.set(
        title=title, xlim=(-0.3, patch + 0.3), ylim=(patch + 0.3, -0.3), aspect="equal", xlabel="x [m]", ylabel="z [m]"
    )


def _view(axes: Axes, picture: Picture, *, title: str) -> None:
    axes.imshow(picture, interpolation="antialiased")
    axes.set_title(title)
    axes.set_axis_off()


def draw_strips(detail: Detail, /) -> Figure:
    """Return figure 4: the texture of a strip, the layers of strips from above, and the walker's view."""
    one = sample(detail)
    strips, patch = one.strips, one.quality.patch
    figure = sheet(4.6, detail)
    parts = figure.subplot_mosaic(
        [["strip", "strip"], ["above", "view"]], width_ratios=[1, 1.9], height_ratios=[1.1, 1.0]
    )
    span = (-strips.margin, patch + strips.margin)
    parts["strip"].imshow(
        painted(one, strips.texels[0, CLOSE]), origin="lower", extent=(*span, 0.0, strips.height),
        interpolation="antialiased",
    )  # fmt: skip
    parts["strip"].set(title="a)  a semi-transparent strip", xlabel="x [m]", ylabel="height [m]")
    for axis, color in ((0, SERIES[2]), (1, SERIES[1])):
        ends = [[(at, span[0]), (at, span[1])] if axis else [(span[0], at), (span[1], at)] for at in strips.plane]
        lines = LineCollection(ends, color=color, linewidth=1.6, label=f"along {'xz'[axis]}")
        parts["above"].add_collection(lines)
    _patch(parts["above"], patch, title=f"b)  {len(strips.plane)} layers each way, from above")
    parts["above"].legend(loc="center left", bbox_to_anchor=(1.02, 0.5))
    _view(parts["view"], walkers_view(detail, "strips"), title="c)  2.5D strips, as a walker sees them")
    return figure


def painted(one: Sample, texels: NDArray[np.uint8], /) -> Doubles:
    """Return the colours and opacity of a strip's texels (h, w, 4), shape (h, w, 4)."""
    part = texels.astype(np.float64) / 255.0
    meaning = part[..., :3] / np.maximum(part[..., 3:], 1.0 / 255.0)
    across = 2.0 * meaning[..., 1:2] - 1.0
    color = shade(one, meaning[..., :1], np.zeros_like(across), across)
    return np.concatenate([color, part[..., 3:]], axis=2)


def edges(one: Sample, message: Floats, /, *, points: int) -> Floats:
    """Return points along a strip's vertical edges, bent by a message each (n, 2), shape (n, points, 3)."""
    count, strips = len(message), one.strips
    foot = np.linspace(-strips.margin, one.quality.patch + strips.margin, count)
    still = np.zeros((count, 2), np.float32)
    stems = Blades(
        root=np.stack([foot, np.full(count, strips.plane[CLOSE])], axis=1).astype(np.float32),
        height=np.full(count, strips.height, np.float32), width=still[:, 0], facing=still[:, 0], rest=still,
        variant=np.zeros(count, np.int32), rank=still[:, 0],
    )  # fmt: skip
    return spine(stems, one.growth.postures, message, points=points)


def on_strip(edge: Floats, at: Floats, /) -> Doubles:
    """Return the points of texture coordinates (..., 2) in [0, 1] on a strip with edges (n, k, 3), shape (..., 3).

    A quad is two triangles, parted from its second edge's foot to its first edge's head, as it is on screen.
    """
    columns, sections = edge.shape[0] - 1, edge.shape[1] - 1
    u, v = (
        np.clip(part, 0.0, 1.0) * count for part, count in zip(np.moveaxis(at, -1, 0), (columns, sections), strict=True)
    )
    i, j = np.minimum(u.astype(int), columns - 1), np.minimum(v.astype(int), sections - 1)
    right, up = (u - i)[..., None], (v - j)[..., None]
    foot, head = (edge[i, j], edge[i + 1, j]), (edge[i, j + 1], edge[i + 1, j + 1])
    low = foot[0] + (foot[1] - foot[0]) * right + (head[0] - foot[0]) * up
    high = head[1] + (head[0] - head[1]) * (1.0 - right) + (foot[1] - head[1]) * (1.0 - up)
    return np.asarray(np.where(right + up <= 1.0, low, high), np.float64)


def draw_edges(detail: Detail, /) -> Figure:
    """Return figure 3: a strip at rest, and one whose vertical edges are bent by their receivers' messages."""
    one = sample(detail)
    figure = sheet(4.1, detail)
    panels = figure.subplots(2, 1)
    count = one.quality.strip_rings[0].columns + 1
    bent = np.linspace(*BENT, count, dtype=np.float32)
    for axes, message, title in zip(panels, (0.0 * bent, bent), ("a)  at rest", "b)  in the wind"), strict=True):
        _strip(axes, one, message)
        axes.set_title(title)
        axes.set_axis_off()
    key = (
        Line2D([], [], color=SERIES[1], linewidth=2.2, marker="o", markersize=4.5, label="edge, and its receiver"),
        Line2D([], [], color=INK, linewidth=0.7, label="polygons"),
        Line2D([], [], color=INK, marker=">", markersize=4.5, label="message"),
        Line2D([], [], color=SERIES[0], linewidth=0.9, label="painted blades"),
    )
    figure.legend(handles=key, loc="outside lower center", ncols=len(key))
    return figure


def oblique(place: NDArray[np.floating], /, plane: float) -> Doubles:
    """Project points (..., 3) obliquely, from the side and a little from above, shape (..., 2)."""
    depth = place[..., 2] - plane
    return np.stack([place[..., 0] - 0.35 * depth, place[..., 1] - 0.45 * depth], axis=-1)


def _strip(axes: Axes, one: Sample, message: Floats) -> None:
    plane, sections = float(one.strips.plane[CLOSE]), one.quality.strip_rings[0].sections
    edge = edges(one, message, points=sections + 1)
    blades = oblique(on_strip(edge, one.targets[0, one.rows]), plane)
    axes.add_collection(LineCollection([*blades], color=(SERIES[0], 0.75), linewidth=0.9))
    mesh = oblique(edge, plane)
    axes.add_collection(LineCollection([*mesh], color=SERIES[1], linewidth=2.2))
    axes.add_collection(LineCollection([*mesh.transpose(1, 0, 2)], color=INK, linewidth=0.7))
    foot = mesh[:, 0]
    axes.plot(*foot.T, "o", color=SERIES[1], markersize=4.5)
    felt = np.zeros((len(message), 3))
    felt[:, ::2] = message
    for start, way in zip(foot, oblique(felt, 0.0), strict=True):
        if np.any(way):
            axes.annotate(
                "", start + 0.6 * way, start, arrowprops={"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0}
            )
    wide = one.quality.patch
    axes.set(xlim=(-0.25, wide + 0.75), ylim=(-0.18, 1.05 * one.strips.height), aspect="equal")


FIGURES = (
    PaperFigure(
        2,
        "3D: blades",
        "The finest representation: a blade is a chain of line segments, and a patch is some hundreds of them.",
        "One patch model of the bundled scene plain, drawn from the arrays that are sent to the graphics card; the "
        "band in the patch from above is the slice. The walker's view is rendered with blades alone.",
        draw_blades,
    ),
    PaperFigure(
        3,
        "2.5D: a strip that moves",
        "The vertical edges of a strip bend like blades, each by what its own receiver feels; what is painted on it "
        "moves along.",
        "A strip of the same patch, its edges at the places that the postures give; the thin lines are the blades that "
        "its texture shows, at their texture coordinates.",
        draw_edges,
    ),
    PaperFigure(
        4,
        "2.5D: strips",
        "The middle representation: blades painted on semi-transparent vertical strips, of which those are drawn that "
        "the viewer looks at more squarely.",
        "The same patch as in figure 2; the strip's texture is lit as it is on screen. The walker's view is rendered "
        "with strips alone.",
        draw_strips,
    ),
)
