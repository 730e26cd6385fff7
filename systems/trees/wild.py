"""A forest too large for all of its trees to be entities: those near viewers are, and come and go with them."""

from collections.abc import Iterable, Sequence
from concurrent.futures import Future

import numpy as np

from ...components.arrays import Place, Point
from ...components.pose import Pose
from ...components.tree import Tree
from ...engine.executor import DaemonExecutor
from ...engine.world import World
from .felled import found_again
from .forest import Forest, Gone, Rows, Square
from .scatter import SQUARE
from .standing import Standing

NEAR = 160.0
"""Distance from a viewer within which the trees of a square become entities [m]; they stay up to one square farther."""

MOST_VIEWERS = 8
"""Greatest number of viewers; of more, those count that looked last."""


Seedling = tuple[Tree, Pose]
Felled = tuple[int, int, int]
"""A tree that is gone: its square (i, j), and its number on that."""


class Wild:
    """The entities of a large forest, and the trees shown to each viewer; `names` are those of its kinds.

    If `live`, distant trees that come into a viewer's range grow on another thread.
    """

    def __init__(self, world: World, forest: Forest, names: list[str], *, live: bool) -> None:
        self._world, self._forest, self._names = world, forest, names
        self._live = live
        self._executor = DaemonExecutor()
        self._growing: dict[str, Future[None]] = {}
        self._viewer_squares: dict[str, tuple[int, int]] = {}
        """Square that each viewer is on."""
        self._planted: dict[Square, list[tuple[int, Seedling]]] = {}
        """Entities and seedlings of each square near a viewer; the entity is -1 where the tree is gone."""
        self._changed: dict[int, Felled] = {}
        """Trees that a game has changed and taken over, by entity."""
        self.departed: set[int] = set()
        """Entities removed because no viewer is near, until somebody clears the set."""
        self._generation = 0
        self._standing: dict[str, tuple[tuple[object, ...], Standing]] = {}

    @property
    def entities(self) -> set[int]:
        """Entities that are unchanged since they were planted."""
        return {
            entity for own in self._planted.values() for entity, seedling in own if self._unchanged(entity, seedling)
        }

    def follow(self, viewer: str, eye: Point, /) -> None:
        """Make the trees near a viewer's eye (x, y, z) [m] entities."""
        square = int(np.floor(eye[0] / SQUARE)), int(np.floor(eye[2] / SQUARE))
        if self._viewer_squares.get(viewer) == square and self._generation == self._world.check():
            return
        if self._generation != self._world.check():  # a game has cleared its world
            self._planted, self._generation = {}, self._world.check()
        self._viewer_squares.pop(viewer, None)
        self._viewer_squares[viewer] = square
        self._viewer_squares = dict([*self._viewer_squares.items()][-MOST_VIEWERS:])
        stay = self._squares_near(2)
        for square in [each for each in self._planted if each not in stay]:
            self._remove(square)
        self._add(self._squares_near(1) - self._planted.keys())

    def _squares_near(self, margin: int) -> set[Square]:
        reach = round(NEAR / SQUARE) + margin
        steps = range(-reach, reach + 1)
        return {
            (i + x, j + z)
            for i, j in self._viewer_squares.values() for x in steps for z in steps if x * x + z * z <= reach * reach
        }  # fmt: skip

    def _add(self, squares: Iterable[Square]) -> None:
        for square, rows in self._forest.on(sorted(squares)).items():
            gone = self._forest.gone.get(square, {})
            planted = seedlings(rows, self._names)
            self._planted[square] = [
                (-1 if number in gone else self._world.create(*seedling), seedling)
                for number, seedling in enumerate(planted)
            ]

    def _remove(self, square: Square) -> None:
        self._note_gone(square)
        for number, (entity, seedling) in enumerate(self._planted.pop(square)):
            if self._unchanged(entity, seedling):
                self._world.delete(entity)
                self.departed.add(entity)
            elif entity >= 0 and self._world.has(entity):
                self._changed[entity] = *square, number

    def _unchanged(self, entity: int, seedling: Seedling) -> bool:
        """Return whether an entity is still its seedling."""
        tree = self._world.find(entity, Tree) if entity >= 0 and self._world.has(entity) else None
        return tree is not None and (tree, self._world.find(entity, Pose)) == seedling

    def _note_gone(self, square: Square) -> None:
        """Note which trees of a square are removed or changed."""
        gone = {
            number: (seedling[1].x, seedling[1].z)
            for number, (entity, seedling) in enumerate(self._planted[square]) if not self._unchanged(entity, seedling)
        }  # fmt: skip
        if gone:
            self._forest.gone[square] = gone
        else:
            self._forest.gone.pop(square, None)

    def standing(self, viewer: str, eye: Point, rows: Rows, /) -> Standing:
        """Return the trees that a viewer is shown; `rows` are those that are entities."""
        inputs = id(rows), self._viewer_squares.get(viewer), tuple(self._planted), self._forest.version
        known = self._standing.get(viewer)
        if known is not None and known[0][1] != inputs[1] and self._live and self._still_growing(viewer, eye):
            return known[1]
        if known is None or known[0] != inputs:
            self._standing = {name: each for name, each in self._standing.items() if name in self._viewer_squares}
            known = inputs, Standing(np.concatenate([rows, self._forest.around(eye, self._planted)]))
            self._standing[viewer] = known
        return known[1]

    def _still_growing(self, viewer: str, eye: Point) -> bool:
        """Return whether a viewer's distant trees are still growing; start growing them if need be."""
        if viewer not in self._growing:
            self._growing[viewer] = self._executor.submit(self._forest.grow_about, eye)
        if not self._growing[viewer].done():
            return True
        self._growing.pop(viewer).result()
        return False

    def felled(self) -> tuple[list[Felled], list[Place]]:
        """Return the trees that are gone or changed, and where they stood."""
        for square in self._planted:
            self._note_gone(square)
        gone = [(square, number) for square, gone in self._forest.gone.items() for number in gone]
        felled = sorted((*square, number, *self._forest.gone[square][number]) for square, number in gone)
        return [(i, j, number) for i, j, number, _, _ in felled], [(x, z) for _, _, _, x, z in felled]

    def found_again(self, felled: Sequence[Felled], stood: Sequence[Place], /) -> tuple[Gone, list[Place]]:
        """Return the trees that a saved state has felled, and the places of those that stand nowhere here."""
        by_square: dict[Square, list[int]] = {}
        for which, (i, j, _) in enumerate(felled):
            by_square.setdefault((i, j), []).append(which)
        missing = [stood[which] for at, some in by_square.items() if not self._forest.reaches(at) for which in some]
        by_square = {at: some for at, some in by_square.items() if self._forest.reaches(at)}
        if self._forest.streams:  # squares outside its window cannot grow
            return {at: {felled[which][2]: stood[which] for which in some} for at, some in by_square.items()}, missing
        gone: Gone = {}
        for square, rows in self._forest.on(by_square).items():
            then, places = by_square[square], rows["root"][:, ::2].astype(np.float64)
            numbers = found_again([felled[which][2] for which in then], [stood[which] for which in then], places)
            missing += [stood[which] for which, number in zip(then, numbers, strict=True) if number is None]
            there = [number for number in numbers if number is not None]
            gone[square] = {number: (float(places[number, 0]), float(places[number, 1])) for number in there}
        return gone, missing

    def fell(self, gone: Gone, kept: set[int], /) -> None:
        """Remove these trees and restore all others; changed trees stay if they are among the entities `kept`."""
        self.clear()
        self._forest.gone = gone
        for entity, (i, j, number) in [*self._changed.items()]:
            if number not in gone.get((i, j), {}) or entity not in kept:
                if self._world.has(entity):
                    self._world.delete(entity)
                del self._changed[entity]

    def clear(self) -> None:
        """Remove all entities until a viewer is followed again."""
        for square in [*self._planted]:
            self._remove(square)
        self._viewer_squares.clear()
        self._standing.clear()

    def release(self) -> None:
        """Stop the growing thread."""
        self._executor.release()


def seedlings(rows: Rows, names: list[str], /) -> list[Seedling]:
    """Return records of `STANDING` as seedlings; `names` are those of the kinds."""
    columns = (rows[name].tolist() for name in ("kind", "height", "foliage", "root", "yaw"))
    return [
        (Tree(names[kind], height, foliage), Pose(x, z, yaw))
        for kind, height, foliage, (x, _, z), yaw in zip(*columns, strict=True)
    ]
