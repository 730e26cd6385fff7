"""Outlooks: state kept for each viewer of a prairie."""

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
class _LastRun:
    """Inputs and result of a system's last run for a viewer; while they stay the same, the system is skipped."""

    system: object = None
    inputs: object = None
    """Inputs beside the patch table."""

    table: bytearray = field(default_factory=bytearray)
    """Copy of `PatchTable.changing`, if the run left it unchanged and had settled; otherwise empty."""

    result: object = None
    """Result of the run, of a system that makes a new one in each frame."""


@dataclass(slots=True, eq=False, weakref_slot=True, repr=False)
class Outlook:
    """One viewer, the patches around it, and what it is shown of them."""

    viewer: Viewer

    entity: int
    """Entity of the viewer."""

    patches: PatchTable

    view: View | None = None
    """Matrices of the last frame; None before the first."""

    frame: Frame | None = None
    """Parts of the current frame that have been drawn; None before the first, and where time has leapt."""

    lens: Lens = field(default_factory=Lens)
    """Scale of the representations' reaches."""

    kept: dict[str, Kept] = field(default_factory=dict)
    """Pools of each representation for this viewer, by its name."""

    shown: dict[str, object] = field(default_factory=dict)
    """Grass that each representation shows in this frame, by its name."""

    appearance: Appearance = field(init=False)
    """Cover, morph and growth of all patches in this frame."""

    mean_index: float = 0.0
    """Mean posture index that the winds of this frame bend grass to everywhere, in [0, 1]."""

    changing: int = 0
    """Number of visible patches with grass whose representation changed, or was changing, in this frame."""

    drawn_at: float | None = None
    """Time of the last frame [s]; None before the first, and where time has leapt."""

    pace: Pace = field(default_factory=Pace)
    """Pace of the viewer's time."""

    left_behind: list[int] = field(default_factory=list)
    """Entities of patches that have left the window, still to be deleted."""

    cleared: int = -1
    """Version of the clearings that `patches.grows` is of."""

    away_inputs: tuple[object, ...] = ()
    """Height of the eye and version of the heights that `patches.away` is computed from."""

    heights: int = 0
    """Number of changes of the terrain's heights that are in the patch table."""

    entity_changes: int = 0
    """Number of times that entities of patches have been created or deleted."""

    complete_at: int = -1
    """Value of `entity_changes` when every patch had its entity and none was left behind."""

    sown: int = 0
    """Number of changes of sown and cleared grass that are in the patch table."""

    generation: int = 0
    """Generation of the world that the patches' entities belong to."""

    _noted: dict[type, object] = field(default_factory=dict)
    """Last record that systems have noted, by its class."""

    _last_runs: dict[type, _LastRun] = field(default_factory=dict)
    """Last run of each system, by its class."""

    def note(self, record: object, /) -> None:
        """Keep a system's result for this viewer, in place of the last record of the same class."""
        self._noted[type(record)] = record

    def noted(self, record: type[Record], default: Other, /) -> Record | Other:
        """Return the last noted record of a class, or else `default`."""
        return self._noted.get(record, default)  # type: ignore[return-value]

    def keeps(self, kept: type[Record], /) -> Record:
        """Return the pools of this class, of whichever representation; raises LookupError where there are none."""
        for pools in self.kept.values():  # faster than `next`; this is called many times a frame
            if type(pools) is kept:
                return pools
        raise LookupError(kept)

    def shows(self, shown: type[Record], /) -> Record:
        """Return the shown grass of this class, of whichever representation; raises LookupError where there is none."""
        for grass in self.shown.values():
            if type(grass) is shown:
                return grass
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
        """Run a system, unless its last run changed nothing and its inputs are still the same.

        `seen` has its inputs beside the patch table, to be compared. `made` returns its result, if it makes one in
        each frame. Until `settled`, the system also runs on the same inputs.
        """
        last = self._last_runs.setdefault(type(system), _LastRun())
        is_same, last.system = last.system is system, system
        if last.inputs != seen:
            last.inputs, last.table = seen, bytearray()
            run()
            return
        table = self.patches.changing.data
        if is_same and last.table == table and made() is last.result:
            return
        before = bytearray(table)
        run()
        last.table, last.result = before if before == table and settled() else bytearray(), made()

    def settle(self) -> None:
        """End the frame: messages that a game has written are dropped."""
        for kept in self.kept.values():
            for receiving in kept.receiving:
                receiving.messages.settle()

    def look(self, view: View, /, *, time: float, leap: float) -> None:
        """Take the view and time [s] of a new frame; a viewer that moves farther than `leap` [m] has jumped."""
        before, self.view, viewer, eye = self.view, view, self.viewer, view.eye
        viewer.way = float(np.hypot(eye[0] - viewer.eye[0], eye[2] - viewer.eye[2]))
        viewer.jumped = viewer.way > leap or self.drawn_at is None
        viewer.eye, viewer.time = eye, time
        if view is not before:
            viewer.cone, viewer.sides, self.lens.zoom = view_cone(view), picture_sides(view), zoom_of(view)
        viewer.dt = 1e9 if self.drawn_at is None else time - self.drawn_at
        self.drawn_at, viewer.idles = time, self.pace.idles(viewer.dt)


class Outlooks:
    """The outlooks of a prairie, by their viewers' names. Iterating yields the one that looks in this frame."""

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
        outlook = self._all.get(str(name))
        return outlook is not None and self._world.find(outlook.entity, Viewer) is outlook.viewer

    def values(self) -> list[Outlook]:
        """Return the outlooks whose viewers still exist, in the order of their first look."""
        return [self._all[name] for name in self._all if name in self]

    def looking(self, name: str, make: Callable[[Viewer, int], Outlook], /) -> Outlook:
        """Make the viewer of this name the one that looks, and return its outlook; a new name is a new viewer.

        `make` returns the empty outlook of a viewer and its entity. A viewer whose entity has been deleted begins anew.
        """
        for gone in [each for each in self._all if each not in self]:
            self.forget(gone)
        if name not in self._all:
            viewer = Viewer(name)
            self._all[name] = make(viewer, self._world.create(viewer))
            self._all[name].generation = self._world.check()
        self._looking = outlook = self._all[name]
        return outlook

    def begin_anew(self) -> None:
        """Treat the next frame of each viewer as its first, because time has leapt."""
        for outlook in self.values():
            outlook.drawn_at, outlook.pace, outlook.frame = None, Pace(), None

    def forget(self, name: str, /) -> None:
        """Forget a viewer, and delete its entities."""
        gone = self._all.pop(name, None)
        self._looking = None if self._looking is gone else self._looking
        if gone is None or gone.generation != self._world.check():
            return  # the whole world was cleared, and its numbers may be other entities' by now
        for entity in (*gone.patches.entity[gone.patches.entity != 0].tolist(), *gone.left_behind):
            self._world.delete(entity)
        for kept in gone.kept.values():
            kept.release(self._world)
        self._world.delete(gone.entity)
