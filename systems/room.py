"""Room: the distance from a viewer up to which pools have slots for each representation."""

from collections.abc import Sequence
from math import ceil, log2

from ..engine.world import World
from .around.appearance import Appearance
from .around.lens import reach_under
from .around.outlook import Outlook
from .lod import farthest
from .show.representation import Representation


def keep_room(outlook: Outlook, representations: Sequence[Representation], reach: tuple[int, ...], /) -> None:
    """Give an outlook empty pools for every representation, with room for the `reach` of each.

    Only the carpet is shown until the system `see` has run, which a game may have left out.
    """
    outlook.lens.reach = outlook.lens.room = reach
    for each, side in zip(representations, _sides(outlook), strict=True):
        outlook.kept[each.name] = each.keep(outlook.patches, side)
    outlook.appearance = Appearance.of_carpet(len(representations), len(outlook.patches.progress))
    for each, cover in zip(representations, outlook.appearance.cover, strict=True):
        outlook.shown[each.name] = each.show(outlook, cover)


def get_ready(outlook: Outlook, representations: Sequence[Representation], before: Sequence[Representation], /) -> bool:
    """Prepare one representation's pools for a later `keep_on`, if any are not ready; return whether all were."""
    pairs = zip(representations, before, strict=True)
    return all(each.carry_ahead(other, outlook.kept[each.name], outlook.patches) for each, other in pairs)


def keep_on(outlook: Outlook, representations: Sequence[Representation], before: Sequence[Representation], /) -> None:
    """Hand an outlook's pools over to other representations; grass that has not been grown anew stays planted."""
    for each, other, cover in zip(representations, before, outlook.appearance.cover, strict=True):
        kept = outlook.kept[each.name]
        each.carry(other, kept, outlook.patches)
        kept.planted += 1
        outlook.shown[each.name] = each.show(outlook, cover)


def make_room(outlook: Outlook, representations: Sequence[Representation], world: World, /) -> None:
    """Enlarge pools that are too small for what a long lens brings near, with room up to the next doubling of the lens.

    Grass of the smaller pools is planted again, and its receivers become other entities.
    """
    lens = outlook.lens
    if lens.factor == 1.0:
        return
    due = tuple(max(limits) for limits in zip(room_for(lens.reach, lens.factor), lens.room, strict=True))
    if due == lens.room:
        return
    before, lens.room = _sides(outlook), due
    for each, old, side in zip(representations, before, _sides(outlook), strict=True):
        if side != old:
            outlook.kept[each.name].release(world)
            outlook.kept[each.name] = each.keep(outlook.patches, side)


def room_for(reach: tuple[int, ...], lens: float, /) -> tuple[int, ...]:
    """Return the room that representations of this reach need with a lens, which is rounded up to a power of two."""
    return tuple(int(limit) for limit in reach_under(reach, 2.0 ** ceil(log2(lens))))


def _sides(outlook: Outlook) -> list[int]:
    """Return the side of the square of patches that each representation's pools have room for [patches]."""
    most = outlook.patches.side
    return [*(min(max(2 * limit + 1, 1), most) for limit in farthest(outlook.lens.room)), most]
