"""The built-in systems of a prairie, each made from its inputs."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ..engine.schedule import HasRun, Phase, Schedule
from .around.outlook import Outlook, Outlooks
from .blow import Blow, Hear, WindsAt
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
from .room import get_ready
from .screen import Screen
from .see import See
from .site import Site
from .tile import Tile
from .transition import Transition
from .winds import Winds

BuiltIn = tuple[Phase, str, HasRun]


@dataclass(frozen=True, slots=True)
class Assembly:
    """Inputs of a prairie's systems that do not depend on its site."""

    viewers: Outlooks
    winds: Winds
    pressers: Pressers
    screen: Screen
    governor: Governor
    entities: Callable[[Site], PatchEntities]
    """Returns the keeper of patch entities on a site."""

    hear: Hear
    """Returns the messages of winds and pressers to receivers."""

    def on(self, site: Site, /) -> list[BuiltIn]:
        """Return the built-in systems on a site in running order."""
        return built_in(
            site,
            self.viewers,
            self.entities(site),
            now=self.winds.acting,
            hear=self.hear,
            note=self.pressers.note,
            painter=self.screen.current,
            governor=self.governor,
            bent=self.winds.bent,
        )

    def stage(self, site: Site, before: Site, /) -> bool:
        """Upload a piece of another site, or prepare one viewer's pools for it; return whether all of it is there."""
        if not self.screen.stage(site):
            return False
        ready = (get_ready(outlook, site.representations, before.representations) for outlook in self.viewers.values())
        return all(ready)  # stops at the first viewer that was not ready


def built_in(
    site: Site,
    outlooks: Iterable[Outlook],
    entities: PatchEntities,
    /,
    *,
    now: WindsAt,
    hear: Hear,
    painter: Callable[[], Painter],
    governor: Governor,
    note: Callable[[float], Trodden] = lambda _: UNTRODDEN,
    bent: Callable[[float], float] = lambda _: 0.0,
) -> list[BuiltIn]:
    """Return the built-in systems on a site in running order: phase, name, and the system itself."""
    ground, shown, reach = site.ground, site.representations, site.reach
    patch, change = ground.patch, site.transitions

    return [
        (Phase.TILE, "press", Press(outlooks, note)),
        (
            Phase.TILE,
            "tile",
            Tile(
                outlooks, entities, ground, site.scene.seed, site.quality.models,
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


def replace_built_in(schedule: Schedule, built: list[BuiltIn], before: list[BuiltIn], /) -> None:
    """Replace the built-in systems `before`, except those that a game has itself replaced or removed."""
    for (_, name, system), (_, _, old) in zip(built, before, strict=True):
        if name in schedule and schedule[name].run == old.run:
            schedule.replace(name, system, trusted=True)
