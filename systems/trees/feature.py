"""The trees of a prairie: whose entities they are, and which of them stand."""

import logging
from collections.abc import Mapping, Sequence
from itertools import compress
from typing import Self

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats
from ...components.pose import Pose
from ...components.tree import HIGHEST, LOWEST, Tree
from ...engine.declared.tree import TreeKind
from ...engine.terrain.sample import height_at
from ...engine.world import World, uncollected
from ..frame.block import FrameBlock
from ..frame.feature import Eye, Feature, Start
from ..space.grown import Grown
from .crown import FOOT, FOOT_MEETS_MOST, LEAST_SHADE
from .draw import TreePart
from .felled import Place, found_again
from .forest import Forest, Gone, Rows
from .going import Going
from .habit import HABITS
from .model import models_of
from .place import placed
from .scatter import SQUARE
from .standing import STANDING, Standing, individualise
from .wild import Felled, Seedling, Wild, seedlings

NOBODY = np.zeros((0, 2), np.float32)

Found = list[tuple[int, Tree, Pose]]

log = logging.getLogger("tallgrass")


class Trees(Feature):
    """The entities of one world that have a `Tree` and a `Pose`; those of the scene are made here."""

    own = ("tree_twigs", "tree_cards", "tree_far", "tree_met", "tree_air", "tree_mean")

    def __init__(self, world: World, grown: Grown, *, live: bool) -> None:
        self._world, self._grown, self._live = world, grown, live
        self._seedlings: list[Seedling] = []
        """The scene's own trees, as they are planted."""
        self.entities: list[int] = []
        """Of the scene's own trees, in the order in which they were planted; some may have been felled."""
        self.wild: Wild | None = None
        """Those of a forest that is too large for all of them to be entities."""
        self._seen: tuple[list[tuple[int, Tree]], list[tuple[int, Pose]]] = [], []
        self._heights = -1
        self._generation = world.check()
        self._unknown: set[str] = set()
        """Kinds of which it was said that the scene does not have them."""
        self._rows: Rows = np.zeros(0, STANDING)
        self.standing = self.shading = Standing(self._rows)
        """Those of this frame; and with those that were felled just now, what gives shade."""
        self._there: list[int] = []
        """The entities of the rows."""
        self._going = Going()
        self._shading_of: object = None
        self._plant()

    @classmethod
    def begin(cls, start: Start, /) -> Self:
        """Return those of a prairie's world, with its scene's planted."""
        return cls(start.world, start.grown, live=start.live)

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Go on with a scene read again: where its trees, its ground or its seed are others, all are planted anew."""
        del time
        self._grown = grown
        if _made_of(grown) != _made_of(before):
            for entity in self.entities:
                self._world.delete(entity)
            if self.wild is not None:
                self.wild.clear()
                self.wild.release()
            self._plant()

    def _plant(self) -> None:
        """Make an entity for each tree that the scene has, unless they are too many."""
        scene, terrain = self._grown.scene, self._grown.ground.terrain
        self._seedlings, self._heights, self.wild = [], -1, None
        self._rows, self._there = self._rows[:0], []  # none of them is felled
        self._going.forget()
        self._unknown.clear()
        fixed = list[Floats]()
        for name, kind in scene.trees.items():
            seed = scene.seed + len(fixed)
            place = placed(kind, terrain, np.concatenate([NOBODY, *fixed]), seed=seed)
            fixed.append(place)
            self._seedlings += _seedlings(name, kind, place, seed=seed)
        forest = Forest(self._grown, fixed)
        if forest.is_large:
            self.wild = Wild(self._world, forest, list(scene.trees), live=self._live)
        else:
            self._seedlings += seedlings(forest.all(), list(scene.trees))
        self.entities = [self._world.create(*each) for each in self._seedlings]

    def step(self, viewer: str, eye: Eye, /, *, time: float) -> None:
        """Look which trees stand where; one of a kind that the scene does not have is named once, and left out."""
        if self.wild is not None:
            self.wild.follow(viewer, eye)
        self.note(time)
        if self.wild is not None:
            self.standing = self.wild.standing(viewer, eye, self._rows)
        elif self.standing.rows is not self._rows:
            self.standing = Standing(self._rows)
        self._shade(self.standing)

    def note(self, time: float) -> None:
        """Take note of which trees stand where at a time [s], and how much grass grows below them."""
        self._revive()
        changes = self._grown.ground.terrain.changes.count
        with uncollected():
            seen = (trees := self._world.rows(Tree)), self._world.rows(Pose) if trees else []
            are_others = seen != self._seen
            self._seen = seen  # of equal lists the new ones: they are the same ones again in the next frame
        if are_others or changes != self._heights:
            self._heights = changes
            self._look(time)
        if self._going.step(time):
            self._shade_grass()

    def _revive(self) -> None:
        """Let the scene's trees that stood last be entities again after the game has cleared its world."""
        if self._generation == self._world.check():
            return
        self._generation = self._world.generation
        stood = {*self._there} if self._heights >= 0 else {*self.entities}
        self._rows, self._there = self._rows[:0], []  # none of them is felled
        for number in [number for number, entity in enumerate(self.entities) if entity in stood]:
            self._plant_again(number)

    def _shade(self, standing: Standing) -> None:
        """Let these give shade, and what is left of those that were felled."""
        if not len(self._going):
            self.shading = standing
        elif self._shading_of != (standing, self._going.changes):
            self._shading_of = standing, self._going.changes
            self.shading = Standing(np.concatenate([standing.rows, self._going.rows()]))

    def _look(self, time: float) -> None:
        """Take over which entities stand where."""
        posed = self._world.both(Tree, Pose)
        if len(self._seen[0]) > len(posed):  # some have no pose, or are another prairie's
            placed = {who for who, _, _ in posed}
            self._world.standing([(who, None) for who, _ in self._world.all(Tree) if who not in placed], "the tree")
        found = [each for each in posed if self._knows(each[1])]
        there = [*compress(found, self._world.standing([(who, pose) for who, _, pose in found], "the tree"))]
        self._let_go({entity for entity, _, _ in found}, time)
        self._rows, self._there = _rows(there, self._grown), [entity for entity, _, _ in there]
        self._shade_grass()

    def _let_go(self, there: set[int], time: float) -> None:
        """Let the shade of those that are gone go by and by, but of those that only a viewer's way takes away."""
        left = self.wild.left if self.wild is not None else set[int]()
        gone = [number for number, entity in enumerate(self._there) if entity not in there and entity not in left]
        left.clear()
        if gone:
            self._going.fell(self._rows[gone], time=time)

    def _shade_grass(self) -> None:
        """Let less grass grow below the trees that stand."""
        density = self._grown.ground.density
        changed = density.crowns.stand(_discs(np.concatenate([self._rows, self._going.rows()]), self._grown))
        if len(changed):
            density.sown.touch(_boxes(changed))

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

    @property
    def kinds(self) -> Mapping[str, TreeKind]:
        """Those that the scene has, by their names."""
        return self._grown.scene.trees

    def planted(self) -> set[int]:
        """Return the entities of the scene's own trees that are as they were planted."""
        self._revive()
        own = {entity for number, entity in enumerate(self.entities) if self._is_as_planted(number)}
        return own | (self.wild.entities if self.wild is not None else set())

    def felled(self) -> tuple[list[int], list[Felled], list[Place]]:
        """Return which trees of the scene's own are gone, or have become others, and where all of these stood.

        First those that have numbers, then those of a forest too large for that.
        """
        self._revive()
        own, (wild, stood) = self._changed(), ([], []) if self.wild is None else self.wild.felled()
        poses = [self._seedlings[number][1] for number in own]
        return own, wild, [*[(pose.x, pose.z) for pose in poses], *stood]

    def found_again(
        self, own: Sequence[int], wild: Sequence[Felled], stood: Sequence[Place] | None, /
    ) -> tuple[list[int], Gone]:
        """Return which trees those are that `felled` returned of this scene, or of one before it.

        Raises ValueError for any that the scene does not have.
        """
        if wild and self.wild is None:
            raise ValueError("it has felled trees of a larger forest")
        places = np.array([(pose.x, pose.z) for _, pose in self._seedlings]).reshape(-1, 2)
        numbers = found_again(own, None if stood is None else stood[: len(own)], places)
        rest = None if stood is None else stood[len(own) :]
        return numbers, {} if self.wild is None else self.wild.found_again(wild, rest)

    def _changed(self) -> list[int]:
        return [number for number in range(len(self.entities)) if not self._is_as_planted(number)]

    def _is_as_planted(self, number: int) -> bool:
        entity, find = self.entities[number], self._world.find
        return self._world.has(entity) and (find(entity, Tree), find(entity, Pose)) == self._seedlings[number]

    def fell(self, numbers: list[int], wild: Gone, kept: set[int], /) -> None:
        """Let these be gone of the scene's own, and all others stand where they were planted.

        Those that a game has made others stay where they are among the entities `kept`.
        """
        self._rows, self._there = self._rows[:0], []  # what a saved game has not is not felled now
        self._heights = -1  # look again, though the entities may be the same
        self._going.forget()
        if self.wild is not None:
            self.wild.fell(wild, kept)
        others, wanted = set(self._changed()), set(numbers)
        for number in wanted:
            entity = self.entities[number]
            if self._world.has(entity) and not (number in others and entity in kept):
                self._world.delete(entity)
        for number in others - wanted:
            self._plant_again(number)

    def _plant_again(self, number: int) -> None:
        entity, seedling = self.entities[number], self._seedlings[number]
        if self._world.has(entity):
            for part in seedling:
                self._world.add(entity, part)
        else:
            self.entities[number] = self._world.create(*seedling)

    def release(self) -> None:
        """Let nothing grow any more."""
        if self.wild is not None:
            self.wild.release()

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> TreePart:
        """Return what draws them."""
        return TreePart(ctx, block, units, lambda: self.standing, lambda: self.shading)


