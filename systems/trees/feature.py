"""The trees of a prairie: their entities, and which of them stand."""

import logging
from collections.abc import Mapping, Sequence
from functools import partial
from itertools import compress

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Floats, Place, Point
from ...components.pose import Pose
from ...components.tree import HIGHEST, LOWEST, Tree
from ...engine.declared.tree import TreeKind
from ...engine.terrain.sample import height_at
from ...engine.world import uncollected
from ..frame.block import FrameBlock
from ..frame.feature import Feature, Start
from ..space.grown import Grown
from .crown import FOOT, FOOT_MEETS_MOST, LEAST_SHADE
from .draw import TreePart
from .fading import FadingShade
from .felled import found_again
from .forest import Forest, Gone, Rows
from .habit import HABITS
from .model import MODELS, models_of
from .place import placed
from .scatter import SQUARE
from .standing import STANDING, Standing, individualise
from .tree_rows import Posed, TreeRows
from .wild import Felled, Seedling, Wild, seedlings

NO_PLACES = np.zeros((0, 2), np.float32)

log = logging.getLogger("tallgrass")


class Trees(Feature):
    """The entities of one world with a `Tree` and a `Pose`; makes those of the scene."""

    own = ("tree_twigs", "tree_cards", "tree_far", "tree_depths", "tree_air", "tree_mean")

    def __init__(self, start: Start, /) -> None:
        self._world, self._grown, self._live = start.world, start.grown, start.live
        self._seedlings: list[Seedling] = []
        """The scene's single trees, as planted."""
        self.entities: list[int] = []
        """Entities of these trees, in the same order; some may have been felled."""
        self.wild: Wild | None = None
        """The trees of a forest that is too large for all of them to be entities."""
        self._world_changes = -1
        self._last_seen: tuple[list[tuple[int, Tree]], list[Pose | None]] = [], []
        self._terrain_version = -1
        self._generation = start.world.check()
        self._unknown: set[str] = set()
        """Kinds without a declaration that were already reported."""
        self._taken = TreeRows()
        self.standing = self.shading = Standing(self._taken.rows)
        """Trees of this frame; `shading` has those felled just now, too, as their shade fades."""
        self._fading = FadingShade()
        self._shading_of: object = None
        self._plant()

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Go on with a scene read again: replant all if its trees, ground or seed have changed."""
        self._grown = grown
        if _planting_inputs(grown) != _planting_inputs(before):
            for entity in self.entities:
                self._world.delete(entity)
            if self.wild is not None:
                self.wild.clear()
                self.wild.release()
            self._plant()

    def _plant(self) -> None:
        """Make an entity of each tree of the scene, unless they are too many."""
        scene, terrain = self._grown.scene, self._grown.ground.terrain
        self._seedlings, self._terrain_version, self.wild = [], -1, None
        self._taken.forget()  # none counts as felled
        self._fading.forget()
        self._unknown.clear()
        fixed = list[Floats]()
        for name, kind in scene.trees.items():
            seed = scene.seed + len(fixed)
            place = placed(kind, terrain, np.concatenate([NO_PLACES, *fixed]), seed=seed)
            fixed.append(place)
            self._seedlings += _seedlings(name, kind, place, seed=seed)
        forest = Forest(self._grown, fixed)
        if forest.is_large:
            self.wild = Wild(self._world, forest, list(scene.trees), live=self._live)
        else:
            self._seedlings += seedlings(forest.all(), list(scene.trees))
        self.entities = [self._world.create(*each) for each in self._seedlings]

    def step(self, viewer: str, eye: Point, /, *, time: float) -> None:
        """Find which trees stand where; a tree of an undeclared kind is reported once and left out."""
        if self.wild is not None:
            self.wild.follow(viewer, eye)
        self.note(time)
        if self.wild is not None:
            self.standing = self.wild.standing(viewer, eye, self._taken.rows)
        elif self.standing.rows is not self._taken.rows:
            self.standing = Standing(self._taken.rows)
        self._update_shading(self.standing)

    def note(self, time: float) -> None:
        """Take over changed trees at a time [s], and the grass density below them."""
        self._revive()
        changes = self._grown.ground.terrain.changes.count
        if changes != self._terrain_version:
            self._taken.make_all_anew()  # at other heights
        is_new = self._have_changed() or changes != self._terrain_version
        if is_new:
            self._terrain_version = changes
            with uncollected():
                self._update_rows(time)
        if self._fading.step(time) or is_new:
            self._shade_grass()

    def _have_changed(self) -> bool:
        """Return whether trees or their poses have changed since the last call."""
        if self._world_changes == (changes := self._world.changes()):
            return False
        self._world_changes, before = changes, self._last_seen
        with uncollected():
            trees = self._world.rows(Tree)
            self._last_seen = trees, self._world.beside(trees, Pose)
            return self._last_seen != before

    def _revive(self) -> None:
        """Make the scene's standing trees entities again after the game has cleared its world."""
        if self._generation == self._world.check():
            return
        self._generation = self._world.generation
        stood = {*self._taken.entities.tolist()} if self._terrain_version >= 0 else {*self.entities}
        self._taken.forget()  # none counts as felled
        for number in [number for number, entity in enumerate(self.entities) if entity in stood]:
            self._replant(number)

    def _update_shading(self, standing: Standing) -> None:
        """Let standing trees give shade, and felled ones what is left of theirs."""
        if not len(self._fading):
            self.shading = standing
        elif self._shading_of != (standing, self._fading.version):
            self._shading_of = standing, self._fading.version
            self.shading = Standing(np.concatenate([standing.rows, self._fading.rows()]))

    def _update_rows(self, time: float) -> None:
        """Take over which entities stand where."""
        other, kept = self._taken.changed(*self._last_seen)
        own = self._world.own(other)
        self._world.standing([(entity, None) for entity, _, pose in own if pose is None], "the tree")
        found = [(entity, tree, pose) for entity, tree, pose in own if pose is not None and self._knows(tree)]
        there = [*compress(found, self._world.standing([(entity, pose) for entity, _, pose in found], "the tree"))]
        self._fade_removed(self._taken.gone(kept, {entity for entity, _, _ in found}), time)
        self._taken.take(kept, there, partial(_rows, self._grown))

    def _fade_removed(self, gone: list[int], time: float) -> None:
        """Begin to fade the shade of removed trees, but not of those removed as a viewer went away."""
        departed = self.wild.departed if self.wild is not None else set[int]()
        gone = [row for row in gone if self._taken.entities[row] not in departed]
        departed.clear()
        if gone:
            self._fading.fell(self._taken.rows[gone], time=time)

    def _shade_grass(self) -> None:
        """Lower the grass density below the trees that stand."""
        density = self._grown.ground.density
        changed = density.crowns.stand(*(_discs(rows, self._grown) for rows in (self._taken.rows, self._fading.rows())))
        if len(changed):
            density.sown.touch(_boxes(changed))

    def _knows(self, tree: Tree) -> bool:
        """Return whether the scene declares a tree's kind; report once if not."""
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
        """Kinds of trees of the scene, by name."""
        return self._grown.scene.trees

    def planted(self) -> set[int]:
        """Return the entities of the scene's trees that are unchanged since they were planted."""
        self._revive()
        own = {entity for number, entity in enumerate(self.entities) if self._is_as_planted(number)}
        return own | (self.wild.entities if self.wild is not None else set())

    def felled(self) -> tuple[list[int], list[Felled], list[Place]]:
        """Return the scene's trees that are gone or changed, and where all of them stood.

        First the numbers of single trees, then those of a large forest.
        """
        self._revive()
        own, (wild, stood) = self._changed_numbers(), ([], []) if self.wild is None else self.wild.felled()
        poses = [self._seedlings[number][1] for number in own]
        return own, wild, [*[(pose.x, pose.z) for pose in poses], *stood]

    def found_again(
        self, own: Sequence[int], wild: Sequence[Felled], stood: Sequence[Place], /
    ) -> tuple[list[int], Gone, list[Place]]:
        """Return the trees of this scene that `felled` returned of it, or of an earlier scene.

        Last come the places of those that stand nowhere here.
        """
        places = np.array([(pose.x, pose.z) for _, pose in self._seedlings]).reshape(-1, 2)
        own_stood, wild_stood = stood[: len(own)], stood[len(own) :]
        numbers = found_again(own, own_stood, places)
        gone, missing = ({}, [*wild_stood]) if self.wild is None else self.wild.found_again(wild, wild_stood)
        nowhere = [place for place, number in zip(own_stood, numbers, strict=True) if number is None]
        return [number for number in numbers if number is not None], gone, [*nowhere, *missing]

    def _changed_numbers(self) -> list[int]:
        return [number for number in range(len(self.entities)) if not self._is_as_planted(number)]

    def _is_as_planted(self, number: int) -> bool:
        entity, find = self.entities[number], self._world.find
        return self._world.has(entity) and (find(entity, Tree), find(entity, Pose)) == self._seedlings[number]

    def fell(self, numbers: list[int], wild: Gone, kept: set[int], /) -> None:
        """Remove these trees of the scene, and restore all others to where they were planted.

        Trees that a game has changed stay if they are among the entities `kept`.
        """
        self._taken.forget()  # trees missing in a saved game do not fade
        self._terrain_version = -1  # forces an update, though entities may be unchanged
        self._fading.forget()
        if self.wild is not None:
            self.wild.fell(wild, kept)
        others, wanted = set(self._changed_numbers()), set(numbers)
        for number in wanted:
            entity = self.entities[number]
            if self._world.has(entity) and not (number in others and entity in kept):
                self._world.delete(entity)
        for number in others - wanted:
            self._replant(number)

    def _replant(self, number: int) -> None:
        entity, seedling = self.entities[number], self._seedlings[number]
        if self._world.has(entity):
            for part in seedling:
                self._world.add(entity, part)
        else:
            self.entities[number] = self._world.create(*seedling)

    def release(self) -> None:
        """Stop the growing thread."""
        if self.wild is not None:
            self.wild.release()

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> TreePart:
        """Return the part that draws them in a GL context."""
        return TreePart(ctx, block, units, lambda: self.standing, lambda: self.shading, live=self._live)


