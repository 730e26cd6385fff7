"""Outlooks: what is kept for each viewer of a prairie."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from math import radians, tan
from typing import TYPE_CHECKING, Any

import numpy as np

from ...components.viewer import Viewer
from ...engine.camera import View
from ...engine.world import World
from ..mow.mown import Mown
from ..press.marks import UNTRODDEN, Trodden
from ..space.cone import picture_sides, view_cone
from .appearance import Appearance
from .pace import Pace
from .patches import PatchTable

if TYPE_CHECKING:
    from ..wind.blow import Blowing

LEAP = 5.0
"""A viewer who moves more than this in one frame has jumped [m]."""

USUAL = 1.0 / tan(radians(22.5))
"""What a projection stretches heights by where the picture is 45 degrees high: rings are made for it."""

LONG = 1.275
"""The zoom from which on a lens is long, below 36 degrees: it brings representations near, and not just their rings."""

LONGER = 2.0
"""How much faster than the zoom their reach grows from there on, until it has grown as much."""


def brought_near(reach: tuple[int, ...], lens: float, /) -> tuple[float, ...]:
    """Return the reach of each representation, from the finest, under a lens that shows things `lens` times larger.

    Each reach is multiplied by `lens`, but goes no farther than the next coarser one's does without a lens. A
    representation that has no range of its own ends where the finer one does.
    """
    near: list[float] = []
    for number, limit in enumerate(reach[:-1]):
        own = limit >= 0 and (number == 0 or limit > reach[number - 1])
        near.append(min(limit * lens, max(limit, reach[number + 1])) if own else near[-1] if number else limit)
    return (*near, reach[-1])


@dataclass(slots=True, eq=False)
class Outlook:
    """One viewer, the patches around it, and what it is shown of them."""

    viewer: Viewer

    entity: int
    """The viewer's entity."""

    patches: PatchTable

    kept: dict[str, Any] = field(default_factory=dict)
    """What each representation keeps for this viewer, by its name."""

    appearance: Appearance | None = None
    """How each patch appears in this frame."""

    shown: dict[str, Any] = field(default_factory=dict)
    """What each representation shows in this frame, by its name."""

    range: float = 1.0
    """Part of the distances up to which representations are due."""

    zoom: float = 1.0
    """How many times larger things are seen than where the picture is 45 degrees high, 1 at least."""

    reach: tuple[int, ...] = ()
    """Largest discrete distance at which each representation is due without a lens."""

    room: tuple[int, ...] = ()
    """Largest discrete distance at which there is room for each to be due."""

    winds: Sequence["Blowing"] = ()
    """The winds that act in this frame, the strongest claim first."""

    bent: float = 0.0
    """Posture index that the winds of this frame bring grass to everywhere, in the mean, in [0, 1]."""

    trodden: Trodden = UNTRODDEN
    """What presses or has pressed the grass in this frame."""

    mown: Mown | None = None
    """What has been cut, if this is told."""

    blown_at: float = 0.0
    """The instant that the winds of this frame were asked for [s]."""

    heard: int = 0
    """Receivers of blades and strips that heard the wind in this frame."""

    changing: int = 0
    """Patches that were seen to change their representation in this frame, or to be changing it."""

    blades: int = 0
    """Blades sent as geometry in this frame."""

    drawn_at: float | None = None
    """The instant that the viewer saw last [s]; None before the first."""

    pace: Pace = field(default_factory=Pace)
    """How fast the viewer's time goes."""

    cleared: int = -1
    """Version of the clearings that the patches stand for."""

    generation: int = 0
    """Generation of the world that the patches' entities are of."""

    @property
    def lens(self) -> float:
        """How many times as far representations are due as without it, 1 at least; with a long one it is `zoom`."""
        return max(min(self.zoom, 1.0 + LONGER * (self.zoom - LONG)), 1.0)

    def reach_in(self, reach: tuple[int, ...], /) -> tuple[float, ...]:
        """Return up to where representations are due, as near as they are now and as far as a long lens brings them."""
        if self.lens == 1.0 or not self.room:
            return self.drawn_in(reach)
        far = zip(brought_near(reach, self.lens), self.room, strict=True)
        return tuple(min(limit, room) * self.range if limit > 0 else limit for limit, room in far)

    def drawn_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return distances up to which something is due, as near as they are now."""
        return limits if self.range == 1.0 else tuple(limit * self.range if limit > 0 else limit for limit in limits)

    def rings_in(self, limits: tuple[int, ...], /) -> tuple[float, ...]:
        """Return distances up to which rings are due, as near as they are now and as far as the lens brings them."""
        return tuple(limit * self.zoom for limit in self.drawn_in(limits))

    def settle(self) -> None:
        """End the frame: what a game has written into messages holds no longer."""
        for kept in self.kept.values():
            for receiving in kept.receiving:
                receiving.letters.settle()

    def look(self, view: View, /, *, time: float, leap: float = LEAP) -> None:
        """Look from where two matrices say, at an instant [s]; who comes farther than `leap` [m] has jumped."""
        viewer, eye = self.viewer, view.eye
        viewer.way = float(np.hypot(eye[0] - viewer.eye[0], eye[2] - viewer.eye[2]))
        viewer.jumped = viewer.way > leap
        viewer.eye, viewer.cone, viewer.time = eye, view_cone(view), time
        viewer.sides = picture_sides(view)
        perspective, tall = view.projection[3, 3] == 0.0, abs(float(view.projection[1, 1]))
        self.zoom = max(tall / USUAL, 1.0) if perspective else 1.0
        viewer.dt = 1e9 if self.drawn_at is None else time - self.drawn_at
        self.drawn_at, viewer.idles = time, self.pace.idles(viewer.dt)


class Outlooks:
    """The outlooks of a prairie by their viewers' names. Iterating gives those that look in this frame."""

    def __init__(self, world: World) -> None:
        self._world = world
        self._all: dict[str, Outlook] = {}
        self._looking: Outlook | None = None

    def __iter__(self) -> Iterator[Outlook]:
        return iter(() if self._looking is None else (self._looking,))

    def __getitem__(self, name: str) -> Outlook:
        if name not in self._all:
            raise KeyError(f"there is no viewer '{name}'; there are {', '.join(self._all) or 'none yet'}")
        return self._all[name]

    def __contains__(self, name: object) -> bool:
        found = self._all.get(str(name))
        return found is not None and self._world.find(found.entity, Viewer) is found.viewer

    def values(self) -> list[Outlook]:
        """Return those whose viewers are still there, in the order in which these first looked."""
        return [self._all[name] for name in self._all if name in self]

    def looking(self, name: str, make: Callable[[Viewer, int], Outlook], /) -> Outlook:
        """Let the viewer of this name be the one that looks, and return its outlook; a new name is a new viewer.

        `make` gives the empty outlook of a viewer and its entity. One whose entity has been deleted begins anew.
        """
        for gone in [each for each in self._all if each not in self]:
            self.forget(gone)
        if name not in self._all:
            viewer = Viewer(name)
            self._all[name] = made = make(viewer, self._world.create(viewer))
            made.generation = self._world.check()
        self._looking = found = self._all[name]
        return found

    def forget(self, name: str, /) -> None:
        """Forget a viewer, and delete the entities that were its own."""
        gone = self._all.pop(name, None)
        if gone is None or gone.generation != self._world.check():
            return  # what the whole world was cleared of: its numbers may be others' by now
        for entity in gone.patches.entity[gone.patches.entity != 0].tolist():
            self._world.delete(entity)
        for kept in gone.kept.values():
            kept.release(self._world)
        self._world.delete(gone.entity)
