"""Batches of trees: what one stream of a model draws in a frame."""

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .shells import farthest_of
from .stream import FAR, SHELL_OF, STREAMS


class Batch(NamedTuple):
    """Trees of one model, or twigs or blocks of twigs of them, that one stream draws together."""

    model: int
    """Index of the model among those of all kinds."""

    name: str
    """Name of the stream."""

    parts: tuple[NDArray[np.void], ...]
    """Instance attributes of each: records of `INSTANCE`, one array after another."""

    nearest: float
    """Distance of the nearest crown's middle [m]."""

    mean: float
    """Mean distance of the crowns' middles [m]."""

    far: float
    """Distance of the farthest tree by the order of patches, as `farthest_of` returns it [m]."""

    pixel_radius: float = inf
    """Least radius of a stem of the model that is a pixel wide, at the nearest tree [m]; of wood alone."""

    foliage: float = 1.0
    """Least share of its leaves that a tree has; of wood alone."""

    @property
    def size(self) -> int:
        """Number of instances."""
        return sum(map(len, self.parts))


def joined(near: Batch, beyond: Batch, /) -> Batch:
    """Return a stream's pictures as one batch: those `beyond` all others are the last or, of soft edges, the first."""
    both = (near, beyond) if near.name == FAR else (beyond, near)
    mean = sum(each.size * each.mean for each in both) / sum(each.size for each in both)
    return near._replace(parts=(*both[0].parts, *both[1].parts), mean=mean)


def one_of_each(models: int, tree: NDArray[np.void], /) -> Sequence[Batch]:
    """Return a tree for each stream of so many models, drawn anywhere; `tree` is a record of `INSTANCE`, shape (1,)."""
    streams = [(model, name) for model in range(models) for name in STREAMS]
    return [Batch(model, name, (tree,), 0.0, 0.0, farthest_of(SHELL_OF[name], 1.0), 1.0) for model, name in streams]
