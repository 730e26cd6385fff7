"""Trees that stay chosen, and which of them a picture shows."""

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices, Mask
from ..space.frustum import outside_planes
from .batch import Batch
from .bounds import Balls, outside_picture
from .look import Look
from .stream import BACKS, FAR, WOODS

DETAIL = "twig_share", "far_fade", "opacity"
"""Fields of `INSTANCE` that change with every step."""


class Shown:
    """What is chosen for a viewpoint, of trees that are not distant. Pictures from places near by show it.

    `trees` are records of `INSTANCE`, `number` is the index of each among all, `extents` are those of
    `outside_picture`, and `pixel_radius` is that of each one's stems, as `Batch` has it. `tree` is the tree of each of
    the `instances`, as an index into these. Some of them, `blocks` of twigs, have bounding spheres, `balls`. `ends` are
    the indices after each of the first batches, which have these instances.
    """

    def __init__(
        self, look: Look, batches: list[Batch], trees: NDArray[np.void], number: Indices, extents: Doubles,
        pixel_radius: Doubles, tree: Indices, instances: NDArray[np.void], blocks: Indices, balls: Balls, ends: Indices,
    ) -> None:  # fmt: skip
        self.look, self.trees, self.number = look, trees, number
        self.batches = batches
        """What is drawn, but for trees that are not in the picture."""
        self.rows: list[NDArray[np.void]] = []
        """Records of `INSTANCE` that a picture shows of each of the first batches."""
        self.woods = 0
        """Number of changes of the trees in the picture, and with them of `pixel_radius` of the batches of wood."""
        self._extents, self._pixel_radius, self._tree, self._instances = extents, pixel_radius, tree, instances
        self._blocks, self._balls, self._ends = blocks, balls, ends
        names, counts = [batch.name for batch in batches[: len(ends)]], np.diff(ends, prepend=0)
        self.places = [
            batch.size - count if batch.name in BACKS else 0 if batch.name == FAR else None
            for batch, count in zip(batches, counts.tolist(), strict=False)
        ]
        """Place in each of these streams of pictures, which distant trees share; None for others."""
        self._pictured = np.repeat(np.array([place is not None for place in self.places], np.bool_), counts)
        """Whether instances are pictures. All are drawn, as they have few vertices."""
        self.wood = [number for number, name in enumerate(names) if name in WOODS]
        """Indices of the batches of wood."""
        self._inside: Mask | None = None
        """Which trees are in the picture."""

    def show(self, look: Look, /, *, held: bool = False) -> None:
        """Choose the instances in a picture, and write their level of detail from that of the trees.

        If `held`, their wood stays as it is.
        """
        inside = outside_picture(self._extents, look.sides) <= 0.0
        kept = inside.take(self._tree) | self._pictured
        kept[self._blocks] &= outside_planes(self._balls.middle, look.sides) <= self._balls.radius
        number = np.flatnonzero(kept)
        rows, tree = self._instances.take(number), self._tree.take(number)
        for name in DETAIL:
            rows[name] = self.trees[name].take(tree)
        ends = number.searchsorted(self._ends).tolist()
        self.rows = [rows[first:end] for first, end in zip([0, *ends], ends, strict=False)]
        if not held and (self._inside is None or not np.array_equal(inside, self._inside)):
            self._inside = inside
            self._show_wood(inside)

    def _show_wood(self, inside: Mask) -> None:
        """Let the trees in the picture alone decide how fine their wood is."""
        self.woods += 1
        radius = np.where(inside, self._pixel_radius, np.inf).take(self._tree)
        for number in self.wood:
            first = self._ends[number - 1] if number else 0
            least = float(radius[first : self._ends[number]].min())
            self.batches[number] = self.batches[number]._replace(pixel_radius=least)
