"""The winds of a prairie: whose entities they are, where they are now, and what grass feels of them."""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..components.pose import Pose
from ..components.wind import WindPrimitive, WindSource
from ..engine.terrain.sample import height_at
from ..engine.world import World
from .field import Field, densest_kind
from .fly import jet
from .wind.blast import Blast
from .wind.blow import Blowing, Listeners, blowing, hear, places_alone
from .wind.grass import grass_of
from .wind.quarantine import Quarantine

Floats = NDArray[np.float32]


class Winds:
    """The winds in one world; those that a scene declares, those that a game adds, and a game's own entities."""

    def __init__(self, world: World, field: Field) -> None:
        self._world = world
        self._field = field
        self._height_at = partial(height_at, field.terrain)
        self.quarantine = Quarantine()
        for number, primitive in enumerate(field.scene.wind):
            self.add(primitive, f"wind[{number}] {primitive.kind}")

    def add(self, primitive: WindPrimitive, name: str, pose: Pose | None = None) -> int:
        """Add a wind and return its entity."""
        return self._world.create(WindSource(primitive, name), *([pose] if pose else []))

    def sources(self) -> list[WindSource]:
        """Return the winds there are."""
        return [source for _, source in self._world.all(WindSource)]

    def now(self, time: float) -> list[Blowing]:
        """Return the winds that act at `time` [s], the strongest claim first.

        A wind whose entity has a `Pose` is there; the blast of a body is where its jet meets the ground; the others
        are where they say themselves.
        """
        found = self._world.all(WindSource)
        placed = dict(self._world.all(Pose))
        poses = {source: placed[entity] for entity, source in found if entity in placed}
        for _, source in found:
            if isinstance(source.primitive, Blast) and source.primitive.body and source not in poses:
                poses[source] = jet(source.primitive, self._height_at, time=time)
        sources = [source for _, source in found]
        return blowing(sources, self.quarantine, time=time, seed=self._field.scene.seed, poses=poses)

    def heard(self, listeners: Listeners, /, *, time: float) -> Floats:
        """Return the message that each listener ends up with at `time` [s], shape (n, 2)."""
        seed, mixing = self._field.scene.seed, self._field.scene.mixing
        return hear(self.now(time), listeners, self.quarantine, time=time, seed=seed, mixing=mixing)

    def at(self, place: Floats, /, *, time: float, kind: int | None = None) -> Floats:
        """Return what grass of a kind, or the densest there, feels at ground positions (n, 2) [m], shape (n, 2)."""
        field = self._field
        kinds = densest_kind(field, place) if kind is None else np.full(len(place), kind, np.intp)
        return self.heard(places_alone(place, grass_of(field.growths, kinds)), time=time)
