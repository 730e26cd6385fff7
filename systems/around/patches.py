"""The patches around a viewer, as one structure of arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

WORD = 8
"""Columns begin at multiples of this [bytes]."""

NOWHERE = np.iinfo(np.int32).min
"""Cell of a row, and of a slot, on which nothing stands."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchTable:
    """The patches around one viewer, one row for each.

    The rows form a square window around the viewer that wraps round: the patch of cell (i, j) is always at
    row (j mod side) * side + (i mod side), so that a step of the viewer replaces one line of rows. Representations go
    by their numbers, from the finest to the coarsest; -1 is none.
    """

    viewer: str
    """The viewer's name."""

    names: tuple[str, ...]
    """The names of the representations."""

    side: int
    """Patches along the window's side."""

    changing: NDArray[np.uint8]
    """All that may change while the viewer stands in a cell, as it lies in memory: so it can be told whether it has."""

    cell: NDArray[np.int32]
    """Shape (rows, 2)."""

    middle: NDArray[np.float64]
    """Ground position (x, z) of its middle [m], shape (rows, 2)."""

    alive: NDArray[np.bool_]
    """Whether the row's cell lies on the terrain, shape (rows,)."""

    grows: NDArray[np.bool_]
    """Whether a game has left its grass there, shape (rows,)."""

    model: NDArray[np.int32]
    """Which patch model stands there, shape (rows,)."""

    turn: NDArray[np.int32]
    """Quarter turns of the model, shape (rows,)."""

    distance: NDArray[np.int32]
    """Discrete distance, shape (rows,)."""

    away: NDArray[np.int32]
    """Discrete distance of what is seen there: from high above it is farther away than on the ground, shape (rows,)."""

    nearness: NDArray[np.int16]
    """A number that rises in the order in which patches are drawn, from far to near, shape (rows,)."""

    visible: NDArray[np.bool_]
    """Whether it is inside the view cone, shape (rows,)."""

    near: NDArray[np.bool_]
    """Whether it is visible, or among the four patches nearest to a visible place, shape (rows,)."""

    was_visible: NDArray[np.bool_]
    """Whether it was visible when the viewer looked last, shape (rows,)."""

    wanted: NDArray[np.int8]
    """The representation that is due, shape (rows,)."""

    hold: NDArray[np.int8]
    """The one that a game holds it in, whatever is due, shape (rows,)."""

    representation: NDArray[np.int8]
    """The one that it has, or is coming to, shape (rows,)."""

    previous: NDArray[np.int8]
    """The one that it comes from, shape (rows,)."""

    progress: NDArray[np.float32]
    """How far the change has gone, 1 when it is over, shape (rows,)."""

    height: NDArray[np.float32]
    """Height of the ground in the patch's middle [m], shape (rows,)."""

    slope: NDArray[np.float32]
    """Rise of the ground there along x and z, shape (rows, 2)."""

    sublevel: NDArray[np.int8]
    """How fine each representation is there, or is coming to be, in its own numbers; -1 for none yet, shape
    (representations, rows)."""

    sublevel_before: NDArray[np.int8]
    """The sub-levels that they come from, shape (representations, rows)."""

    sublevel_progress: NDArray[np.float32]
    """How far these changes have gone, 1 when they are over, shape (representations, rows)."""

    entity: NDArray[np.int64]
    """The patch's entity, 0 where there is none, shape (rows,)."""

    @property
    def lines(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The x of the middles of the window's columns, shape (side,), and the z of its lines, shape (side, 1) [m]."""
        square = self.middle.reshape(self.side, self.side, 2)
        return square[0, :, 0], square[:, :1, 1]

    @property
    def stands(self) -> NDArray[np.bool_]:
        """Whether there is grass at all, shape (rows,)."""
        return self.alive & self.grows

    @property
    def shown(self) -> NDArray[np.bool_]:
        """Whether there is grass inside the view cone, shape (rows,)."""
        return self.alive & self.grows & self.visible

    @classmethod
    def allocate(cls, side: int, names: tuple[str, ...], *, viewer: str = "main") -> "PatchTable":
        """Return an empty table for a window of `side` by `side` patches."""
        rows, several = side * side, (len(names), side * side)
        columns: dict[str, tuple[type[np.generic], tuple[int, ...], int]] = {
            "alive": (np.bool_, (rows,), 0), "grows": (np.bool_, (rows,), 1),
            "visible": (np.bool_, (rows,), 0), "near": (np.bool_, (rows,), 0), "was_visible": (np.bool_, (rows,), 0),
            "wanted": (np.int8, (rows,), -1), "hold": (np.int8, (rows,), -1),
            "representation": (np.int8, (rows,), -1), "previous": (np.int8, (rows,), -1),
            "progress": (np.float32, (rows,), 1),
            "sublevel": (np.int8, several, -1), "sublevel_before": (np.int8, several, -1),
            "sublevel_progress": (np.float32, several, 1),
        }  # fmt: skip
        changing, made = _in_one(columns)
        return cls(
            viewer=viewer, names=names, side=side, changing=changing, **made,
            cell=np.full((rows, 2), NOWHERE, np.int32),
            middle=np.zeros((rows, 2)),
            model=np.zeros(rows, np.int32),
            height=np.zeros(rows, np.float32),
            slope=np.zeros((rows, 2), np.float32),
            turn=np.zeros(rows, np.int32),
            distance=np.zeros(rows, np.int32),
            away=np.zeros(rows, np.int32),
            nearness=np.zeros(rows, np.int16),
            entity=np.zeros(rows, np.int64),
        )  # fmt: skip

    def far_to_near(self, rows: NDArray[np.int64], /) -> NDArray[np.int64]:
        """Return some rows (n,) in the order in which their patches are drawn, from far to near, shape (n,)."""
        return rows[np.argsort(self.nearness[rows], kind="stable")]

    def empty(self, rows: NDArray[np.int32], /) -> None:
        """Forget what is known of the levels of detail of some rows, because another patch is there now."""
        for levels in (self.wanted, self.hold, self.representation, self.previous):
            levels[rows] = -1
        self.sublevel[:, rows] = self.sublevel_before[:, rows] = -1
        self.progress[rows], self.sublevel_progress[:, rows] = 1.0, 1.0
        self.visible[rows] = self.was_visible[rows] = False


def _in_one(
    columns: Mapping[str, tuple[type[np.generic], tuple[int, ...], int]],
) -> tuple[NDArray[np.uint8], dict[str, NDArray[Any]]]:
    """Return columns of some type, shape and first value that lie in one piece of memory, and that."""
    sizes = [-(-prod(shape) * np.dtype(kind).itemsize // WORD) * WORD for kind, shape, _ in columns.values()]
    whole = np.zeros(sum(sizes), np.uint8)
    made: dict[str, NDArray[Any]] = {}
    for (name, (kind, shape, first)), start in zip(columns.items(), accumulate(sizes, initial=0), strict=False):
        end = start + prod(shape) * np.dtype(kind).itemsize
        made[name] = whole[start:end].view(kind).reshape(shape)
        made[name][:] = first
    return whole, made
