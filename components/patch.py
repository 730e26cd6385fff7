"""Components of patches of grass and of their level of detail, for a game to read and to write."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

Cell = tuple[int, int]
"""A square (i, j) of the tiling; it covers [i, i + 1) by [j, j + 1) patch sides in x and z."""


class Clearings:
    """The cells whose grass is taken away, for all viewers and at any distance from them."""

    def __init__(self) -> None:
        self._cells: set[Cell] = set()
        self.version = 0
        """A number that differs after every change."""

    def __contains__(self, cell: object) -> bool:
        return cell in self._cells

    def clear(self, cell: Cell, /) -> None:
        """Take the grass of a cell away."""
        self._cells.add(cell)
        self.version += 1

    def restore(self, cell: Cell, /) -> None:
        """Give the grass of a cell back."""
        self._cells.discard(cell)
        self.version += 1

    @property
    def cells(self) -> frozenset[Cell]:
        """The cells that are cleared."""
        return frozenset(self._cells)

    def resume(self, cells: Iterable[Cell], /) -> None:
        """Clear these cells and no others, as a saved state says."""
        self._cells = set(cells)
        self.version += 1

    def spare(self, cells: NDArray[np.int32], /) -> NDArray[np.bool_]:
        """Return which cells (n, 2) keep their grass, shape (n,)."""
        if not self._cells:
            return np.ones(len(cells), np.bool_)
        cleared = _keys(np.array(list(self._cells), np.int64))
        return np.isin(_keys(cells.astype(np.int64)), cleared, invert=True)


@dataclass(frozen=True, slots=True, eq=False)
class LodTable:
    """The levels of detail of all patches around a viewer, a row each.

    Representations are numbered from the finest to the coarsest; -1 is none.
    """

    viewer: str
    """The viewer's name."""

    names: tuple[str, ...]
    """Names of the representations."""

    cell: NDArray[np.int32]
    """Cell (i, j), shape (rows, 2)."""

    distance: NDArray[np.int32]
    """Discrete distance along the ground, shape (rows,)."""

    visible: NDArray[np.bool_]
    """Whether the patch is inside the view cone, shape (rows,)."""

    wanted: NDArray[np.int8]
    """Representation that is due, shape (rows,)."""

    hold: NDArray[np.int8]
    """Representation that a game holds the patch in, whatever is due, shape (rows,)."""

    representation: NDArray[np.int8]
    """Current representation; during a change the new one, shape (rows,)."""

    previous: NDArray[np.int8]
    """Representation before the last change, shape (rows,)."""

    progress: NDArray[np.float32]
    """Progress of that change, 1 when it is over, shape (rows,)."""


@final
class Patch:
    """One square of the tiling (paper, section 2.2). `grows` may be written; the rest cannot.

    Each viewer has an entity of its own for a patch around it. A value written to one holds for all viewers.
    """

    __slots__ = ("_cell", "_cleared", "_model", "_turn")

    def __init__(self, cell: Cell, model: int, turn: int, cleared: Clearings) -> None:
        self._cell, self._model, self._turn, self._cleared = cell, model, turn, cleared

    def __repr__(self) -> str:
        return f"Patch(cell={self.cell}, model={self.model}, turn={self.turn}, grows={self.grows})"

    @property
    def cell(self) -> Cell:
        """Cell (i, j) of the tiling."""
        return self._cell

    @property
    def model(self) -> int:
        """Number of the patch model that stands here."""
        return self._model

    @property
    def turn(self) -> int:
        """Quarter turns of the model about the vertical axis, 0 to 3."""
        return self._turn

    @property
    def grows(self) -> bool:
        """Whether grass grows here. False leaves bare ground, from the same frame on; True restores the grass."""
        return self._cell not in self._cleared

    @grows.setter
    def grows(self, grows: bool) -> None:
        if grows:
            self._cleared.restore(self._cell)
        else:
            self._cleared.clear(self._cell)


@final
class Lod:
    """The level of detail of a patch for one viewer. `wanted` and `hold` may be written; the rest cannot.

    Representations are given by name, `blades`, `strips` or `carpet`, or None. A patch that the viewer has left behind
    has none and is not visible: after a leap its entity stays for a few frames.
    """

    __slots__ = ("_cell", "_levels", "_row")

    def __init__(self, levels: LodTable, row: int, cell: Cell) -> None:
        self._levels, self._row, self._cell = levels, row, cell

    def __repr__(self) -> str:
        fields = ("viewer", "distance", "visible", "representation", "previous", "progress", "wanted", "hold")
        return f"Lod({', '.join(f'{name}={getattr(self, name)!r}' for name in fields)})"

    @property
    def viewer(self) -> str:
        """Name of the viewer whose level of detail this is."""
        return self._levels.viewer

    @property
    def distance(self) -> int:
        """Discrete distance: 0 for the viewer's patch, 1 for its eight neighbours, and so on.

        For a patch that the viewer has left behind it is greater than any other.
        """
        return int(self._levels.distance[self._row]) if self._is_there() else len(self._levels.distance)

    @property
    def visible(self) -> bool:
        """Whether the patch is inside the view cone."""
        return bool(self._levels.visible[self._row]) and self._is_there()

    @property
    def representation(self) -> str | None:
        """Representation of the patch; during a transition, the new one."""
        return self._name(self._levels.representation)

    @property
    def previous(self) -> str | None:
        """Representation before the transition."""
        return self._name(self._levels.previous)

    @property
    def progress(self) -> float:
        """Progress of the transition in [0, 1], 1 when it is over."""
        return float(self._levels.progress[self._row])

    @property
    def wanted(self) -> str | None:
        """Representation that the system `lod` has chosen in this frame; a system after it may choose another."""
        return self._name(self._levels.wanted)

    @wanted.setter
    def wanted(self, name: str | None) -> None:
        self._levels.wanted[self._own_row()] = self._number(name)

    @property
    def hold(self) -> str | None:
        """Representation that a game holds the patch in, whatever its distance; None leaves the choice to `lod`.

        The patch changes to it by a transition. If pools have no room for it at this distance, the patch gets the
        finest that has room. It is held until the viewer has left the patch behind.
        """
        return self._name(self._levels.hold)

    @hold.setter
    def hold(self, name: str | None) -> None:
        self._levels.hold[self._own_row()] = self._number(name)

    def _name(self, numbers: NDArray[np.int8]) -> str | None:
        number = int(numbers[self._row])
        return None if number < 0 or not self._is_there() else self._levels.names[number]

    def _number(self, name: str | None) -> int:
        if name is None:
            return -1
        if name not in self._levels.names:
            raise ValueError(f"unknown representation {name!r}; there are {', '.join(self._levels.names)}")
        return self._levels.names.index(name)

    def _is_there(self) -> bool:
        """Return whether the row still belongs to this patch."""
        i, j = self._levels.cell[self._row].tolist()
        return (i, j) == self._cell

    def _own_row(self) -> int:
        if not self._is_there():
            raise RuntimeError(f"the viewer '{self.viewer}' has left the patch {self._cell} behind")
        return self._row


def _keys(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return a unique number for each cell (n, 2), shape (n,)."""
    return cells[:, 0] << 32 ^ cells[:, 1] & 0xFFFFFFFF
