"""Trees of entities as records, of which only those that change are made anew."""

from collections.abc import Callable, Sequence

import numpy as np

from ...components.arrays import Indices
from ...components.pose import Pose
from ...components.tree import Tree
from .forest import Rows
from .standing import STANDING

Posed = list[tuple[int, Tree, Pose]]


class TreeRows:
    """The trees of entities as records of `STANDING`, by rising entity number."""

    def __init__(self) -> None:
        self.rows: Rows = np.zeros(0, STANDING)
        self.entities = np.zeros(0, np.int64)
        """Entity of each row."""
        self._parts: dict[int, tuple[Tree, Pose]] = {}
        """Tree and pose of each entity whose row is valid."""

    def forget(self) -> None:
        """Forget all rows."""
        self.rows, self.entities = self.rows[:0], self.entities[:0]
        self._parts = {}

    def make_all_anew(self) -> None:
        """Let the next update make all rows anew, as on another ground."""
        self._parts = {}

    def changed(
        self, trees: Sequence[tuple[int, Tree]], poses: Sequence[Pose | None], /
    ) -> tuple[list[tuple[int, Tree, Pose | None]], Indices]:
        """Return the entities whose tree or pose is another object than in their row, and the rows of all others."""
        find, other, kept = self._parts.get, list[tuple[int, Tree, Pose | None]](), list[int]()
        for (entity, tree), pose in zip(trees, poses, strict=True):
            had = find(entity)
            if had is not None and had[0] is tree and had[1] is pose:
                kept.append(entity)
            else:
                other.append((entity, tree, pose))
        return other, np.searchsorted(self.entities, np.array(kept, np.int64))

    def gone(self, kept: Indices, there: set[int], /) -> list[int]:
        """Return the rows that are neither `kept` nor those of entities that are still `there`."""
        return [row for row in self._but(kept).tolist() if int(self.entities[row]) not in there]

    def take(self, kept: Indices, added: Posed, make: Callable[[Posed], Rows], /) -> None:
        """Keep these rows, and make others of entities added or changed."""
        for entity in self.entities[self._but(kept)].tolist():
            self._parts.pop(entity, None)
        self._parts |= {entity: (tree, pose) for entity, tree, pose in added}
        entities = np.append(self.entities[kept], np.array([entity for entity, _, _ in added], np.int64))
        order = np.argsort(entities)
        self.rows = np.concatenate([self.rows.take(kept), make(added)]).take(order)
        self.entities = entities[order]

    def _but(self, kept: Indices) -> Indices:
        """Return all rows but these."""
        mask = np.ones(len(self.entities), np.bool_)
        mask[kept] = False
        return np.flatnonzero(mask)
