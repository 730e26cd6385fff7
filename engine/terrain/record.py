"""Records of terrain and density: arrays over the ground."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Mask
from .blocks import REACH, Blocks
from .crowns import Crowns
from .plots import Plots
from .rectangle import Log, Rectangle

BEYOND = 600.0
"""Distance of level ground beyond the terrain's edge [m]: its end is two pixels below a walker's horizon."""

MIRRORED = 4000.0
"""Distance of mirrored ground beyond the edge [m]: the usual haze hides 90 % at its end, and the rest fades out."""

GLSL = {"GOES_ON": MIRRORED}


@dataclass(slots=True, eq=False)
class Changes(Log):
    """Log of a game's changes of a terrain's heights.

    On a ground that streams, parts may lie outside of the present window.
    """

    moves: int = 0
    """Number of times that the terrain became another window; all numbers of samples have shifted each time."""

    leaps: int = 0
    """Number of moves that the prairie had to wait for."""

    loaded: dict[tuple[int, int], tuple[Floats, Mask]] = field(default_factory=dict)
    """Heights and holes as loaded of each square of samples that was changed since, by row and column."""

    def move(self, down: int, right: int, /, *, leaps: bool) -> None:
        """Log a move: the first sample now lies so many samples farther down and to the right."""
        self.moves += 1
        self.leaps += leaps
        moved = [part.moved(-down, -right) for part in self.last]
        self.last.clear()
        self.last.extend(moved)


@dataclass(slots=True, eq=False)
class Terrain:
    """An elevation map whose samples stand at cell corners; between them heights are bilinear.

    It has at least 2 by 2 samples and is centred on the origin, unless it is the window of a ground without an edge. It
    belongs to one prairie: a game's changes are written into the array (module `change`), and caches made from heights
    compare `changes`.
    """

    heights: NDArray[np.float32]
    """Heights [m], row 0 at the far edge (-z), shape (rows, columns)."""

    cell: float
    """Metres per cell."""

    holes: Mask | None = None
    """Samples at which there is no ground, shape (rows, columns); None where there never was a hole."""

    first: tuple[int, int] | None = None
    """Row and column of the first sample, counted from the origin; None where the terrain is centred there."""

    blocks: Blocks | None = None
    """The streaming ground of which the terrain is the window, if it is one."""

    mirrored: bool = False
    """Whether it goes on beyond its edge as a mirror image of itself; else as high as its nearest edge."""

    changes: Changes = field(init=False, default_factory=Changes)

    derived: object = field(init=False, default=None)
    """Result computed from the heights of this window in advance, kept for as long as this is the same window."""

    row_ends: Floats = field(init=False)
    """Lowest and highest height of each row [m], shape (2, rows)."""

    def __post_init__(self) -> None:
        """Compute the range of each row."""
        self.row_ends = np.stack([self.heights.min(axis=1), self.heights.max(axis=1)])

    @property
    def span(self) -> tuple[float, float]:
        """Lowest and highest height [m]."""
        return float(self.row_ends[0].min()), float(self.row_ends[1].max())

    @property
    def size(self) -> tuple[float, float]:
        """Width (x) and depth (z) [m]."""
        rows, columns = self.heights.shape
        return (columns - 1) * self.cell, (rows - 1) * self.cell

    @property
    def origin(self) -> tuple[float, float]:
        """Ground position (x, z) of sample [0, 0] [m]."""
        if self.first is not None:
            return self.first[1] * self.cell, self.first[0] * self.cell
        width, depth = self.size
        return -width / 2, -depth / 2

    @property
    def whole(self) -> tuple[float, float]:
        """Width (x) and depth (z) of all ground, beyond the window too, centred on the origin [m]."""
        return self.size if self.blocks is None else (2.0 * REACH, 2.0 * REACH)

    @property
    def beyond(self) -> float:
        """Distance to which ground is drawn beyond the edge [m]."""
        return MIRRORED if self.mirrored else BEYOND

    def become(self, other: "Terrain", /, *, leaps: bool) -> None:
        """Become another window of the same ground; `leaps` says that the prairie had to wait for it."""
        assert self.first is not None
        assert other.first is not None
        down, right = (after - before for after, before in zip(other.first, self.first, strict=True))
        self.heights, self.holes, self.first = other.heights, other.holes, other.first
        self.derived, self.row_ends = other.derived, other.row_ends
        self.changes.move(down, right, leaps=leaps)

    def holes_in(self, part: Rectangle, /) -> Mask:
        """Return the mask of holes in a part, shape (rows, columns)."""
        return np.zeros((part.rows, part.columns), np.bool_) if self.holes is None else self.holes[part.slices].copy()

    def put(self, part: Rectangle, heights: Floats, holes: Mask, /) -> None:
        """Replace heights [m] and holes of a part, both (rows, columns)."""
        self.heights[part.slices] = heights
        if self.holes is None and holes.any():
            self.holes = np.zeros(self.heights.shape, np.bool_)
        if self.holes is not None:
            self.holes[part.slices] = holes
        touched = self.heights[part.slices[0]]
        self.row_ends[:, part.slices[0]] = touched.min(axis=1), touched.max(axis=1)
        self.changes.note(part)


@dataclass(slots=True, eq=False)
class Density:
    """Density of each kind, sampled over the whole terrain."""

    maps: NDArray[np.float32]
    """Density in [0, 1] of each kind, row 0 at the far edge (-z), shape (kinds, rows, columns), at least 2 by 2.

    A pixel's density holds at its centre, as in a texture laid over the terrain.
    """

    size: tuple[float, float]
    """Width (x) and depth (z) of all ground, which the maps cover, centred on the origin [m]."""

    land: Terrain | None = None
    """The terrain, whose slopes and holes limit densities; None for no such limits."""

    slopes: tuple[float | None, ...] = ()
    """Steepest slope that each kind grows on [degrees], None for any; empty where no kind has a limit."""

    even: Floats | None = field(init=False)
    """Density of each kind, shape (kinds,), if each map has a single value, as in most scenes; else None."""

    sown: Plots = field(init=False)
    """Densities that a game has sown or cleared, as bytes for all kinds; they replace those of the maps."""

    crowns: Crowns = field(init=False, default_factory=Crowns)
    """Crowns of the trees that shade the grass."""

    def __post_init__(self) -> None:
        """Find `even`, and begin with nothing sown."""
        first = self.maps[:, :1, :1]
        self.even = first[:, 0, 0].copy() if (self.maps == first).all() else None
        self.sown = Plots(self.size, np.dtype(np.uint8), (len(self.maps),))
