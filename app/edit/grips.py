"""What of a wind can be taken hold of on the ground, and what becomes of it as it is pulled."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...components.arrays import Floats
from ...components.wind import WindPrimitive
from ...systems.overlay.masks import EDGE_WEIGHT
from ...systems.prairie import Prairie
from ...systems.wind.blow import Blowing
from ...systems.wind.quarantine import QuarantinedError
from .anchors import Anchor, ahead, declared_anchors, heading, turned_to
from .editor import Editor
from .pick import Place
from .values import Way

SHORTEST, LONGEST, USUAL = 2.5, 12.0, 6.0
"""How far from a wind's middle it is turned at least, at most, and where it has no extent [m]."""


@dataclass(frozen=True, slots=True)
class Grip:
    """A place at which a wind is taken hold of."""

    kind: Literal["move", "turn"]
    number: int
    """The wind's number in the scene."""

    place: Place
    """Ground position (x, z) [m]."""

    moved: tuple[Anchor, ...] = ()
    """What goes along with it."""

    way: Way = ()
    """The key of the heading that it turns."""

    middle: Place = (0.0, 0.0)
    """What it turns about, (x, z) [m]."""


def grips_of(editor: Editor) -> list[Grip]:
    """Return the grips of all winds: one at each place that they declare, and where the picked one heads."""
    found = [Grip("move", number, anchor.place, (anchor,)) for number, anchor in editor.anchors()]
    wind = editor.picked_wind
    if wind is not None and editor.picked is not None:
        turns = heading(wind, editor.picked)
        if turns is not None:
            blown = blowing_of(editor.prairie, wind)
            middle = (blown[0].pose.x, blown[0].pose.z) if blown else declared_anchors(wind, editor.picked)[0].place
            place = ahead(middle, turns[1], _away(blown))
            found.append(Grip("turn", editor.picked, place, way=turns[0], middle=middle))
    return found


def grip_at(editor: Editor, place: Place, /) -> Grip | None:
    """Return the grip on the strongest wind whose mask a ground position (x, z) [m] is on, with all of its places."""
    prairie, spot = editor.prairie, np.array([place], np.float32)
    for blown in prairie.winds.acting(prairie.time):
        number = number_of(editor, blown.source.primitive)
        if number is None or blown.extent is None or not _is_on(prairie, blown, spot):
            continue
        return Grip("move", number, place, tuple(declared_anchors(editor.winds[number], number)))
    return None


def pulled(editor: Editor, grip: Grip, to: Place, /) -> None:
    """Move what a grip moves as far as it was pulled to a ground position (x, z) [m], or turn it to there."""
    if grip.kind == "turn":
        editor.set(grip.way, turned_to(grip.middle, to), subject=("turn", grip.way))
    else:
        editor.drag(grip.moved, (to[0] - grip.place[0], to[1] - grip.place[1]))


def blowing_of(prairie: Prairie, wind: WindPrimitive, /) -> list[Blowing]:
    """Return what of a declared wind acts now, the strongest claim first."""
    return [blown for blown in prairie.winds.acting(prairie.time) if blown.source.primitive == wind]


def number_of(editor: Editor, wind: WindPrimitive, /) -> int | None:
    """Return which of the scene's winds this is; None for one that a game or a key has added."""
    return next((number for number, each in enumerate(editor.winds) if each == wind), None)


def _is_on(prairie: Prairie, blown: Blowing, spot: Floats) -> bool:
    own, extent = blown.pose.inside(spot), blown.extent
    x, z = own[0].tolist()
    if extent is None or not (extent.left <= x <= extent.right and extent.ahead <= z <= extent.behind):
        return False
    try:
        weight = prairie.winds.quarantine.ask_for(
            blown.source, "mask", lambda: blown.primitive.mask(own, time=prairie.time), shape=(1,)
        )
    except QuarantinedError:
        return False
    return bool(weight[0] > EDGE_WEIGHT)


def _away(blown: list[Blowing]) -> float:
    extent = blown[0].extent if blown else None
    if extent is None:
        return USUAL
    half = min(extent.right - extent.left, extent.behind - extent.ahead) / 2
    return float(np.clip(half, SHORTEST, LONGEST))
