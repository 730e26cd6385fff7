"""Saving and restoring the changes that a game has made to a prairie."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ..components.arrays import Bytes, Floats, Ints
from ..components.patch import Clearings
from ..components.pose import Pose
from ..components.presser import Presser
from ..components.tree import Tree
from ..components.wind import WindPrimitive, WindSource
from ..engine.declared.scene import Reading
from ..engine.handed import is_somewhere, must_be_a, must_be_flags, to_microseconds
from ..engine.plugins import wind_kinds
from ..engine.scene import LoadedScene
from ..engine.stored import refuse, unfit
from ..engine.terrain.change import Squares, changed_lies, changed_squares, restore_squares
from ..engine.world import World
from .brought import Brought
from .examine import ground_of, mown_of, must_be_trodden, sown_of
from .fitting import lie_of, must_be_of, scene_of
from .light.shining import Shining
from .mow.mown import Mown
from .pressers import Pressers
from .refit import felled_in_words, refit, without_unknown_winds
from .saved import THINGS, SavedThing, SavedWind, State, packed, unpacked
from .seasons import Kinds, Seasons
from .site import Site
from .space.ground import Ground
from .stowed import saved_wind, wind_of, wind_on_course
from .trees.feature import Trees
from .trees.forest import Gone
from .winds import Winds

log = logging.getLogger("tallgrass")

Felled = tuple[list[int], Gone]
"""Numbers of a scene's felled trees, and those of a large forest."""


