"""Outlooks: what is kept for each viewer of a prairie."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np

from ...components.viewer import Viewer
from ...engine.camera import View
from ...engine.world import World
from ..space.cone import view_cone
from ..space.frustum import picture_sides
from .appearance import Appearance
from .asked import Frame
from .kept import Kept
from .lens import Lens, zoom_of
from .pace import Pace
from .patches import PatchTable

Record = TypeVar("Record")
Other = TypeVar("Other")


@dataclass(slots=True, eq=False)
class _Rest:
    """What a system found when it last ran for a viewer, and left just as it was: so long it is left out."""

    system: object = None
    seen: object = None
    """What it read beside the patch table."""

    table: bytearray = field(default_factory=bytearray)
    """What may change of the patch table as it found it, where it left it so; otherwise nothing."""

    made: object = None
    """What it made of that, if it makes something anew in each frame."""


@dataclass(slots=True, eq=False, weakref_slot=True)
class Outlook:
    """One viewer, the patches around it, and what it is shown of them."""

    viewer: Viewer

    entity: int
    """The viewer's entity."""

    patches: PatchTable

    view: View | None = None
    """The matrices that it looked with last; None before the first time."""

    frame: Frame | None = None
    """What it has been drawn of its frame."""

    lens: Lens = field(default_factory=Lens)
    """How far it sees each representation."""

    kept: dict[str, Kept] = field(default_factory=dict)
    """What each representation keeps for it, by its name."""

    shown: dict[str, object] = field(default_factory=dict)
    """What each representation shows it in this frame, by its name."""

    appearance: Appearance | None = None
    """How each patch appears in this frame."""

    bent: float = 0.0
    """Posture index that the winds of this frame bring grass to everywhere, in the mean, in [0, 1]."""

    changing: int = 0
    """Patches that were seen to change their representation in this frame, or to be changing it."""

    drawn_at: float | None = None
    """The instant that it saw last [s]; None before the first, and where time has leapt."""

    pace: Pace = field(default_factory=Pace)
    """How fast the viewer's time goes."""

    left: list[int] = field(default_factory=list)
    """Entities of patches that were left behind, and are still to be deleted."""

    cleared: int = -1
    """Version of the clearings that the patches stand for."""

    away_for: tuple[object, ...] = ()
    """Where the viewer was, and what the ground was, for whom the patches' discrete distances are reckoned."""

    heights: int = 0
    """Changes of the terrain's heights that the patches stand for."""

    peopled: int = 0
    """How often entities of its patches have come or gone."""

    whole: int = -1
    """What that was when each of its patches had one, and none was left behind."""

    sown: int = 0
    """Changes of what is sown and cleared that the patches stand for."""

    generation: int = 0
    """Generation of the world that the patches' entities are of."""

    _noted: dict[type, object] = field(default_factory=dict)

    _rests: dict[type, _Rest] = field(default_factory=dict)
    """By the class of a system, how it ran last."""

    def note(self, record: object, /) -> None:
        """Keep what a system has found out for this viewer, in place of the last record of the same class."""
        self._noted[type(record)] = record

    def noted(self, record: type[Record], default: Other, /) -> Record | Other:
        """Return what was noted last of a class, or else `default`."""
        return self._noted.get(record, default)  # type: ignore[return-value]

    def keeps(self, kept: type[Record], /) -> Record:
        """Return what is kept by the representation whose stores are of a class."""
        for each in self.kept.values():  # quicker than `next`, as it is asked many times a frame
            if type(each) is kept:
                return each
        raise LookupError(kept)

    def shows(self, shown: type[Record], /) -> Record:
        """Return what is shown by the representation that shows a class of things."""
        for each in self.shown.values():
            if type(each) is shown:
                return each
        raise LookupError(shown)

    def unless_at_rest(
        self,
        system: object,
        seen: tuple[object, ...],
        run: Callable[[], None],
        *,
        made: Callable[[], object] = lambda: None,
        settled: Callable[[], bool] = lambda: True,
    ) -> None:
        """Run a system, unless it would change nothing: it finds all as it left it when it last ran, and found it then.

        `seen` is what it reads beside the patch table, to be compared, and `made` gives what it makes anew. While it
        has not `settled`, the next frame may be another one though it finds the same.
        """
        rest = self._rests.setdefault(type(system), _Rest())
        is_same, rest.system = rest.system is system, system
        if rest.seen != seen:
            rest.seen, rest.table = seen, bytearray()
            run()
            return
        table = self.patches.changing.data
        if is_same and rest.table == table and made() is rest.made:
            return
        found = bytearray(table)
        run()
        rest.table, rest.made = found if found == table and settled() else bytearray(), made()

    def settle(self) -> None:
        """End the frame: what a game has written into messages holds no longer."""
        for kept in self.kept.values():
            for receiving in kept.receiving:
                receiving.letters.settle()

    def look(self, view: View, /, *, time: float, leap: float) -> None:
        """Look from where two matrices say, at an instant [s]; who comes farther than `leap` [m] has jumped."""
        before, self.view, viewer, eye = self.view, view, self.viewer, view.eye
        viewer.way = float(np.hypot(eye[0] - viewer.eye[0], eye[2] - viewer.eye[2]))
        viewer.jumped = viewer.way > leap or self.drawn_at is None
        viewer.eye, viewer.time = eye, time
        if view is not before:
            viewer.cone, viewer.sides, self.lens.zoom = view_cone(view), picture_sides(view), zoom_of(view)
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

    def begin_anew(self) -> None:
        """Let all viewers see what they see next as if they came from somewhere else: time has leapt."""
        for outlook in self.values():
            outlook.drawn_at, outlook.pace, outlook.frame = None, Pace(), None

    def forget(self, name: str, /) -> None:
        """Forget a viewer, and delete the entities that were its own."""
        gone = self._all.pop(name, None)
        self._looking = None if self._looking is gone else self._looking
        if gone is None or gone.generation != self._world.check():
            return  # what the whole world was cleared of: its numbers may be others' by now
        for entity in (*gone.patches.entity[gone.patches.entity != 0].tolist(), *gone.left):
            self._world.delete(entity)
        for kept in gone.kept.values():
            kept.release(self._world)
        self._world.delete(gone.entity)