def _seedlings(name: str, kind: TreeKind, place: Floats, *, seed: int) -> list[Seedling]:
    """Return the single trees of a kind at places (n, 2) [m]."""
    draw = np.random.default_rng((seed, 47))
    low, high = kind.height or HABITS[kind.habit].height
    heights = np.clip(draw.uniform(low, high, len(place)), LOWEST, HIGHEST).tolist()
    turns = draw.uniform(-np.pi, np.pi, len(place)).tolist()
    return [
        (Tree(name, height, kind.foliage), Pose(x, z, yaw))
        for (x, z), height, yaw in zip(place.tolist(), heights, turns, strict=True)
    ]


def _planting_inputs(grown: Grown) -> tuple[object, ...]:
    kinds = {name: kind.uncoloured for name, kind in grown.scene.trees.items()}
    return list(kinds.items()), grown.scene.seed, grown.ground.terrain, grown.ground.density


def _boxes(discs: Doubles) -> Doubles:
    """Return bounding boxes of discs (n, 4), each of one square of the ground: corners (x, z) [m], shape (m, 2, 2)."""
    _, box = np.unique(np.floor(discs[:, :2] / SQUARE), axis=0, return_inverse=True)
    box, reach = box.reshape(-1), discs[:, 2:3]
    low, high = np.full((box.max() + 1, 2), np.inf), np.full((box.max() + 1, 2), -np.inf)
    np.minimum.at(low, box, discs[:, :2] - reach)
    np.maximum.at(high, box, discs[:, :2] + reach)
    return np.stack([low, high], axis=1)


def _discs(rows: NDArray[np.void], grown: Grown) -> Doubles:
    """Return the discs by which crowns and trunks of records of `STANDING` shade the grass, as `Crowns` has them."""
    kinds = [models_of(kind.habit, grown.scene.seed + n) for n, kind in enumerate(grown.scene.trees.values())]
    numbers = np.array([(model.height, *model.shade) for models in kinds for model in models]).reshape(-1, 4)
    height, far, leaves, foot = numbers[rows["kind"] * MODELS + rows["model"]].T
    scale, foliage = rows["height"] / height, rows["foliage"]
    reach = np.maximum(scale * far, LEAST_SHADE)
    each = np.empty((len(rows), 2, 4))
    each[..., :2] = rows["root"][:, None, ::2]
    each[:, 0, 2], each[:, 0, 3] = reach, foliage * leaves * (scale / reach) ** 2
    each[:, 1, 2], each[:, 1, 3] = FOOT, foliage * np.minimum(foot * scale, FOOT_MEETS_MOST)
    return each[each[..., 3] > 0.0]


def _rows(grown: Grown, found: Posed) -> Rows:
    """Return entities as records of `STANDING`."""
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
