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
from ..engine.declared.quality import PRESETS, Representation
from ..engine.declared.scene import LodName, Scene
from ..engine.gl.guest import host_context, kept, viewport
from ..engine.gl.homes import Homes
from ..engine.scene import LoadedScene, load_maps, read_scene
from ..engine.schedule import Phase, Schedule
from ..engine.terrain.sample import height_at
from ..engine.world import World
from .around.cone import discrete_distance, eye_of, inside_cone, view_cone
from .around.receivers import ReceiverEntities
from .around.window import cell_of
from .bodies.fly import flying
from .field import Field, blades_in_field, lay_out
from .lod import SLACK, part_of_change, schedule, wanted_representation, weights
from .painter import Painter
from .receive import blow, plant_shown_blades, plant_shown_strips
from .refine import refine
from .reload import laid_again
from .show.seen import Seen, look, see
from .around.transitions import SEAMLESS, Transitions
from .statistics import Statistics
from .stock.cache import cached_growth
from .tile import tile
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
        scene = loaded.scene
        quality = scene.numbers(preset)
        terrain, density = load_maps(loaded)
        growths = [
            cached_growth(kind, quality, seed=scene.seed + number) for number, kind in enumerate(scene.grass.values())
        ]
        self.scene: Scene = scene
        self.path = loaded.path
        self.lod: LodName = lod
        self.statistics = Statistics()
        self.field: Field = lay_out(scene, quality, terrain, density, growths, lod=lod, transitions=transitions)
        self.world = World(self.advance)
        self.painter: Painter | None = None
        self._painters: Homes[Painter] = Homes()
        self._groups: list[DrawingGroup] = []
        self.statistics.blades_field = blades_in_field(self.field)
        self._loaded = loaded
        self._preset = preset
        self._ctx = ctx
        self._clock = 0.0
        self._drawn_at: float | None = None
        self._receivers = ReceiverEntities(self.world, self.field)
        self._released = False
        self._seen: Seen | None = None
        self.winds = Winds(self.world, self.field, live=live)
        self._schedule = self._systems()

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
        that takes too long; for a film it stays, however slow it is. Raises `SceneError` with every problem of the file
        and its maps, ValueError for an unknown preset or representation.
        """
        if preset is not None and preset not in PRESETS:
            raise ValueError(f"unknown preset '{preset}'; there are {', '.join(PRESETS)}")
        if lod not in get_args(LodName):
            raise ValueError(f"unknown representation '{lod}'; there are {', '.join(get_args(LodName))}")
        return cls(read_scene(scene), ctx=ctx, preset=preset, lod=lod, transitions=transitions, live=live)

    def reseeded(self, seed: int) -> "Prairie":
        """Return another prairie of the same scene, quality and terrain, with other grass."""
        scene = self.scene.model_copy(update={"seed": seed})
        return Prairie(
            replace(self._loaded, scene=scene), ctx=self._ctx, preset=self._preset, lod=self.lod,
            transitions=self.field.transitions, live=self.winds.quarantine.live,
        )  # fmt: skip

    @property
    def time(self) -> float:
        """The scene's time [s], to the nearest microsecond: however it was cut into steps, it is the same instant."""
        return round(self._clock, 6)

    @property
    def files(self) -> dict[str, Path]:
        """The scene's file and those that it names, by the names that it calls them."""
        return {self.path.name: self.path} | {name: self._loaded.folder / name for name in self._loaded.files}

    def advance(self, dt: float) -> None:
        """Move time on by `dt` [s]; negative or non-finite steps raise ValueError."""
        if not (np.isfinite(dt) and dt >= 0.0):
            raise ValueError(f"a prairie advances by 0 s or more, not by {dt}")
        self._clock += dt
        self.winds.quarantine.let_back(self.time)

    def draw(self, view: object, projection: object, *, held: bool = False) -> None:
        """Draw the prairie into the framebuffer that is bound, and leave the host's GL state as it was.

        Ground, carpet and the nearest blades write depth; strips and other blades only test it. So a game draws its
        own opaque things before the prairie, and its 2D after it.

        With `held`, every patch is shown as the frame before showed it, though seen from where the viewer is now and
        in the wind of now: it is the next frame without its changes of representation, to measure those.

        Both matrices are 4x4 numpy arrays for column vectors, or `pyglet.math.Mat4`. Raises ValueError for others, and
        RuntimeError after `release` or without a window. Where the viewport has no pixels, nothing happens at all.
        """
        if self._released:
            raise RuntimeError("this prairie has been released: load it again to draw it")
        seen = view_of(view, projection)
        with kept():
            ctx = host_context(self._ctx)
            if 0 in viewport(ctx)[2:]:
                return
            self.painter = self._painters.here(ctx, partial(Painter, field=self.field))
            self._draw(self.painter, seen, held=held)

    def _draw(self, painter: Painter, seen: View, *, held: bool) -> None:
        if painter.field is not self.field:
            painter.change(self.field)
        if held and self._seen is not None:
            self.field.sight.eye, self.field.sight.cone = eye_of(seen), view_cone(seen)
            self._wind()
            self._gather()
        else:
            self._look(seen)
            self._schedule.run()
        start = perf_counter()
        painter.draw(seen)
        self._count(1000.0 * (perf_counter() - start))

    def follow(self, view: object, projection: object) -> None:
        """Follow a viewer for a frame as `draw` does, without drawing it and without any GL.

        Patches come, go and change their representation as they would have, so that a film can start in its middle.
        The matrices are those of `draw`, and it raises the same errors.
        """
        if self._released:
            raise RuntimeError("this prairie has been released: load it again to follow a viewer")
        self._look(view_of(view, projection))
        self._schedule.run(last=Phase.SEE)

    def _look(self, seen: View) -> None:
        sight, patch, eye = self.field.sight, self.field.quality.patch, eye_of(seen)
        sight.way = float(np.hypot(eye[0] - sight.eye[0], eye[2] - sight.eye[2]))
        sight.jumped = sight.way > LEAP * patch
        sight.eye, sight.cone = eye, view_cone(seen)
        sight.centre = cell_of(np.array([eye[0], eye[2]], np.float32), patch=patch)
        sight.dt = 1e9 if self._drawn_at is None else self.time - self._drawn_at
        self._drawn_at = self.time

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
        return height_at(self.field.terrain, _places(xz))

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
        winds that have not changed blow on as if nothing had happened; so do those that were added. Raises
        `SceneError` with every problem, and then nothing has changed at all; RuntimeError after `release`, and while
        another esper world is current.
        """
        if self._released:
            raise RuntimeError("this prairie has been released: load it again")
        self.winds.sources()
        loaded = read_scene(self.path if scene is None else scene)
        field, before = laid_again(self.field, self._loaded, loaded, preset=self._preset, lod=self.lod), self.field
        if field.blades is not before.blades:
            self._receivers.release()
            self._receivers, self._seen = ReceiverEntities(self.world, field), None
        if field.table is not before.table:
            for entity in before.table.entity[before.table.entity != 0].tolist():
                self.world.delete(entity)
        self.winds.change(field)
        self.scene, self.path, self.field, self._loaded = loaded.scene, loaded.path, field, loaded
        self.statistics.blades_field = blades_in_field(field)

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
        self._schedule.systems.clear()

    def _systems(self) -> Schedule:
        plan = Schedule()
        systems: tuple[tuple[Phase, str, Callable[[], None]], ...] = (
            (Phase.TILE, "tile", self._tile),
            (Phase.SEE, "cull", self._cull),
            (Phase.SEE, "lod", self._lod),
            (Phase.BLOW, "plant", self._plant),
            (Phase.BLOW, "wind", self._wind),
            (Phase.DRAW, "gather", self._gather),
        )
        for phase, name, system in systems:
            plan.add(phase, name, system)
        return plan

    def _tile(self) -> None:
        field = self.field
        tile(
            field.table, field.sight.centre, field.terrain, self.world,
            patch=field.quality.patch, seed=field.scene.seed, models=field.quality.models,
        )  # fmt: skip
        field.table.distance[:] = discrete_distance(field.table.cell, field.sight.centre)

    def _cull(self) -> None:
        table, sight, patch = self.field.table, self.field.sight, self.field.quality.patch
        middles = (table.cell + np.float32(0.5)) * np.float32(patch)
        self._was_visible = table.visible.copy()
        radius = patch * 0.7072 + self.field.sway
        table.visible[:] = inside_cone(middles, apex=(sight.eye[0], sight.eye[2]), cone=sight.cone, radius=radius)

    def _lod(self) -> None:
        field = self.field
        table, sight, transitions = field.table, field.sight, field.transitions
        slack = SLACK if transitions.hysteresis else 0
        was_visible = self._was_visible & table.visible & (not sight.jumped)
        held = np.where(was_visible, table.representation, np.int8(-1))
        wanted = wanted_representation(table.distance, held, reach=field.reach, slack=slack)
        part = part_of_change(sight.dt, way=sight.way, patch=field.quality.patch)
        before = table.representation.copy()
        schedule(table, wanted, was_visible & transitions.gradual, reach=field.reach, part=part)
        weight = weights(table)
        refine(field, was_visible, weight, part=part)
        self._seen = see(field, look(field, weight))
        changed = (table.progress < 1.0) | ((before != table.representation) & was_visible)
        self.statistics.transitions = int((table.alive & table.visible & changed).sum())

    def _plant(self) -> None:
        field, seen = self.field, self._seen
        assert seen is not None
        plant_shown_blades(field, seen.standing)
        for ring, shown in enumerate(seen.strips):
            plant_shown_strips(field, ring, shown)
        self._receivers.follow(seen.standing, seen.strips)

    def _wind(self) -> None:
        assert self._seen is not None
        field, table, sight, patch = self.field, self.field.table, self.field.sight, self.field.quality.patch
        middles = (table.cell + np.float32(0.5)) * np.float32(patch)
        radius = 2.0 * patch + field.sway
        near = inside_cone(middles, apex=(sight.eye[0], sight.eye[2]), cone=sight.cone, radius=radius)
        rows = np.flatnonzero(table.alive & near)
        table.message[:] = 0.0  # what is seen of a frame follows from it alone, not from where one looked before
        hear = partial(self.winds.heard, time=self.time)
        self.statistics.receivers = len(blow(field, self._seen.standing, self._seen.strips, hear, carpet=rows))

    def _gather(self) -> None:
        assert self.painter is not None
        assert self._seen is not None
        self.statistics.blades_submitted = self.painter.write_blades(self._seen)
        self.painter.write_strips(self._seen)
        self.painter.write_ground(self._seen.looks.carpet)
        bodies = flying(self.world, self.height_at, self.winds.quarantine, time=self.time)
        self.painter.write_bodies(bodies)

    def _count(self, draw_ms: float) -> None:
        assert self.painter is not None
        stats, table = self.statistics, self.field.table
        visible = table.alive & table.visible
        stats.systems_ms = dict(self._schedule.milliseconds)
        stats.draw_ms = draw_ms
        stats.draw_calls = self.painter.draw_calls
        width, depth = self.field.terrain.size
        share = stats.blades_field * self.field.quality.patch**2 / (width * depth)
        stats.blades_considered = round(share * int(visible.sum()))
        stats.patches = {
            level.name.lower(): int((visible & (table.representation == level)).sum()) for level in Representation
        }


def _places(xz: ArrayLike) -> Floats:
    places = np.asarray(xz, np.float32)
    if places.shape[-1:] != (2,) or not np.isfinite(places).all():
        raise ValueError(f"ground positions are finite (x, z) pairs, not an array of shape {places.shape}")
    return np.ascontiguousarray(places.reshape(-1, 2))
