"""The common style of all figures, their layout, and saving."""

from collections.abc import Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import Colormap, LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ... import __version__
from ..studio.encode import Picture
from .figure import Detail

WIDTH = 7.2
"""Width of every figure [inches], so that letters have one size in all."""

INK, FAINT, PAPER = "#26301f", "#8a9182", "#fdfdfb"

SERIES = ("#2f7d4f", "#c8811a", "#3a6ea8", "#a3477f")
"""Colours of curves, distinct for colour-blind readers too."""

LOOK = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "text.color": INK,
    "axes.edgecolor": FAINT,
    "axes.labelcolor": INK,
    "axes.titlesize": 9.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.7,
    "axes.facecolor": PAPER,
    "axes.axisbelow": True,
    "grid.color": "#dfe2da",
    "grid.linewidth": 0.6,
    "xtick.color": FAINT,
    "ytick.color": FAINT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8.0,
    "ytick.labelsize": 8.0,
    "legend.frameon": False,
    "legend.fontsize": 8.0,
    "figure.facecolor": PAPER,
    "savefig.facecolor": PAPER,
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
}

INDEX: Colormap = LinearSegmentedColormap.from_list("index", ["#a9c46c", "#3f9c6b", "#1f5f86", "#3c2a6b"])
"""Colours of posture indices from 0 to 1, dark enough to be read as thin lines."""


def look() -> AbstractContextManager[None]:
    """Return the style context of figures, independent of the user's settings of Matplotlib."""
    return style.context(["default", LOOK])


def sheet(height: float, detail: Detail, /) -> Figure:
    """Return an empty figure of this height [inches] for plots, with automatic layout."""
    figure = Figure(figsize=(WIDTH, height), dpi=detail.dots / WIDTH, layout="constrained")
    FigureCanvasAgg(figure)
    engine = figure.get_layout_engine()
    assert isinstance(engine, ConstrainedLayoutEngine)
    engine.set(w_pad=0.06, h_pad=0.06, wspace=0.03)
    return figure


def seen_from_above(axes: Axes, /, x: tuple[float, float], z: tuple[float, float]) -> None:
    """Make axes a map of the ground [m]: x to the right, -z up."""
    axes.set(xlim=x, ylim=(z[1], z[0]), aspect="equal", xlabel="x [m]", ylabel="z [m]")


@dataclass(frozen=True, slots=True, eq=False)
class Panel:
    """A rendered picture with a line of text under it."""

    picture: Picture
    text: str


def plate(rows: Sequence[Sequence[Panel]], /) -> Figure:
    """Return a figure of rendered pictures, pixel for pixel, all of one size, in rows."""
    high, wide = rows[0][0].picture.shape[:2]
    columns = max(len(row) for row in rows)
    gap = max(round(0.012 * wide * columns), 2)
    width = columns * wide + (columns + 1) * gap
    dots = width / WIDTH
    line = round(0.24 * dots)
    height = len(rows) * (high + line + gap) + gap // 2
    figure = Figure(figsize=(WIDTH, height / dots), dpi=dots)
    FigureCanvasAgg(figure)
    for down, row in enumerate(rows):
        bottom = height - (down + 1) * (gap + high) - down * line
        for along, panel in enumerate(row):
            left = gap + along * (wide + gap)
            figure.figimage(panel.picture, left, bottom)
            figure.text(left / width, (bottom - 0.55 * line) / height, panel.text, ha="left", va="center")
    return figure


def put_on_paper(figure: Figure, path: Path, /, *, title: str) -> None:
    """Write a figure as PNG, reproducibly."""
    about = {"Software": f"tallgrass {__version__}, Matplotlib {mpl.__version__}", "Title": title}
    figure.savefig(path, format="png", dpi="figure", metadata=about)
