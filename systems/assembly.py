"""The built-in systems of a prairie, each made from its inputs."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from ..engine.schedule import HasRun, Phase, Schedule
from .around.outlook import Outlook
from .around.transitions import SLACK
from .blow import Blow, Hear, WindsAt
from .cull import Cull
from .draw import Draw
from .entities import PatchEntities
from .gather import Gather
from .govern import Governor
from .lod import ChooseLevels
from .painter import Painter
from .plant import Plant
from .press.marks import UNTRODDEN, Trodden
from .pressers import Press
from .see import See
from .site import Site
from .tile import Tile
from .transition import Transition

BuiltIn = tuple[Phase, str, HasRun]


@dataclass(frozen=True, slots=True)
class Assembly:
    """Inputs of a prairie's systems that do not depend on its site."""

    outlooks: Iterable[Outlook]
    entities: PatchEntities
    hear: Hear
    """Returns the messages of winds and pressers to receivers."""

    painter: Callable[[], Painter]
    """Returns the painter in the present context."""

    governor: Governor
    acting: WindsAt = lambda _: ()
    """Returns the winds that act at a time [s]."""

    trodden: Callable[[float], Trodden] = lambda _: UNTRODDEN
    """Returns what has been trodden at a time [s]."""

    bent: Callable[[float], float] = lambda _: 0.0
    """Returns the mean posture index to which the winds bend grass everywhere at a time [s]."""

    def on(self, site: Site, /) -> list[BuiltIn]:
        """Return the built-in systems on a site in running order: phase, name, and the system itself."""
        ground, shown, outlooks = site.ground, site.representations, self.outlooks
        patch, change = ground.patch, site.transitions
        return [
            (Phase.TILE, "press", Press(outlooks, self.trodden)),
            (Phase.TILE, "tile", Tile(outlooks, self.entities, shown, ground, site.scene.seed, site.quality.models)),
            (Phase.SEE, "cull", Cull(outlooks, patch, site.sway)),
            (Phase.SEE, "lod", ChooseLevels(outlooks, site.reach, shown, SLACK * change.hysteresis, self.bent)),
            (Phase.SEE, "transition", Transition(outlooks, shown, patch, change)),
            (Phase.SEE, "see", See(outlooks, shown, patch, change)),
            (Phase.BLOW, "plant", Plant(outlooks, shown, self.entities.world)),
            (Phase.BLOW, "wind", Blow(outlooks, self.acting, self.hear, site.growths)),
            (Phase.DRAW, "gather", Gather(outlooks, self.painter)),
            (Phase.DRAW, "draw", Draw(outlooks, self.painter, self.governor)),
        ]


def replace_built_in(schedule: Schedule, built: list[BuiltIn], before: list[BuiltIn], /) -> None:
    """Replace the built-in systems `before`, except those that a game has itself replaced or removed."""
    for (_, name, system), (_, _, old) in zip(built, before, strict=True):
        if name in schedule and schedule[name].run == old.run:
            schedule.replace(name, system, trusted=True)
