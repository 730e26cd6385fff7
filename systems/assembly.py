"""The systems that a prairie comes with, each made from what it needs."""

from collections.abc import Callable, Iterable, Sequence

from ..components.body import Body
from ..engine.schedule import HasRun, Phase
from .around.outlook import Outlook
from .blow import Blow, Hear
from .cull import Cull
from .entities import PatchEntities
from .gather import Gather
from .lod import SLACK, ChooseLevels
from .painter import Painter
from .plant import Plant
from .see import See
from .site import Site
from .tile import Tile
from .transition import Transition

BuiltIn = tuple[Phase, str, HasRun]


def built_in(
    site: Site,
    outlooks: Iterable[Outlook],
    entities: PatchEntities,
    /,
    *,
    hear: Hear,
    painter: Callable[[], Painter],
    bodies: Callable[[float], Sequence[Body]],
) -> list[BuiltIn]:
    """Return the systems of a site in running order: phase, name, and the system itself."""
    ground, shown, reach = site.ground, site.representations, site.reach
    patch, change = ground.patch, site.transitions

    return [
        (
            Phase.TILE,
            "tile",
            Tile(
                outlooks, entities, ground.terrain, patch, site.scene.seed,
                site.quality.models,
            ),
        ),
        (Phase.SEE, "cull", Cull(outlooks, patch, site.sway)),
        (Phase.SEE, "lod", ChooseLevels(outlooks, reach, SLACK if change.hysteresis else 0)),
        (Phase.SEE, "transition", Transition(outlooks, shown, reach, patch, change)),
        (Phase.SEE, "see", See(outlooks, shown, reach, patch, change)),
        (Phase.BLOW, "plant", Plant(outlooks, shown, entities.world)),
        (Phase.BLOW, "wind", Blow(outlooks, hear, site.growths, patch, max(each.margin() for each in shown))),
        (Phase.DRAW, "gather", Gather(outlooks, painter, bodies)),
    ]  # fmt: skip
