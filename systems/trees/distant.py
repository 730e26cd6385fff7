"""Trees that are far pictures from anywhere near by: they stay chosen while a viewer hardly moves and turns."""

from itertools import pairwise
from math import exp, inf

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Indices, Mask
from .batch import Batch
from .bounds import outside_picture
from .look import Look, Slack
from .shells import SHELLS, rings_of
from .standing import DENSE_TO, RING_FADES, alone_from, ring_opacity
from .stream import BACKS, FAR

SLACK = Slack(moves=2.0, shifts=2.0, turns=0.05, zooms=0.02)
"""Changes within which distant trees stay chosen: less than the distance from tree to tree, and turns of 3 degrees."""

IN_RINGS = SLACK._replace(moves=0.02 * RING_FADES * DENSE_TO)
"""These changes where trees of rings cross-fade: they do so in steps of a fiftieth at most."""

MOST_USED, TIRED = 0.5, 0.25
"""Parts of these changes from which on a model's trees are chosen anew, and if it is their turn. The rest is left until
other trees are chosen next."""

TURNS = 4
"""Each model's turn comes once in so many times: seldom are the trees of many chosen anew."""


class Distant:
    """The trees of all models, some of them distant: pictures alone, and beyond all grass.

    They are sorted by `model`, an index into those of all kinds. `extents` are of `outside_picture`, `instances` are
    records of `INSTANCE` as pictures, and `ring` is that of `STANDING`. `pictured` is the height of each tree's picture
    [m], 0 where it has no twigs, and `needles` tells which models have needles.
    """

    def __init__(
        self, model: Indices, extents: Doubles, instances: NDArray[np.void], ring: NDArray[np.integer],
        pictured: Doubles, needles: Mask,
    ) -> None:  # fmt: skip
        self._extents, self._instances, self._ring, self._needles = extents, instances, ring, needles.tolist()
        ends = np.searchsorted(model, np.arange(len(needles) + 1)).tolist()
        self._rows = [slice(first, end) for first, end in pairwise(ends)]
        """The trees of each model."""
        self._highest = [float(pictured[rows].max(initial=0.0)) for rows in self._rows]
        self._slack = IN_RINGS if ring.any() else SLACK
        self._looks: list[Look | None] = [None] * len(needles)
        """Viewpoint that each model's trees were chosen for."""
        self._time = 0
        self._others = [np.zeros(0, np.intp)] * len(needles)
        self._pictures: list[list[Batch]] = [[] for _ in self._rows]
        self.others: Indices = np.zeros(0, np.intp)
        """Indices of all trees that are not distant, in the picture or not."""
        self.pictures: list[Batch] = []
        """Distant trees in the picture, and a few beside it: opaque from near to far, soft edges from far to near."""

    def follow(self, look: Look, /) -> None:
        """Choose the trees of those models anew whose view has changed."""
        self._time, due = (self._time + 1) % TURNS, list[int]()
        for model, before in enumerate(self._looks):
            limit = TIRED if model % TURNS == self._time else MOST_USED
            if before is None or self._slack.used(before, look) > limit:
                self._choose(model, look)
                due.append(model)
        if not due:
            return
        self.others = np.concatenate(self._others)
        self.pictures = [batch for batches in self._pictures for batch in batches]

    def _choose(self, model: int, look: Look) -> None:
        """Choose a model's trees for all views that differ from this one within the limits."""
        self._looks[model], rows = look, self._rows[model]
        extents = self._extents[rows]
        away = extents[:, :3] - look.eye
        along, distance = np.hypot(away[:, 0], away[:, 2]), np.sqrt(np.einsum("ij,ij->i", away, away))
        is_distant = along >= self._begin(model, look)
        self._others[model] = rows.start + np.flatnonzero(~is_distant)
        beside = self._slack.beside(distance + extents[:, 3] + extents[:, 4])
        number = np.flatnonzero(is_distant & (outside_picture(extents, look.sides) <= beside))
        number = number[np.argsort(distance[number])]
        self._pictures[model] = self._batches(model, number, along[number], distance[number], look.reach)

    def _begin(self, model: int, look: Look) -> float:
        """Return the distance along the ground from which on a model's trees are distant [m]."""
        if not look.is_usual:
            return inf
        pictured = alone_from(exp(self._slack.zooms) * look.focal * self._highest[model])
        return max(pictured, look.reach + self._slack.moves) + self._slack.moves

    def _batches(self, model: int, number: Indices, along: Doubles, distance: Doubles, reach: float) -> list[Batch]:
        """Return trees of a model, from near to far, in the streams that draw them."""
        if not len(number):
            return []
        rows = self._rows[model]
        pictures = self._instances[rows].take(number)
        pictures["opacity"] = ring_opacity(self._ring[rows][number], along)
        batches = [Batch(model, FAR, (pictures,), float(distance[0]), float(distance.mean()), inf)]
        rings = rings_of(along, reach) if self._needles[model] else np.zeros(len(number), np.intp)
        for ring in np.flatnonzero(np.bincount(rings)).tolist():
            of_ring, name = np.flatnonzero(rings == ring)[::-1], BACKS[SHELLS + ring if ring else 0]
            off = distance[of_ring]
            batches.append(Batch(model, name, (pictures.take(of_ring),), float(off[-1]), float(off.mean()), inf))
        return batches
