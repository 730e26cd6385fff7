"""Grips of winds on the ground, and the effect of pulling them."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...components.arrays import Floats, Place
from ...components.wind import WindPrimitive
from ...engine.camera import ahead
from ...systems.overlay.masks import EDGE_WEIGHT
from ...systems.prairie import Prairie
from ...systems.wind.blow import Blowing
from ...systems.wind.quarantine import QuarantinedError
from .anchors import Anchor, declared_anchors, heading, turned_to
from .editor import Editor
from .values import Way

SHORTEST, LONGEST, USUAL = 2.5, 12.0, 6.0
"""Least and largest distance of the turning grip from a wind's middle, and the one without an extent [m]."""


@dataclass(frozen=True, slots=True)
class Grip:
    """A place at which the mouse takes hold of a wind."""

    kind: Literal["move", "turn"]
    number: int
    """Index of the wind in the scene."""

    place: Place
    """Ground position (x, z) [m]."""

    moved: tuple[Anchor, ...] = ()
    """Anchors that move with it."""

    way: Way = ()
    """Way to the heading that it turns."""

    middle: Place = (0.0, 0.0)
    """Centre of the turning, (x, z) [m]."""


def grips_of(editor: Editor) -> list[Grip]:
    """Return the grips of all winds: one at each anchor, and one that turns the picked wind."""
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
    """Return a grip on the strongest wind whose mask covers a ground position (x, z) [m], with all its anchors."""
    prairie, spot = editor.prairie, np.array([place], np.float32)
    for blown in prairie.winds.acting(prairie.time):
        number = number_of(editor, blown.source.primitive)
        if number is None or blown.extent is None or not _is_on(prairie, blown, spot):
            continue
        return Grip("move", number, place, tuple(declared_anchors(editor.winds[number], number)))
    return None


def pulled(editor: Editor, grip: Grip, to: Place, /) -> None:
    """Pull a grip to a ground position (x, z) [m]: move its anchors by that displacement, or turn its heading there."""
    if grip.kind == "turn":
        editor.set(grip.way, turned_to(grip.middle, to), subject=("turn", grip.way))
    else:
        editor.drag(grip.moved, (to[0] - grip.place[0], to[1] - grip.place[1]))


def blowing_of(prairie: Prairie, wind: WindPrimitive, /) -> list[Blowing]:
    """Return the acting parts of a declared wind, the strongest claim first."""
    return [blown for blown in prairie.winds.acting(prairie.time) if blown.source.primitive == wind]


def number_of(editor: Editor, wind: WindPrimitive, /) -> int | None:
    """Return the index of a wind in the scene; None for a wind that a game or a key has added."""
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
