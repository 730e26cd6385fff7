"""The patches around a viewer, as one structure of arrays."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import accumulate
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...components.patch import LodTable
from .changes import Changes

WORD = 8
"""Alignment of columns in memory [bytes]."""

NOWHERE = np.iinfo(np.int32).min
"""Cell of an empty row or slot, along x and z."""


@dataclass(frozen=True, slots=True, eq=False)
class PatchTable(LodTable):
    """The patches around one viewer, a row each.

    The rows form a square window around the viewer that wraps round: the patch of cell (i, j) is always at
    row (j mod side) * side + (i mod side), so that a step of the viewer replaces one line of rows.
    """

    side: int
    """Number of patches along the window's side."""

    changing: NDArray[np.uint8]
    """Memory of all columns that may change while the viewer stays in its cell; comparing it finds whether any did."""

    middle: NDArray[np.float64]
    """Ground position (x, z) of the patch's middle [m], shape (rows, 2)."""

    alive: NDArray[np.bool_]
    """Whether the row's cell lies on the terrain, shape (rows,)."""

    grows: NDArray[np.bool_]
    """Whether the cell is no clearing, shape (rows,)."""

    model: NDArray[np.int32]
    """Index of the patch model, shape (rows,)."""

    turn: NDArray[np.int32]
    """Quarter turns of the model, shape (rows,)."""

    away: NDArray[np.int32]
    """Discrete distance with the eye's height counted, shape (rows,)."""

    nearness: NDArray[np.int16]
    """Sort key of the drawing order: it rises from far to near, shape (rows,)."""

    near: NDArray[np.bool_]
    """Whether the patch is visible, or among the four patches nearest to a visible place, shape (rows,)."""

    was_visible: NDArray[np.bool_]
    """Whether the patch was visible in the viewer's last frame, shape (rows,)."""

    height: NDArray[np.float32]
    """Height of the ground at the patch's middle [m], shape (rows,)."""

    slope: NDArray[np.float32]
    """Slope of the ground there along x and z, shape (rows, 2)."""

    sublevel: NDArray[np.int8]
    """Current sub-level of each representation, in its own numbers; during a change the new one, -1 for none yet, shape
    (representations, rows)."""

    sublevel_before: NDArray[np.int8]
    """Sub-levels before their last change, shape (representations, rows)."""

    sublevel_progress: NDArray[np.float32]
    """Progress of the changes of sub-level, 1 when they are over, shape (representations, rows)."""

    entity: NDArray[np.int64]
    """Entity of the patch, 0 for none, shape (rows,)."""

    @property
    def representations(self) -> Changes:
        """Changes of representation."""
        return Changes(self.representation, self.previous, self.progress)

    def sublevels(self, level: int, /) -> Changes:
        """Return the changes of sub-level of the representation with a number."""
        return Changes(self.sublevel[level], self.sublevel_before[level], self.sublevel_progress[level])

    @property
    def lines(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The x of the window's columns, shape (side,), and the z of its lines, shape (side, 1), at middles [m]."""
        square = self.middle.reshape(self.side, self.side, 2)
        return square[0, :, 0], square[:, :1, 1]

    @property
    def stands(self) -> NDArray[np.bool_]:
        """Whether the patch has any grass, shape (rows,)."""
        return self.alive & self.grows

    @property
    def shown(self) -> NDArray[np.bool_]:
        """Whether the patch has grass and is inside the view cone, shape (rows,)."""
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
        changing, views = _in_one_block(columns)
        return cls(
            viewer=viewer, names=names, side=side, changing=changing, **views,
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
        """Sort rows (n,) into the drawing order of their patches, from far to near."""
        return rows[np.argsort(self.nearness[rows], kind="stable")]

    def empty(self, rows: NDArray[np.int32], /) -> None:
        """Reset the levels of detail of rows that hold another patch now."""
        for levels in (self.wanted, self.hold, self.representation, self.previous):
            levels[rows] = -1
        self.sublevel[:, rows] = self.sublevel_before[:, rows] = -1
        self.progress[rows], self.sublevel_progress[:, rows] = 1.0, 1.0
        self.visible[rows] = self.was_visible[rows] = False


def _in_one_block(
    columns: Mapping[str, tuple[type[np.generic], tuple[int, ...], int]],
) -> tuple[NDArray[np.uint8], dict[str, NDArray[Any]]]:
    """Allocate columns of (type, shape, initial value) in one block of memory; return the block and its views."""
    sizes = [-(-prod(shape) * np.dtype(kind).itemsize // WORD) * WORD for kind, shape, _ in columns.values()]
    memory = np.zeros(sum(sizes), np.uint8)
    views: dict[str, NDArray[Any]] = {}
    for (name, (kind, shape, initial)), start in zip(columns.items(), accumulate(sizes, initial=0), strict=False):
        end = start + prod(shape) * np.dtype(kind).itemsize
        views[name] = memory[start:end].view(kind).reshape(shape)
        views[name][:] = initial
    return memory, views
