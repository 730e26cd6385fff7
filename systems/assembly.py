"""The systems that a prairie comes with, each made from what it needs."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ..engine.schedule import HasRun, Phase, Schedule
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
from .room import is_ready
from .screen import Screen
from .see import See
from .site import Site
from .tile import Tile
from .transition import Transition
from .winds import Winds

BuiltIn = tuple[Phase, str, HasRun]


@dataclass(frozen=True, slots=True)
class Assembly:
    """What the systems of a prairie share, whatever its site."""

    viewers: Outlooks
    winds: Winds
    pressers: Pressers
    screen: Screen
    governor: Governor
    entities: Callable[[Site], PatchEntities]
    """Gives what keeps the entities of patches on a site."""

    hear: Hear
    """Gives what receivers feel of the winds and of those who walk there."""

    def on(self, site: Site, /) -> list[BuiltIn]:
        """Return the systems of a site in running order."""
        return built_in(
            site,
            self.viewers,
            self.entities(site),
            now=self.winds.now,
            hear=self.hear,
            note=self.pressers.note,
            painter=self.screen.current,
            governor=self.governor,
            bent=self.winds.bent,
        )

    def stage(self, site: Site, before: Site, /) -> bool:
        """Bring a piece of another site into GL, or make a viewer's store ready for it; return whether all is."""
        if not self.screen.stage(site):
            return False
        ready = (is_ready(each, site.representations, before.representations) for each in self.viewers.values())
        return all(ready)  # it ends with the first that was not


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


def settle_in(schedule: Schedule, built: list[BuiltIn], before: list[BuiltIn], /) -> None:
    """Let built-in systems run in place of those `before` them; what a game has replaced or removed stays so."""
    for (_, name, system), (_, _, old) in zip(built, before, strict=True):
        if name in schedule and schedule[name].run == old.run:
            schedule.replace(name, system, trusted=True)