@dataclass(slots=True, eq=False)
class Saving:
    """Everything of a prairie that is saved, except its time."""

    world: World
    winds: Winds
    pressers: Pressers
    mown: Mown
    clearings: Clearings
    shining: Shining
    trees: Trees
    seasons: Seasons
    brought: Brought
    _samples: tuple[Ground, Floats] | None = None
    """The ground sampled last, and its samples, which take a while."""
    _became: tuple[object, Mapping[int, int]] | None = None
    """The state restored last, and the present entity of each entity in it."""

    def state(self, site: Site, /, *, time: float) -> bytes:
        """Return a game's changes until `time` [s]. Raises ValueError for a wind whose class is not registered."""
        self.winds.sources()
        light, since = self.shining.asked
        own = {*self.winds.declared, *self.winds.added}
        felled, wild_felled, stood = self.trees.felled()
        (mown, mown_heights), (sown, sown_densities) = self.mown.plots.saved(), site.ground.density.sown.saved()
        ground, ground_heights, ground_holes = changed_squares(site.ground.terrain)
        return packed(
            State(
                scene=scene_of(site),
                lie=self._samples_of(site.ground),
                time=time,
                light=light,
                light_since=since,
                light_way=self.shining.way,
                declared=self._winds(self.winds.declared),
                added=[*filter(None, self._winds(self.winds.added))],
                winds=[*filter(None, self._winds([each for each, _ in self.world.all(WindSource) if each not in own]))],
                things=[*self._things()],
                brought=self.brought.entities(),
                treading=self.pressers.treading(),
                felled=felled,
                wild_felled=wild_felled,
                stood=stood,
                seasons=self.seasons.saved(),
                cleared=np.array(sorted(self.clearings.cells), np.int32).reshape(-1, 2),
                mown=mown,
                mown_heights=mown_heights,
                sown=sown,
                sown_densities=sown_densities,
                ground=ground,
                ground_heights=ground_heights,
                ground_holes=ground_holes,
                ground_lies=changed_lies(site.ground.terrain),
            )
        )

    def restore(
        self, data: object, site: Site, loaded: LoadedScene, there: Mapping[int, int] | None, /, *, partly: bool
    ) -> tuple[float, dict[int, int], Kinds]:
        """Restore a state except for its kinds of grass; return its time [s], a mapping of entities, and these kinds.

        The mapping gives the present entity of each of the game's entities in the state; `there` are those that exist
        already. Raises what `unpacked` raises, TypeError if `there` is no mapping or `partly` no bool, and ValueError
        for a state of another scene or with anything that has no place in this one; then nothing has changed. If
        `partly`, such things are left out, and logged.
        """
        must_be_flags(partly=partly)
        existing = {} if there is None else there
        must_be_a(Mapping, existing, "entities are a mapping, of those in the state to yours")
        reading = Reading(wind=wind_kinds().find, folder=loaded.folder)
        state, felled, lost = self._fitted(unpacked(data), site, reading, partly=partly)
        winds = [*filter(None, state.declared), *state.added, *state.winds]
        made = _Made(
            {wind.entity: WindSource(wind_of(wind.kind, wind.values, reading), wind.name) for wind in winds},
            {wind.entity: wind_on_course(wind, reading) for wind in winds if wind.course is not None},
            mown_of(state, self.mown.plots),
            sown_of(state, site.ground.density, loaded),
            ground_of(state, site.ground.terrain),
            self.seasons.read(state.seasons),
            felled,
        )
        self.winds.sources()  # raises where another esper world is current
        restore_squares(site.ground.terrain, made.ground, state.ground_lies)
        self.mown.plots.resume(*made.mown)
        site.ground.density.sown.resume(*made.sown)
        last, became = self._became or (None, {})
        known = {**self.brought.same(state.brought), **(became if last == data else {}), **existing}
        entities = self._restore_entities(state, made, known)
        self._became = data, entities
        self.brought.resume(state.brought, entities)
        if lost:
            log.warning("a state was restored without what has no place in this scene: %s", ", ".join(lost))
        return state.time, dict(entities), made.kinds

    def _things(self) -> Iterator[SavedThing]:
        """Yield the other components of a game's entities, except those at a pose that is not finite."""
        own, planted = {entity for entity, _, _ in self.pressers.games()}, self.trees.planted()
        for component_class in THINGS:
            for entity, component in self.world.all(component_class):
                pose = self.world.find(entity, Pose)
                is_own = entity not in planted and (component_class is not Presser or entity in own)
                if is_own and (pose is None or is_somewhere(pose)):
                    yield SavedThing(entity=entity, component=component, pose=pose)

    def _fitted(self, state: State, site: Site, reading: Reading, *, partly: bool) -> tuple[State, Felled, list[str]]:
        """Return a state fitted to a site, the trees of the scene that are felled in it, and what has no place there.

        Raises ValueError for a state of another scene or with anything that has no place, unless `partly`.
        """
        if len(state.declared) != len(state.scene.wind):
            refuse("it does not have a kind for each of its scene's winds")
        if len(state.stood) != len(state.felled) + len(state.wild_felled):
            refuse("it does not have a place for each felled tree")
        lie, unknown = self._samples_of(site.ground), list[str]()
        if partly:
            state, unknown = without_unknown_winds(state, reading)
        else:
            must_be_of(state, site, lie)
        must_be_trodden(state.treading)
        state, lost = refit(state, site, lie, reading, self.pressers)
        numbers, wild, missing = self.trees.found_again(state.felled, state.wild_felled, state.stood)
        lost = [*unknown, *lost, *felled_in_words(missing)]
        if lost and not partly:
            unfit(f"it has no place for {', '.join(lost)}")
        return state, (numbers, wild), lost

    def _samples_of(self, ground: Ground) -> Floats:
        """Return a ground's `lie_of`, computed once."""
        if self._samples is None or self._samples[0] is not ground:
            self._samples = ground, lie_of(ground)
        return self._samples[1]

    def _restore_entities(self, state: State, made: "_Made", became: Mapping[int, int]) -> dict[int, int]:
        """Restore everything that has entities, and clearings and light; return the present entities of a game's own.

        `became` maps entities of the state to those that they may be now.
        """
        time = to_microseconds(state.time)
        self.winds.set_clock(time)
        entities = self._restore_winds(state, made, became)
        trees = {each.entity for each in state.things if isinstance(each.component, Tree)}
        self.trees.fell(*made.felled, trees)
        self._restore_things(state.things, entities, became)
        self.pressers.resume(state.treading, entities)
        self.clearings.resume([(i, j) for i, j in state.cleared.tolist()])
        self.shining.resume(state.light, since=state.light_since, time=time, way=state.light_way)
        return entities

    def _restore_things(
        self, saved: Sequence[SavedThing], entities: dict[int, int], became: Mapping[int, int]
    ) -> None:  # fmt: skip
        """Restore the components of a game's entities, and add these to `entities`; remove trees planted since."""
        there = {(each.entity, type(each.component)) for each in self._things()}
        for each in saved:
            known = became.get(each.entity, each.entity)
            entity = entities.get(each.entity, known if (known, type(each.component)) in there else None)
            parts = each.component, *([] if each.pose is None else [each.pose])
            if entity is None:
                entity = self.world.give(*parts)
            else:
                for part in parts:
                    self.world.add(entity, part)
            entities[each.entity] = entity
        stay, kinds = {entities[each.entity] for each in saved if isinstance(each.component, Tree)}, self.trees.kinds
        for each in [*self._things()]:
            if isinstance(each.component, Tree) and each.entity not in stay and each.component.kind in kinds:
                self.world.uproot(each.entity, Tree)

    def _restore_winds(self, state: State, made: "_Made", became: Mapping[int, int]) -> dict[int, int]:
        """Restore declared winds, added winds and a game's own; return the present entities of the last two."""
        existing, sources = dict(self.world.all(WindSource)), made.sources
        declared, added = self.winds.declared, self.winds.added
        declared_now = list[int]()
        for wind, entity in zip(state.declared, declared, strict=True):
            exists = entity in existing
            if wind is not None:
                declared_now.append(self._give_wind(wind, sources, entity if exists else None))
                continue
            declared_now.append(entity)
            if exists:
                self.world.delete(entity)
        for entity in set(added) - {wind.entity for wind in state.added}:
            self.world.delete(entity)
        entities = dict[int, int]()
        for wind in state.added:
            entities[wind.entity] = self._give_wind(wind, sources, wind.entity if wind.entity in added else None)
        added_now, not_own = list(entities.values()), {*declared, *added}
        for wind in state.winds:
            entity = became.get(wind.entity, wind.entity)
            exists = entity in existing and entity not in not_own
            entities[wind.entity] = self._give_wind(wind, sources, entity if exists else self.world.give())
        pairs = zip(state.declared, declared_now, strict=True)
        now = entities | {wind.entity: entity for wind, entity in pairs if wind}
        self.winds.resume(declared_now, added_now, {now[entity]: wind for entity, wind in made.runs.items()})
        return entities

    def _give_wind(self, wind: SavedWind, sources: Mapping[int, WindSource], entity: int | None) -> int:
        """Give an entity, or else a new one, a wind as it was saved; return the entity."""
        source = sources[wind.entity]
        entity = self.world.create(source) if entity is None else entity
        self.world.add(entity, source)
        if wind.pose is None:
            self.world.drop(entity, Pose)
        else:
            self.world.add(entity, wind.pose)
        return entity

    def _winds(self, entities: Sequence[int]) -> list[SavedWind | None]:
        """Return some winds as they are saved; None for one that is gone, or whose pose is not finite."""
        there, runs = dict(self.world.all(WindSource)), self.winds.runs()
        return [
            saved_wind(each, there[each], self.world.find(each, Pose), runs.get(each)) if each in there else None
            for each in entities
        ]


@dataclass(frozen=True, slots=True, eq=False)
class _Made:
    """Everything made from a state, before anything is changed."""

    sources: Mapping[int, WindSource]
    """Winds, by their entities in the state."""

    runs: Mapping[int, WindPrimitive]
    """Winds with a course of their phases, by their entities in the state."""

    mown: tuple[Ints, Floats]
    sown: tuple[Ints, Bytes]
    ground: Squares
    kinds: Kinds
    felled: Felled