def _seedlings(name: str, kind: TreeKind, place: Floats, *, seed: int) -> list[Seedling]:
    """Return the single trees of a kind that stand at places (n, 2) [m]."""
    draw = np.random.default_rng((seed, 47))
    low, high = kind.height or HABITS[kind.habit].height
    heights = np.clip(draw.uniform(low, high, len(place)), LOWEST, HIGHEST).tolist()
    turns = draw.uniform(-np.pi, np.pi, len(place)).tolist()
    return [
        (Tree(name, height, kind.foliage), Pose(x, z, yaw))
        for (x, z), height, yaw in zip(place.tolist(), heights, turns, strict=True)
    ]


def _made_of(grown: Grown) -> tuple[object, ...]:
    kinds = {name: kind.uncoloured for name, kind in grown.scene.trees.items()}
    return list(kinds.items()), grown.scene.seed, grown.ground.terrain, grown.ground.density


def _boxes(discs: Doubles) -> Doubles:
    """Return corners (x, z) [m] between which discs (n, 4) lie, (m, 2, 2): those near to one another in one."""
    _, box = np.unique(np.floor(discs[:, :2] / SQUARE), axis=0, return_inverse=True)
    box, reach = box.reshape(-1), discs[:, 2:3]
    low, high = np.full((box.max() + 1, 2), np.inf), np.full((box.max() + 1, 2), -np.inf)
    np.minimum.at(low, box, discs[:, :2] - reach)
    np.maximum.at(high, box, discs[:, :2] + reach)
    return np.stack([low, high], axis=1)


def _discs(rows: NDArray[np.void], grown: Grown) -> Doubles:
    """Return how crowns and trunks of trees, records of `STANDING`, shade the grass, as `Crowns` has it."""
    discs, feet = np.zeros((2, len(rows), 4))
    for number, kind in enumerate(grown.scene.trees.values()):
        for which, model in enumerate(models_of(kind.habit, grown.scene.seed + number)):
            own = (rows["kind"] == number) & (rows["model"] == which)
            scale = rows["height"][own].astype(np.float64) / model.height
            far, leaves, foot = model.shade
            reach = np.maximum(scale * far, LEAST_SHADE)
            discs[own, :2], discs[own, 2] = rows["root"][own][:, ::2], reach
            discs[own, 3] = rows["foliage"][own] * leaves * (scale / reach) ** 2
            feet[own, :2], feet[own, 2] = discs[own, :2], FOOT
            feet[own, 3] = rows["foliage"][own] * np.minimum(foot * scale, FOOT_MEETS_MOST)
    discs = np.concatenate([discs, feet])
    return discs[discs[:, 3] > 0.0]


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
    individualise(rows)
    return rows
