"""Trees of entities as records, of which only those that change are made anew."""

from collections.abc import Callable, Sequence

import numpy as np

from ...components.pose import Pose
from ...components.tree import Tree
from .forest import Rows
from .standing import STANDING

Posed = list[tuple[int, Tree, Pose]]


class TreeRows:
    """The trees of entities as records of `STANDING`, by rising entity number."""

    def __init__(self) -> None:
        self.rows: Rows = np.zeros(0, STANDING)
        self.entities: list[int] = []
        """Entity of each row."""
        self._parts: dict[int, tuple[int, Tree, Pose]] = {}
        """Row, tree and pose of each entity whose row is valid."""

    def forget(self) -> None:
        """Forget all rows."""
        self.rows, self.entities = self.rows[:0], []
        self._parts = {}

    def make_all_anew(self) -> None:
        """Let the next update make all rows anew, as on another ground."""
        self._parts = {}

    def changed(
        self, trees: Sequence[tuple[int, Tree]], poses: Sequence[Pose | None], /
    ) -> tuple[list[tuple[int, Tree, Pose | None]], list[int]]:
        """Return the entities whose tree or pose is another object than in their row, and the rows of all others."""
        find, other, kept = self._parts.get, list[tuple[int, Tree, Pose | None]](), list[int]()
        for (entity, tree), pose in zip(trees, poses, strict=True):
            had = find(entity)
            if had is not None and had[1] is tree and had[2] is pose:
                kept.append(had[0])
            else:
                other.append((entity, tree, pose))
        return other, kept

    def gone(self, kept: Sequence[int], there: set[int], /) -> list[int]:
        """Return the rows that are neither `kept` nor those of entities that are still `there`."""
        mask = np.ones(len(self.entities), np.bool_)
        mask[kept] = False
        return [row for row in np.flatnonzero(mask).tolist() if self.entities[row] not in there]

    def take(self, kept: Sequence[int], added: Posed, make: Callable[[Posed], Rows], /) -> None:
        """Keep these rows, and make others of entities added or changed."""
        parts, entities = self._parts, [self.entities[row] for row in kept]
        posed: Posed = [(entity, *parts[entity][1:]) for entity in entities] + added
        order = np.argsort(np.array([entity for entity, _, _ in posed], np.int64)).tolist()
        self.rows = np.concatenate([self.rows.take(kept), make(added)]).take(order)
        posed = [posed[each] for each in order]
        self.entities = [entity for entity, _, _ in posed]
        self._parts = {entity: (row, tree, pose) for row, (entity, tree, pose) in enumerate(posed)}
