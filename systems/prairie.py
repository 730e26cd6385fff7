"""A prairie: what a game loads, advances and draws."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, get_args

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..components.pose import Pose
from ..components.wind import WindPrimitive
from ..engine.camera import View, view_of
from ..engine.declared.quality import PRESETS
from ..engine.declared.scene import LodName, Scene
from ..engine.gl.guest import host_context, kept, viewport
from ..engine.gl.homes import Homes
from ..engine.plugged import bring_systems
from ..engine.scene import LoadedScene, read_scene
from ..engine.schedule import Phase, Schedule
from ..engine.terrain.sample import height_at
from ..engine.world import World
from .around.clearing import Clearings
from .around.outlook import Outlook, Outlooks
from .around.transitions import SEAMLESS, Transitions
from .around.window import cell_of
from .assembly import BuiltIn, built_in
from .bodies.fly import flying
from .entities import PatchEntities
from .painter import Painter
from .site import Site, found_again, found_site, outlook_on, settle_on
from .statistics import Statistics
from .winds import Winds

if TYPE_CHECKING:
    from pyglet.graphics import Batch, Group

    from ..engine.gl.batch import DrawingGroup

Floats = NDArray[np.float32]

LEAP = 2.0
"""A viewer who moves more than this in one frame has jumped [patch sides]."""


class Prairie:
    """A prairie in the current esper world: grown at once, drawn once there is a GL context."""

    def __init__(
        self,
        loaded: LoadedScene,
        *,
        ctx: moderngl.Context | None = None,
        preset: str | None = None,
        lod: LodName = "auto",
        transitions: Transitions = SEAMLESS,
        live: bool = True,
    ) -> None:
        self.site: Site = found_site(loaded, preset=preset, lod=lod, transitions=transitions)
        self.lod: LodName = lod
        self.path = loaded.path
        self.statistics = Statistics(blades_field=self.site.blades)
        self.world = World(self.advance)
        self.viewers = Outlooks(self.world, lambda viewer, entity: outlook_on(self.site, viewer, entity))
        self.winds = Winds(self.world, loaded.scene, self.site.ground, self.site.growths, live=live)
        self.systems = Schedule()
        self.painter: Painter | None = None
        self.clearings = Clearings()
        self._painters: Homes[Painter] = Homes()
        self._groups: list[DrawingGroup] = []
        self._loaded, self._preset, self._ctx = loaded, preset, ctx
        self._clock = 0.0
        self._released = False
        self._built: list[BuiltIn] = self._assembled()
        for phase, name, system in self._built:
            self.systems.add(phase, name, system, trusted=True)
        bring_systems(self)

    @classmethod
    def load(
        cls,
        scene: str | Path,
        *,
        ctx: moderngl.Context | None = None,
        preset: str | None = None,
        lod: LodName = "auto",
        transitions: Transitions = SEAMLESS,
        live: bool = True,
    ) -> "Prairie":
        """Return the prairie of a scene file, or of a bundled scene by its name.

        `ctx` is the context to draw in; without it the one that is current at the first draw. `preset` overrides
        the scene's quality, `lod` shows everything in one representation, `transitions` leaves out parts of what
        carries a patch from one representation to another. A `live` prairie leaves a plugin's wind out for a while
        that takes too long; others keep it. Raises `SceneError` with every problem of the file and its maps,
        ValueError for an unknown preset or representation.
        """
        if preset is not None and preset not in PRESETS:
            raise ValueError(f"unknown preset '{preset}'; there are {', '.join(PRESETS)}")
        if lod not in get_args(LodName):
            raise ValueError(f"unknown representation '{lod}'; there are {', '.join(get_args(LodName))}")
        return cls(read_scene(scene), ctx=ctx, preset=preset, lod=lod, transitions=transitions, live=live)

    @property
    def scene(self) -> Scene:
        """The scene, as its file declares it."""
        return self.site.scene

    @property
    def time(self) -> float:
        """The scene's time [s], to the nearest microsecond: however it was cut into steps, it is the same instant."""
        return round(self._clock, 6)

    @property
    def files(self) -> dict[str, Path]:
        """The scene's file and those that it names, by the names that it calls them."""
        return {self.path.name: self.path} | {name: self._loaded.folder / name for name in self._loaded.files}

    def reseeded(self, seed: int) -> "Prairie":
        """Return another prairie of the same scene, quality and terrain, with other grass."""
        scene = self.scene.model_copy(update={"seed": seed})
        return Prairie(
            replace(self._loaded, scene=scene), ctx=self._ctx, preset=self._preset, lod=self.lod,
            transitions=self.site.transitions, live=self.winds.quarantine.live,
        )  # fmt: skip

    def advance(self, dt: float) -> None:
        """Move time on by `dt` [s]; negative or non-finite steps raise ValueError."""
        if not (np.isfinite(dt) and dt >= 0.0):
            raise ValueError(f"a prairie advances by 0 s or more, not by {dt}")
        self._clock += dt
        self.winds.quarantine.let_back(self.time)

    def draw(self, view: object, projection: object, *, viewer: str = "main") -> None:
        """Draw the prairie into the framebuffer that is bound, and leave the host's GL state as it was.

        Ground, carpet and the nearest blades write depth; strips and other blades only test it. So a game draws its
        own opaque things before the prairie, and its 2D after it.

        Both matrices are 4x4 numpy arrays for column vectors, or `pyglet.math.Mat4`. Of several viewers in a frame,
        each needs a name of its own. Raises ValueError for other matrices, and RuntimeError after `release` or without
        a window. Where the viewport has no pixels, nothing happens at all.
        """
        self._must_be_there("draw it")
        seen = view_of(view, projection)
        with kept():
            ctx = host_context(self._ctx)
            if 0 in viewport(ctx)[2:]:
                return
            self.painter = self._painters.here(ctx, partial(Painter, site=self.site))
            if self.painter.site is not self.site:
                self.painter.change(self.site)
            outlook = self._look(seen, viewer)
            self.systems.run()
            start = perf_counter()
            self.painter.draw(seen)
            self._count(outlook, self.painter, 1000.0 * (perf_counter() - start))
            outlook.settle()

    def follow(self, view: object, projection: object, *, viewer: str = "main") -> None:
        """Follow a viewer for a frame as `draw` does, without drawing it and without any GL.

        Patches come, go and change their representation as they would have, so that a film can start in its middle.
        The matrices are those of `draw`, and it raises the same errors.
        """
        self._must_be_there("follow a viewer")
        self._look(view_of(view, projection), viewer)
        self.systems.run(last=Phase.SEE)

    def group(
        self,
        batch: "Batch",
        camera: Callable[[], tuple[object, object]],
        *,
        order: int = 0,
        parent: "Group | None" = None,
    ) -> "DrawingGroup":
        """Put the prairie into a pyglet batch, and return the group that it is there.

        Whenever the batch is drawn, `camera` is asked for view and projection, as `draw` takes them, and the prairie is
        drawn after groups of a lower `order` and before those of a higher one. The group's `visible` hides it, its
        `delete` takes it out of the batch, as `release` does.
        """
        from ..engine.gl.batch import DrawingGroup  # noqa: PLC0415 - it loads pyglet, which needs a display

        made = DrawingGroup(lambda: self.draw(*camera()), batch, order=order, parent=parent)
        self._groups.append(made)
        return made

    def height_at(self, xz: ArrayLike) -> Floats:
        """Return the height of the ground [m], shape (n,), at ground positions (x, z) [m], shape (n, 2)."""
        return height_at(self.site.ground.terrain, _places(xz))

    def wind_at(self, xz: ArrayLike, time: float | None = None, *, kind: str | None = None) -> Floats:
        """Return what grass at ground positions (x, z) [m], shape (n, 2), feels at `time` [s], or now.

        Messages of shape (n, 2): vectors along the bending direction whose norm is the posture index, in [0, 1].
        They are those of grass of a `kind`, or else of the kind that grows most densely at each place. Raises
        ValueError for an unknown kind.
        """
        if kind is not None and kind not in self.scene.grass:
            raise ValueError(f"unknown grass '{kind}'; there are {', '.join(self.scene.grass)}")
        number = None if kind is None else list(self.scene.grass).index(kind)
        return self.winds.at(_places(xz), time=self.time if time is None else time, kind=number)

    def patch_at(self, xz: ArrayLike, *, viewer: str = "main") -> NDArray[np.int64]:
        """Return the entity of the patch at each ground position (x, z) [m], shape (n, 2), as a viewer has it: (n,).

        It has `Patch` and `Lod`. 0 stands for places off the terrain or too far away from the viewer to be kept, and
        for all before it has looked once.
        """
        cells = cell_of(_places(xz), patch=self.site.ground.patch)
        if viewer not in self.viewers:
            return np.zeros(len(cells), np.int64)
        return self._entities().at(self.viewers[viewer], cells)

    def add(self, primitive: WindPrimitive, *, pose: Pose | None = None, name: str | None = None) -> int:
        """Add a wind and return its entity, a handle that `move` and `remove` take.

        With a `pose` the wind is there until it is moved, whatever it says itself; so it follows what a game steers.
        Winds of one name share what is random about them; without a name it is their kind.
        """
        return self.winds.add(primitive, name or primitive.kind, pose)

    def move(self, handle: int, pose: Pose) -> None:
        """Put a wind elsewhere that `add` returned: it follows what carries it."""
        self.world.add(handle, pose)

    def remove(self, handle: int) -> None:
        """Take a wind away that `add` returned."""
        self.world.delete(handle)

    def reload(self, scene: str | Path | None = None) -> None:
        """Read the scene again, or another one, and go on with it at the same time: what did not change stays.

        Terrain, kinds of grass, textures and receivers are made anew only where what they come from has changed, and
        winds that have not changed blow on as if nothing had happened; so do those that were added, and the systems
        that a game has added, replaced or left out. Raises `SceneError` with every problem, and then nothing has changed
        at all; RuntimeError after `release`, and while another esper world is current.
        """
        self._must_be_there("read it again")
        self.winds.sources()
        loaded = read_scene(self.path if scene is None else scene)
        before = self.site
        self.site = found_again(before, self._loaded, loaded, preset=self._preset, lod=self.lod)
        self._settle_on(before)
        self.winds.change(loaded.scene, self.site.ground, self.site.growths)
        self.path, self._loaded = loaded.path, loaded
        self.statistics.blades_field = self.site.blades

    def release(self) -> None:
        """Give back everything: GL objects in every window, places in batches, entities, and what `install` added.

        The processor of `install` goes with its world's last prairie. This prairie cannot be drawn afterwards.
        """
        self._released = True
        for group in self._groups:
            group.delete()
        self._groups.clear()
        self._painters.release()
        self.painter = None
        self.world.release()
        self.systems.clear()

    def _must_be_there(self, purpose: str) -> None:
        if self._released:
            raise RuntimeError(f"this prairie has been released: load it again to {purpose}")

    def _assembled(self) -> list[BuiltIn]:
        return built_in(
            self.site, self.viewers, self._entities(),
            hear=lambda receivers, time: self.winds.heard(receivers, time=time),
            painter=self._current_painter,
            bodies=lambda time: flying(self.world, self.height_at, self.winds.quarantine, time=time),
        )  # fmt: skip

    def _entities(self) -> PatchEntities:
        return PatchEntities(self.world, self.clearings, self.site.representations)

    def _current_painter(self) -> Painter:
        assert self.painter is not None
        return self.painter

    def _look(self, seen: View, viewer: str) -> Outlook:
        outlook = self.viewers.looking(viewer)
        outlook.look(seen, time=self.time, leap=LEAP * self.site.ground.patch)
        return outlook

    def _settle_on(self, before: Site) -> None:
        """Let viewers and systems go on with a site that was found again; what a game has replaced stays."""
        if self.site is before:
            return
        for outlook in self.viewers.values():
            settle_on(outlook, self.site, before, self.world)
        built = self._assembled()
        for (_, name, old), (_, _, new) in zip(self._built, built, strict=True):
            if name in self.systems and self.systems[name].run == old.run:
                self.systems.replace(name, new, trusted=True)
        self._built = built

    def _count(self, outlook: Outlook, painter: Painter, draw_ms: float) -> None:
        width, depth = self.site.ground.terrain.size
        self.statistics.count(outlook, share=self.site.ground.patch**2 / (width * depth))
        self.statistics.systems_ms = dict(self.systems.milliseconds)
        self.statistics.draw_ms, self.statistics.draw_calls = draw_ms, painter.draw_calls
        self.statistics.blades_submitted = outlook.blades


def _places(xz: ArrayLike) -> Floats:
    places = np.asarray(xz, np.float32)
    if places.shape[-1:] != (2,) or not np.isfinite(places).all():
        raise ValueError(f"ground positions are finite (x, z) pairs, not an array of shape {places.shape}")
    return np.ascontiguousarray(places.reshape(-1, 2))
