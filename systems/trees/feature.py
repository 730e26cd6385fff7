"""The trees of a prairie: whose entities they are, and which of them stand."""

import logging
from collections.abc import Mapping
from functools import partial
from typing import Self

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Floats
from ...components.pose import Pose
from ...components.tree import HIGHEST, LOWEST, Tree
from ...engine.declared.tree import TreeKind
from ...engine.terrain.sample import height_at, natural_at
from ...engine.world import World
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .draw import TreePart
from .habit import HABITS
from .place import placed
from .standing import STANDING, Standing, tell_apart

Found = list[tuple[int, Tree, Pose]]

log = logging.getLogger("tallgrass")


class Trees(Feature):
    """The entities of one world that have a `Tree` and a `Pose`; those of the scene are made here."""

    own = ("tree_twigs", "tree_cards", "tree_far", "tree_air", "tree_mean")

    def __init__(self, world: World, grown: Grown) -> None:
        self._world, self._grown = world, grown
        self._seedlings: list[tuple[Tree, Pose]] = []
        """The scene's own trees, as they are planted."""
        self.entities: list[int] = []
        """Of the scene's own trees, in the order in which they were planted; some may have been felled."""
        self._seen: tuple[list[tuple[int, Tree]], list[tuple[int, Pose]]] = [], []
        self._heights = -1
        self._unknown: set[str] = set()
        """Kinds of which it was said that the scene does not have them."""
        self.standing = Standing(np.zeros(0, STANDING))
        """Those of this frame."""
        self._plant()

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return those of a prairie's world, with its scene's planted."""
        return cls(start.world, start.grown)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Go on with a scene read again: where its trees, its ground or its seed are others, all are planted anew."""
        del time
        self._grown = grown
        if _made_of(grown) != _made_of(before):
            for entity in self.entities:
                self._world.delete(entity)
            self._plant()

    def _plant(self) -> None:
        """Make an entity for each tree that the scene has."""
        scene, terrain = self._grown.scene, self._grown.ground.terrain
        self._seedlings, self._heights = [], -1
        self._unknown.clear()
        taken = np.zeros((0, 2), np.float32)
        for number, (name, kind) in enumerate(scene.trees.items()):
            dense = None if kind.among is None else partial(self._dense, list(scene.grass).index(kind.among))
            place = placed(kind, terrain, dense, taken, seed=scene.seed + number)
            taken = np.concatenate([taken, place])
            self._seedlings += _seedlings(name, kind, place, seed=scene.seed + number)
        self.entities = [self._world.create(*each) for each in self._seedlings]

    def _dense(self, number: int, place: Floats) -> Floats:
        return np.asarray(natural_at(self._grown.ground.density, place)[number], np.float32)

    def step(self, viewer: str, /, *, time: float) -> None:
        """Look which trees stand where; one of a kind that the scene does not have is named once, and left out."""
        del viewer, time
        changes = self._grown.ground.terrain.changes.count
        seen = (trees := self._world.rows(Tree)), self._world.rows(Pose) if trees else []
        if seen == self._seen and changes == self._heights:
            return
        self._seen, self._heights = seen, changes
        found = [each for each in self._world.both(Tree, Pose) if self._knows(each[1])]
        there = [each for each in found if self._world.stands(each[0], each[2], "the tree")]
        self.standing = Standing(_rows(there, self._grown))

    def _knows(self, tree: Tree) -> bool:
        """Return whether the scene has a tree's kind; say once where it does not."""
        kinds = self._grown.scene.trees
        if tree.kind in kinds:
            return True
        if tree.kind not in self._unknown:
            self._unknown.add(tree.kind)
            there = f"there are {', '.join(kinds)}" if kinds else "it has none"
            log.warning(
                "trees of kind '%s' are not shown: this scene does not declare it under 'trees:', %s", tree.kind, there
            )
        return False

    def felled(self) -> list[int]:
        """Return which of the scene's own trees are gone, by their numbers."""
        there = {entity for entity, _ in self._world.all(Tree)}
        return [number for number, entity in enumerate(self.entities) if entity not in there]

    def fell(self, numbers: list[int], /) -> None:
        """Let these be gone of the scene's own, and all others stand where they were planted."""
        gone, wanted = set(self.felled()), set(numbers)
        for number in wanted - gone:
            self._world.delete(self.entities[number])
        for number in sorted(gone - wanted):
            self.entities[number] = self._world.create(*self._seedlings[number])

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> TreePart:
        """Return what draws them."""
        return TreePart(ctx, block, units, lambda: self.standing)


def _seedlings(name: str, kind: TreeKind, place: Floats, *, seed: int) -> list[tuple[Tree, Pose]]:
    """Return the trees of a kind that stand at places (n, 2) [m]."""
    draw = np.random.default_rng((seed, 47))
    low, high = kind.height or HABITS[kind.habit].height
    heights = np.clip(draw.uniform(low, high, len(place)), LOWEST, HIGHEST).tolist()
    turns = draw.uniform(-np.pi, np.pi, len(place)).tolist()
    return [
        (Tree(name, height, kind.foliage), Pose(x, z, yaw))
        for (x, z), height, yaw in zip(place.tolist(), heights, turns, strict=True)
    ]


def _made_of(grown: Grown) -> tuple[object, ...]:
    return grown.scene.trees, grown.scene.seed, grown.ground.terrain, grown.ground.density


def _rows(found: Found, grown: Grown) -> NDArray[np.void]:
    """Return trees as they stand, records of `STANDING`."""
    names = list(grown.scene.trees)
    rows = np.zeros(len(found), STANDING)
    if not found:
        return rows
    rows["kind"] = [names.index(tree.kind) for _, tree, _ in found]
    rows["height"], rows["foliage"] = np.array([(tree.height, tree.foliage) for _, tree, _ in found]).T
    place = np.array([(pose.x, pose.z) for _, _, pose in found], np.float32)
    rows["root"][:, 0], rows["root"][:, 2] = place.T
    rows["root"][:, 1] = height_at(grown.ground.terrain, place)
    rows["yaw"] = [pose.yaw for _, _, pose in found]
    tell_apart(rows)
    return rows
