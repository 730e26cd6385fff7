"""The systems that a prairie comes with, each made from what it needs."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from ..components.arrays import Floats, Rows
from ..engine.schedule import HasRun, Phase, Schedule
from ..engine.world import World
from .around.clearing import Clearings
from .around.outlook import Outlook, Outlooks
from .blow import Blow, Hear, Now
from .cull import Cull
from .draw import Draw
from .entities import PatchEntities
from .gather import Gather
from .govern import Governor
from .lod import SLACK, ChooseLevels
from .painter import Painter
from .plant import Plant
from .press.marks import UNTRODDEN, Trodden
from .pressers import Press, Pressers
from .screen import Screen
from .see import See
from .site import Site
from .space.window import cell_of
from .tile import Tile
from .transition import Transition
from .wind.blow import ReceiverArrays
from .winds import Winds

BuiltIn = tuple[Phase, str, HasRun]


@dataclass(frozen=True, slots=True)
class Assembly:
    """What the systems of a prairie share, whatever its site."""

    world: World
    viewers: Outlooks
    clearings: Clearings
    winds: Winds
    pressers: Pressers
    screen: Screen
    governor: Governor

    def entities(self, site: Site, /) -> PatchEntities:
        """Return what keeps the entities of patches on a site."""
        return PatchEntities(self.world, self.clearings, site.representations, self.viewers.values)

    def felt(self, receivers: ReceiverArrays, /, *, time: float) -> Floats:
        """Return what receivers feel at `time` [s] of the winds and of those who walk there, shape (n, 2)."""
        return self.pressers.over(self.winds.heard(receivers, time=time), receivers)

    def felt_at(self, place: Floats, kind: int | None, /, *, time: float) -> Floats:
        """Return what grass of a kind, or of the densest, feels at places (n, 2) [m] once all have come, (n, 2)."""
        self.pressers.note(time)
        return self.felt(self.winds.standing(place, kind=kind), time=time)

    def patch_at(self, site: Site, place: Floats, viewer: str, /) -> Rows:
        """Return the entity of the patch at each place (n, 2) [m] that a viewer has there, or 0, shape (n,)."""
        cells = cell_of(place, patch=site.ground.patch)
        if viewer not in self.viewers:
            return np.zeros(len(cells), np.int64)
        return self.entities(site).at(self.viewers[viewer], cells)

    def on(self, site: Site, /) -> list[BuiltIn]:
        """Return the systems of a site in running order."""
        return built_in(
            site,
            self.viewers,
            self.entities(site),
            now=self.winds.now,
            hear=self.felt,
            note=self.pressers.note,
            painter=self.screen.current,
            governor=self.governor,
            bent=self.winds.bent,
        )


def built_in(
    site: Site,
    outlooks: Iterable[Outlook],
    entities: PatchEntities,
    /,
    *,
    now: Now,
    hear: Hear,
    painter: Callable[[], Painter],
    governor: Governor,
    note: Callable[[float], Trodden] = lambda _: UNTRODDEN,
    bent: Callable[[float], float] = lambda _: 0.0,
) -> list[BuiltIn]:
    """Return the systems of a site in running order: phase, name, and the system itself."""
    ground, shown, reach = site.ground, site.representations, site.reach
    patch, change = ground.patch, site.transitions

    return [
        (Phase.TILE, "press", Press(outlooks, note)),
        (
            Phase.TILE,
            "tile",
            Tile(
                outlooks, entities, ground.terrain, patch, site.scene.seed,
                site.quality.models,
            ),
        ),
        (Phase.SEE, "cull", Cull(outlooks, patch, site.sway)),
        (Phase.SEE, "lod", ChooseLevels(outlooks, reach, site.choosy, SLACK if change.hysteresis else 0, bent)),
        (Phase.SEE, "transition", Transition(outlooks, shown, reach, patch, change)),
        (Phase.SEE, "see", See(outlooks, shown, reach, patch, change, site.choosy)),
        (Phase.BLOW, "plant", Plant(outlooks, shown, entities.world)),
        (Phase.BLOW, "wind", Blow(outlooks, now, hear, site.growths)),
        (Phase.DRAW, "gather", Gather(outlooks, painter)),
        (Phase.DRAW, "draw", Draw(outlooks, painter, governor)),
    ]  # fmt: skip


def settle_in(schedule: Schedule, built: list[BuiltIn], before: list[BuiltIn], /) -> None:
    """Let built-in systems run in place of those `before` them; what a game has replaced or removed stays so."""
    for (_, name, system), (_, _, old) in zip(built, before, strict=True):
        if name in schedule and schedule[name].run == old.run:
            schedule.replace(name, system, trusted=True)
