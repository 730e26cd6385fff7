"""Terrain and density as arrays over the ground."""

from collections import deque
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats, Mask
from .blocks import REACH, Blocks
from .crowns import Crowns
from .part import MOST, Part
from .plots import Plots

BEYOND = 600.0
"""How far level ground goes on beyond the terrain's edge [m]: a walker's horizon lies two pixels higher."""

MIRRORED = 4000.0
"""How far mirrored ground does [m]: the usual haze hides nine tenths of what is as far off, and the rest fades out."""

GLSL = {"GOES_ON": MIRRORED}


@dataclass(slots=True, eq=False)
class Changes:
    """What a game has changed of a terrain."""

    count: int = 0
    """How often it has."""

    moves: int = 0
    """How often the samples have become those of another window; all that is counted in samples has moved then."""

    leaps: int = 0
    """How often of these somebody waits for it."""

    loaded: dict[tuple[int, int], tuple[Floats, Mask]] = field(default_factory=dict)
    """The heights and the holes as they were loaded, of each square of samples that has been changed since, by its row
    and column."""

    _last: deque[Part] = field(default_factory=lambda: deque(maxlen=MOST))

    def note(self, part: Part, /) -> None:
        """Note that a part has changed."""
        self.count += 1
        self._last.append(part)

    def move(self, down: int, right: int, /, *, leaps: bool) -> None:
        """Note that samples are counted from one on that lies so many farther down and to the right."""
        self.moves += 1
        self.leaps += leaps
        moved = [part.moved(-down, -right) for part in self._last]
        self._last.clear()
        self._last.extend(moved)

    def since(self, count: int, /) -> list[Part] | None:
        """Return what has changed since there were `count` changes; None for too many: it may be anything.

        Of a ground that streams, some of it may lie elsewhere by now.
        """
        missed = self.count - count
        return None if missed > len(self._last) else list(self._last)[len(self._last) - missed :]


@dataclass(frozen=True, slots=True, eq=False)
class Terrain:
    """An elevation map whose samples stand at cell corners; between them heights are bilinear.

    It has at least 2 by 2 samples and is centred on the origin, unless it is the window of a ground without an edge. It
    is one prairie's own: what a game changes of its heights is written into the array (`change`), and who has made
    anything of them looks at `changes`.
    """

    heights: NDArray[np.float32]
    """Heights [m], row 0 at the far edge (-z), shape (rows, columns)."""

    cell: float
    """Metres per cell."""

    holes: Mask | None = None
    """Samples at which there is no ground, shape (rows, columns); None where nobody has ever said so of any."""

    first: tuple[int, int] | None = None
    """Row and column of the first sample, counted from the origin; None where the terrain is centred there."""

    blocks: Blocks | None = None
    """The ground that it is the window of."""

    mirrored: bool = False
    """Whether it goes on beyond its edge as a mirror image of itself; else as high as its nearest edge."""

    changes: Changes = field(init=False, default_factory=Changes)

    found: object = field(init=False, default=None)
    """What somebody has made out of the heights beforehand."""

    _ends: Floats = field(init=False)
    """The lowest and the highest of each row [m], shape (2, rows)."""

    def __post_init__(self) -> None:
        """Look through the heights once."""
        object.__setattr__(self, "_ends", np.stack([self.heights.min(axis=1), self.heights.max(axis=1)]))

    @property
    def span(self) -> tuple[float, float]:
        """The lowest and the highest of the heights [m]."""
        return float(self._ends[0].min()), float(self._ends[1].max())

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
        """Width (x) and depth (z) of all the ground that there is, centred on the origin [m]."""
        return self.size if self.blocks is None else (2.0 * REACH, 2.0 * REACH)

    @property
    def beyond(self) -> float:
        """How far ground is drawn beyond its edge [m]."""
        return MIRRORED if self.mirrored else BEYOND

    def find(self, found: object, /) -> None:
        """Keep what somebody has made out of the heights, for as long as they are those of this window."""
        object.__setattr__(self, "found", found)

    def become(self, other: "Terrain", /, *, leaps: bool = False) -> None:
        """Be another window of the same ground; `leaps` says that somebody waits for it."""
        assert self.first is not None
        assert other.first is not None
        down, right = (after - before for after, before in zip(other.first, self.first, strict=True))
        for name in ("heights", "holes", "first", "found", "_ends"):
            object.__setattr__(self, name, getattr(other, name))
        self.changes.move(down, right, leaps=leaps)

    def holes_in(self, part: Part, /) -> Mask:
        """Return at which samples of a part there are holes, shape (rows, columns)."""
        return np.zeros((part.rows, part.columns), np.bool_) if self.holes is None else self.holes[part.slices].copy()

    def put(self, part: Part, heights: Floats, holes: Mask, /) -> None:
        """Write other heights (rows, columns) [m] into a part, and at which of its samples there are holes."""
        self.heights[part.slices] = heights
        if self.holes is None and holes.any():
            object.__setattr__(self, "holes", np.zeros(self.heights.shape, np.bool_))
        if self.holes is not None:
            self.holes[part.slices] = holes
        touched = self.heights[part.slices[0]]
        self._ends[:, part.slices[0]] = touched.min(axis=1), touched.max(axis=1)
        self.changes.note(part)


@dataclass(frozen=True, slots=True, eq=False)
class Density:
    """How densely each kind grows, sampled over the whole terrain."""

    maps: NDArray[np.float32]
    """Density in [0, 1] of each kind, row 0 at the far edge (-z), shape (kinds, rows, columns), at least 2 by 2.

    A pixel's density stands in its middle, as in a texture laid over the terrain."""

    size: tuple[float, float]
    """Width (x) and depth (z) of all the ground, which the maps are laid over, centred on the origin [m]."""

    land: Terrain | None = None
    """The terrain, which may say more of where kinds grow; without one they grow on all of it."""

    slopes: tuple[float | None, ...] = ()
    """The steepest slope that each kind grows on [degrees], if there is one; none at all where no kind has one."""

    even: Floats | None = field(init=False)
    """Each kind's density where every map has one alone, as most scenes' have, shape (kinds,)."""

    sown: Plots = field(init=False)
    """What a game has sown and cleared: densities of all kinds in bytes, in place of those of the maps."""

    crowns: Crowns = field(init=False, default_factory=Crowns)
    """The trees that take its light."""

    def __post_init__(self) -> None:
        """Begin with nothing sown."""
        flat = self.maps.reshape(len(self.maps), -1)
        object.__setattr__(self, "even", flat[:, 0].copy() if (flat == flat[:, :1]).all() else None)
        object.__setattr__(self, "sown", Plots(self.size, np.dtype(np.uint8), (len(self.maps),)))
