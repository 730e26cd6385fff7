"""A forest too large for all of its trees to be entities: those near viewers are, and come and go with them."""

from collections.abc import Iterable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import numpy as np

from ...components.pose import Pose
from ...components.tree import Tree
from ...engine.world import World
from ..frame.feature import Eye
from .felled import Place, found_again
from .forest import Forest, Gone, Rows, Square
from .scatter import SQUARE
from .standing import Standing

NEAR = 160.0
"""How near to a viewer squares are whose trees are entities [m]; they stay until they are a square farther off."""

MOST_VIEWERS = 8
"""Of more, those count that looked last."""


Seedling = tuple[Tree, Pose]
Felled = tuple[int, int, int]
"""A tree that is gone: the numbers of its square, and its own on that."""


class Wild:
    """The entities of a large forest, and what is shown of it about each viewer; `names` are those of its kinds.

    While somebody watches `live`, what a viewer comes to see far off grows on another thread.
    """

    def __init__(self, world: World, forest: Forest, names: list[str], *, live: bool) -> None:
        self._world, self._forest, self._names = world, forest, names
        self._live = live
        self._hands = ThreadPoolExecutor(1, thread_name_prefix="tallgrass")  # without a thread, until it is asked
        self._asked: dict[str, Future[None]] = {}
        self._eyes: dict[str, tuple[int, int]] = {}
        """The square that each viewer is on."""
        self._own: dict[Square, list[tuple[int, Seedling]]] = {}
        """The trees of each square near any, entities and as what they were planted."""
        self._changed: dict[int, Felled] = {}
        """Trees that a game has made others, and has of its own now, by their entities."""
        self.left: set[int] = set()
        """Entities that were taken away as no viewer is near them any more, until somebody takes note."""
        self._people = 0
        self._shown: dict[str, tuple[tuple[object, ...], Standing]] = {}

    @property
    def entities(self) -> set[int]:
        """Those that are there as they were planted."""
        return {entity for own in self._own.values() for entity, one in own if self._is(entity, one)}

    def follow(self, viewer: str, eye: Eye, /) -> None:
        """Let the trees near a viewer's eye (x, y, z) [m] be entities."""
        square = int(np.floor(eye[0] / SQUARE)), int(np.floor(eye[2] / SQUARE))
        if self._eyes.get(viewer) == square and self._people == self._world.check():
            return
        if self._people != self._world.check():  # a game has deleted all there was
            self._own, self._people = {}, self._world.check()
        self._eyes.pop(viewer, None)
        self._eyes[viewer] = square
        self._eyes = dict([*self._eyes.items()][-MOST_VIEWERS:])
        stay = self._about(2)
        for left in [each for each in self._own if each not in stay]:
            self._leave(left)
        self._come(self._about(1) - self._own.keys())

    def _about(self, more: int) -> set[Square]:
        reach = round(NEAR / SQUARE) + more
        steps = range(-reach, reach + 1)
        return {
            (i + x, j + z)
            for i, j in self._eyes.values() for x in steps for z in steps if x * x + z * z <= reach * reach
        }  # fmt: skip

    def _come(self, squares: Iterable[Square]) -> None:
        for square, rows in self._forest.on(sorted(squares)).items():
            gone = self._forest.gone.get(square, {})
            planted = seedlings(rows, self._names)
            self._own[square] = [
                (-1 if number in gone else self._world.create(*one), one) for number, one in enumerate(planted)
            ]

    def _leave(self, square: Square) -> None:
        self._note(square)
        for number, (entity, one) in enumerate(self._own.pop(square)):
            if self._is(entity, one):
                self._world.delete(entity)
                self.left.add(entity)
            elif entity >= 0 and self._world.has(entity):
                self._changed[entity] = *square, number

    def _is(self, entity: int, one: Seedling) -> bool:
        """Return whether an entity is a tree as it was planted."""
        tree = self._world.find(entity, Tree) if entity >= 0 and self._world.has(entity) else None
        return tree is not None and (tree, self._world.find(entity, Pose)) == one

    def _note(self, square: Square) -> None:
        """Take note which trees of a square are not there any more as they were planted."""
        gone = {
            number: (one[1].x, one[1].z)
            for number, (entity, one) in enumerate(self._own[square]) if not self._is(entity, one)
        }  # fmt: skip
        if gone:
            self._forest.gone[square] = gone
        else:
            self._forest.gone.pop(square, None)

    def standing(self, viewer: str, eye: Eye, rows: Rows, /) -> Standing:
        """Return the trees that a viewer is shown: `rows` are all that are entities."""
        made_of = id(rows), self._eyes.get(viewer), tuple(self._own), self._forest.version
        known = self._shown.get(viewer)
        if known is not None and known[0][1] != made_of[1] and self._live and self._waits(viewer, eye):
            return known[1]
        if known is None or known[0] != made_of:
            self._shown = {name: each for name, each in self._shown.items() if name in self._eyes}
            known = made_of, Standing(np.concatenate([rows, self._forest.around(eye, self._own)]))
            self._shown[viewer] = known
        return known[1]

    def _waits(self, viewer: str, eye: Eye) -> bool:
        """Return whether what a viewer comes to see is still growing; it begins to, where it was not asked for."""
        if viewer not in self._asked:
            self._asked[viewer] = self._hands.submit(self._forest.grow_about, eye)
        if not self._asked[viewer].done():
            return True
        self._asked.pop(viewer).result()
        return False

    def felled(self) -> tuple[list[Felled], list[Place]]:
        """Return which trees are gone, or have become others, and where these stood."""
        for square in self._own:
            self._note(square)
        gone = [(square, number) for square, gone in self._forest.gone.items() for number in gone]
        told = sorted((*square, number, *self._forest.gone[square][number]) for square, number in gone)
        return [(i, j, number) for i, j, number, _, _ in told], [(x, z) for _, _, _, x, z in told]

    def found_again(self, felled: Sequence[Felled], stood: Sequence[Place] | None, /) -> Gone:
        """Return which trees those are that are gone by a state; raises ValueError for any that nobody planted."""
        by_square: dict[Square, list[int]] = {}
        for which, (i, j, _) in enumerate(felled):
            by_square.setdefault((i, j), []).append(which)
        if not all(map(self._forest.reaches, by_square)):
            raise ValueError("it has felled trees off this scene's ground")
        if self._forest.streams:  # what is not in its window cannot grow
            middle = [((i + 0.5) * SQUARE, (j + 0.5) * SQUARE) for i, j, _ in felled] if stood is None else stood
            return {at: {felled[which][2]: middle[which] for which in own} for at, own in by_square.items()}
        gone: Gone = {}
        for square, rows in self._forest.on(by_square).items():
            own, places = by_square[square], rows["root"][:, ::2].astype(np.float64)
            there = None if stood is None else [stood[which] for which in own]
            numbers = found_again([felled[which][2] for which in own], there, places)
            gone[square] = {number: (float(places[number, 0]), float(places[number, 1])) for number in numbers}
        return gone

    def fell(self, gone: Gone, kept: set[int], /) -> None:
        """Let these be gone, and all others stand where they were planted; of changed ones those `kept` stay."""
        self.clear()
        self._forest.gone = gone
        for entity, (i, j, number) in [*self._changed.items()]:
            if number not in gone.get((i, j), {}) or entity not in kept:
                if self._world.has(entity):
                    self._world.delete(entity)
                del self._changed[entity]

    def clear(self) -> None:
        """Let none be an entity until a viewer is followed again."""
        for square in [*self._own]:
            self._leave(square)
        self._eyes.clear()
        self._shown.clear()

    def release(self) -> None:
        """Let nothing grow any more."""
        self._hands.shutdown(wait=False, cancel_futures=True)


def seedlings(rows: Rows, names: list[str], /) -> list[Seedling]:
    """Return trees, records of `STANDING` of kinds by their names, as entities have them."""
    columns = (rows[name].tolist() for name in ("kind", "height", "foliage", "root", "yaw"))
    return [
        (Tree(names[kind], height, foliage), Pose(x, z, yaw))
        for kind, height, foliage, (x, _, z), yaw in zip(*columns, strict=True)
    ]
