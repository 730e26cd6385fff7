"""What packages bring: a state knows the entities again that they make while a prairie is made."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from itertools import chain

from ..components.wind import WindSource
from ..engine.world import World
from .saved import THINGS


class Brought:
    """The entities that each package has made while it added its systems, in their order."""

    def __init__(self, world: World) -> None:
        self._world, self._generation = world, world.generation
        self._entities: dict[str, list[int]] = {}

    @contextmanager
    def by(self, name: str, /) -> Iterator[None]:
        """Note what the package that brings the system of this name makes inside."""
        before = self._there()
        yield
        made = self._there() - before
        if made:
            self._entities[name] = sorted(made)

    def entities(self) -> dict[str, list[int]]:
        """Return the entities by the names of systems; none once the game has cleared its world."""
        return self._entities if self._world.check() == self._generation else {}

    def same(self, saved: Mapping[str, list[int]], /) -> dict[int, int]:
        """Return the present entity of each entity in a state that the same package had made.

        It is 0 for one that another had made, if it happens to have the number of a package's present entity.
        """
        now = self.entities()
        taken = {entity: 0 for entities in now.values() for entity in entities}
        pairs = (zip(saved.get(name, ()), entities, strict=False) for name, entities in now.items())
        return taken | dict(chain.from_iterable(pairs))

    def resume(self, saved: Mapping[str, list[int]], entities: Mapping[int, int], /) -> None:
        """Take over a state's entities; `entities` has the present one of each that it holds."""
        same, now = self.same(saved), dict(self.entities())
        for name, then in saved.items():
            now[name] = [entities.get(each, same.get(each, 0)) for each in then] + now.get(name, [])[len(then) :]
        self._entities, self._generation = now, self._world.check()

    def _there(self) -> set[int]:
        every = (entity for kind in (*THINGS, WindSource) for entity, _ in self._world.all(kind))
        return {entity for entity in every if entity not in self._world}
