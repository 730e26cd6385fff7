"""A prairie: the object that a game loads, advances and draws."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, get_args
from weakref import WeakKeyDictionary

import moderngl

from ..engine.camera import View, camera_at, projection_matrix, view_matrix, view_of
from ..engine.declared.parts import DEPTHS, as_parts
from ..engine.declared.quality import PRESETS, LodName
from ..engine.gl.guest import guest_view
from ..engine.handed import as_camera, must_be_a, must_be_flags, must_be_known, must_be_seed, must_be_viewer
from ..engine.plugged import bring_systems
from ..engine.scene import LoadedScene, SceneLike, must_be_read, read_again, read_scene
from ..engine.schedule import Phase, Schedule
from ..engine.world import World
from .around.asked import Frame
from .around.transitions import SEAMLESS, Transitions
from .assembly import Assembly, replace_built_in
from .brought import Brought
from .features import feature_of
from .govern import Governor
from .looking import Looking
from .painter import Painter
from .ripen import Ripening, Stage
from .saving import Saving
from .screen import Screen
from .seasons import Seasons
from .site import Site, found_again, found_site, settle_on
from .statistics import Statistics
from .tending import Tending
from .trees.feature import Trees

if TYPE_CHECKING:
    from pyglet.graphics import Batch, Group

    from ..engine.gl.batch import DrawingGroup


REHEARSAL = "tallgrass is prepared"
"""Name of the viewer for whom `prepare` rehearses a frame before anybody has looked."""


class Prairie(Tending):
    """A prairie in the current esper world. It grows when it is loaded, and draws once there is a GL context."""

    systems: Schedule
    """Schedule of the systems that make a frame for each viewer: read it, add to it, replace or leave out systems."""

    statistics: Statistics
    """Times and counts of the last frame."""

    loaded: LoadedScene
    """The scene, and the files that it was read from."""

    governor: Governor
    """The governor of the frame time; change its `hold` at any time."""

    def __init__(
        self, loaded: LoadedScene, *, ctx: moderngl.Context | None = None, preset: str | None = None,
        lod: LodName = "auto", transitions: Transitions = SEAMLESS, live: bool = True, hold: float | None = None,
        linear: bool = False,
    ) -> None:  # fmt: skip
        must_be_read(loaded)
        must_be_a(Transitions, transitions, "transitions are made as Transitions()")
        if ctx is not None:
            must_be_a(moderngl.Context, ctx, "ctx is a moderngl context")
        self.governor = Governor(hold)  # raises for a bad hold, so before any entities are made
        site = found_site(loaded, preset=preset, lod=lod, transitions=transitions)
        super().__init__(site, World(self.advance), live=live)
        self.loaded, self._preset = loaded, preset
        self._readings: WeakKeyDictionary[Site, LoadedScene] = WeakKeyDictionary()
        self._seasons = Seasons(loaded.scene)
        self._ripening = Ripening(self._seasons, live=live)
        self._looking = Looking(self.viewers, self.features, live=live)
        self.lod: LodName = lod
        self.statistics, self.systems = Statistics(blades_field=site.blades), Schedule(live, self.world.come_back)
        self._screen = Screen(ctx, self.features, self.winds, linear=linear)
        self._saving = Saving(
            self.world, self.winds, self.pressers, self._mown, self.clearings, self._shining,
            feature_of(Trees, self.features), self._seasons, brought := Brought(self.world),
        )  # fmt: skip
        self._assembly = Assembly(
            self.viewers, self._entities, self._messages_to, self._screen.current, self.governor, self.winds.acting,
            self.pressers.note, self.winds.bent,
        )  # fmt: skip
        self._built = self._assembly.on(self.site)
        for phase, name, system in self._built:
            self.systems.add(phase, name, system, trusted=True)
        bring_systems(self, self.world.come_back, brought.by)
        self._fix(Prairie)

    @classmethod
    def load(
        cls, scene: SceneLike, *, ctx: moderngl.Context | None = None, preset: str | None = None,
        lod: LodName = "auto", transitions: Transitions = SEAMLESS, live: bool = True, hold: float | None = None,
        linear: bool = False,
    ) -> "Prairie":  # fmt: skip
        """Return the prairie of a scene: a file, a bundled scene by its name, a mapping of keys, or a `Scene`.

        `ctx` is the context to draw in, by default the one that is current at the first draw. `preset` overrides the
        scene's quality. `lod` shows everything in one representation, and `transitions` turns off parts of changes;
        both are for measuring. A `live` prairie leaves out a plugin's wind that takes too long, and compiles programs
        ahead: at its first frame, or after it where the driver can in the background. Trees stay chosen in it for
        some frames. Others compile each program when it is first needed. `hold` is the longest time that a draw may
        take [s]; it draws less to keep to that. A `linear` prairie draws linear radiance, for a game with its own
        tone curve. Raises `SceneError` with every problem of the scene and its maps; ValueError for an unknown preset
        or representation, and for a `hold` that is no time.
        """
        must_be_known("representation", str(lod), get_args(LodName))
        must_be_flags(live=live, linear=linear)
        return cls(
            read_scene(scene), ctx=ctx, preset=preset, lod=lod, transitions=transitions, live=live, hold=hold,
            linear=linear,
        )  # fmt: skip

    def reseeded(self, seed: int) -> "Prairie":
        """Return a new prairie of the same scene, quality and terrain, with its grass grown from `seed`."""
        must_be_seed(seed)
        loaded = replace(self.loaded, scene=self.scene.model_copy(update={"seed": seed}))
        return Prairie(
            loaded, ctx=self._screen.ctx, preset=self.preset, lod=self.lod,
            transitions=self.site.transitions, live=self.winds.quarantine.live, linear=self._screen.linear,
        )  # fmt: skip

    @property
    def path(self) -> Path | None:
        """Path of the scene's file; None for a scene that a program has handed in."""
        return self.loaded.path

    @property
    def files(self) -> dict[str, Path]:
        """Paths of the scene's file, if it has one, and of the files that it refers to, by name."""
        return self.loaded.paths

    @property
    def preset(self) -> str | None:
        """Preset that overrides the scene's own quality, or None; a new one takes effect with the next `reload`.

        Setting it raises ValueError for an unknown preset.
        """
        return self._preset

    @preset.setter
    def preset(self, preset: str | None) -> None:
        self._must_be_there("choose another preset")
        must_be_known("preset", preset, PRESETS)
        self._preset = preset

    @property
    def painter(self) -> Painter | None:
        """The prairie's painter in the GL context that it was drawn in last; None before the first draw."""
        return self._screen.painter

    def draw(
        self, view: object, projection: object, *, viewer: str = "main", parts: Iterable[str] | None = None,
        depth: str = "near",
    ) -> None:  # fmt: skip
        """Draw the prairie into the bound framebuffer, and leave your GL state as it was.

        Draw your own opaque things before it, and 2D after it: ground, carpet and the nearest blades write depth,
        strips and other blades only test it. With a `depth` of "all" instead of "near", all grass writes depth where
        its coverage is at least half, for water, smoke or a sky that you draw later. "none" neither reads nor writes
        your depth: say so if nothing else in the picture has depth, as fewer pixels are then drawn more cheaply.

        Both matrices are 4x4 numpy arrays for column vectors, or `pyglet.math.Mat4`. Give each of several viewers a
        name. `parts` are some of "sky", "ground", "grass" and "beyond", by default the scene's. Without `ground` in
        this frame, grass is blended over your own by its coverage. Raises ValueError for other matrices, parts and
        depths; TypeError for a viewer that is no name and parts that are no list of names; RuntimeError after `release`
        or without a window. A viewport without pixels draws nothing.
        """
        self._must_be_there("draw it")
        self.systems.must_be_idle("draw it")
        must_be_viewer(viewer)
        must_be_known("depth", str(depth), DEPTHS)
        chosen = as_parts(self.scene.parts if parts is None else parts)
        seen = view_of(view, projection, self._origin)
        self._advance_kinds(lambda *sites: self._looking.stage(self._screen, *sites))
        before = self.viewers[viewer].frame if viewer in self.viewers else None
        frame, asked, goes_on = Frame(seen, self.time, self.site, chosen).after(before, depth=depth)
        if not goes_on:
            self._looking.follow(self.site, viewer, seen, time=self.time)
        with self._screen.opened(self.site) as painter:
            if painter is None:
                return
            outlook = self._looking.look(self.site, viewer, guest_view(seen), time=self.time, goes_on=goes_on)
            outlook.frame = frame
            outlook.note(asked)
            self.governor.begin(outlook, goes_on=goes_on)
            self.systems.run(first=Phase.DRAW if goes_on else Phase.INPUT)
            if self._released:  # by one of the systems
                return
            self.statistics.fineness = self.governor.fineness(viewer)
            self.statistics.count(outlook, self.site, self.systems, painter)
            if "grass" in chosen:
                outlook.settle()

    def draw_depth(self, view: object, projection: object, *, viewer: str = "main") -> None:
        """Draw grass into your shadow map: the depth of what a viewer was shown last, seen by the sun's matrices.

        Bind the map's framebuffer before. Blades and strips write depth where their coverage is at least half; thinner
        ones write a fraction of the pixels equal to their coverage. The carpet writes depth where its grass blocks
        light. The ground is left out, and so is grass that the viewer does not see. Matrices and errors are those of
        `draw`. For a viewer that was not drawn yet, nothing is drawn.
        """
        self._must_be_there("draw its depth")
        must_be_viewer(viewer)
        seen = view_of(view, projection, self._origin)
        before = self.viewers[viewer].frame if viewer in self.viewers else None
        if before is None or before.grown is not self.site:
            return
        with self._screen.opened(self.site) as painter:
            if painter is not None:
                painter.cast(guest_view(seen), self.viewers[viewer])

    def preparing(self) -> Iterator[tuple[int, int]]:
        """Do what `prepare` does step by step, for a loading screen; yield the steps done and their total number.

        Between steps GL state is yours. Keep the same context current. Raises the errors of `draw`.
        """
        self._must_be_there("prepare it")
        return self._screen.preparing(lambda: self.site, self._upload_rehearsal)

    def prepare(self, *, on_progress: Callable[[int, int], object] | None = None) -> None:
        """Upload and compile in the current context all that the scene and a game may need, so that no frame waits.

        This covers all installed winds and those that already blow, pressers, cuts, bodies and `hold`. First bind the
        framebuffer that you draw into and give your shadow maps: some drivers compile programs again for others.
        `on_progress` is called with the number of steps done and their total number. Raises the errors of `draw`.
        """
        for done, of in self.preparing():
            if on_progress is not None:
                on_progress(done, of)

    def follow(self, view: object, projection: object, *, viewer: str = "main") -> None:
        """Update a frame's state for a viewer as `draw` does, but draw nothing and use no GL.

        Patches come, go and change their representation, and the light follows the sun. So a film can start in its
        middle. Matrices and errors are those of `draw`.
        """
        self._must_be_there("follow a viewer")
        self.systems.must_be_idle("draw it")
        must_be_viewer(viewer)
        seen = view_of(view, projection, self._origin)
        self._advance_kinds()
        self._take(viewer, seen)
        self.systems.run(last=Phase.SEE)

    def group(
        self, batch: "Batch", camera: Callable[[], tuple[object, object]], *, order: int = 0,
        parent: "Group | None" = None, viewer: str = "main", parts: Iterable[str] | None = None,
        depth: str = "near",
    ) -> "DrawingGroup":  # fmt: skip
        """Add the prairie to a pyglet batch, and return its group.

        At each draw, `camera` is called for the view and projection matrices that `draw` takes. The prairie is drawn
        after groups of a lower `order` and before those of a higher one. A batch may have several groups, each with
        other `parts`. The group's `visible` shows or hides it; its `delete`, and `release`, remove it from the batch.
        Raises RuntimeError after `release`, TypeError for a camera that is no function, and what `draw` raises for a
        viewer, parts and depth. The batch raises TypeError if `camera` returns anything but two matrices.
        """
        self._must_be_there("put it into a batch")
        must_be_viewer(viewer)
        must_be_known("depth", str(depth), DEPTHS)
        asked, chosen = as_camera(camera), None if parts is None else as_parts(parts)

        def draw() -> None:
            self.draw(*asked(), viewer=viewer, parts=chosen, depth=depth)

        return self._screen.group(draw, batch, order, parent)

    def reload(self, scene: SceneLike | LoadedScene | None = None, *, site: Site | None = None) -> None:
        """Read the scene again, or another one, and continue with it at the present time; keep what did not change.

        Only terrain, kinds of grass and textures whose values, maps or preset have changed are made anew. Unchanged
        winds and those that you added blow on. Your changes to `systems` and to grass stay, and so do those to ground
        if the terrain is the same. With the `site` that `finding`'s function returned nothing has to grow here; the
        scene is then the one that the site was made for. Raises `SceneError` with every problem, and then nothing has
        changed; ValueError if there is no scene to read; TypeError for another `site`; RuntimeError after `release`,
        in a system, and while another esper world is current.
        """
        self._must_be_there("read it again")
        self.systems.must_be_idle("read it again")
        if site is not None and site not in self._readings:
            raise TypeError("site is what finding(...)() of this prairie returned, and nothing else")
        self.winds.sources()
        loaded = self._readings[site] if scene is None and site is not None else read_again(self.loaded, scene)
        self._replace_site(self.finding(loaded)() if site is None else site)
        self.loaded = loaded
        self._seasons.begin(loaded.scene)
        self._ripening.begin()

    def finding(self, scene: SceneLike | LoadedScene | None = None) -> Callable[[], Site]:
        """Read the scene again, or another one, and return a function that makes the `site` for `reload`.

        The function does not change the prairie. Call it on another thread, as growing takes a while, and give `reload`
        its result. Raises what `reload` raises for a scene; the function raises `SceneError` with every problem of the
        maps.
        """
        loaded = read_again(self.loaded, scene)
        before, shown = self.loaded, self.site

        def find() -> Site:
            site = found_again(shown, before, loaded, preset=self.preset, lod=self.lod)
            self._readings[site] = loaded
            return site

        return find

    def state(self) -> bytes:
        """Return all changes of a game as bytes for `restore`; ValueError for a wind whose class is not registered."""
        self._must_be_there("save it")
        return self._saving.state(self.site, time=self._clock)  # exactly, or sums of steps would differ later

    def restore(
        self, state: bytes, entities: Mapping[int, int] | None = None, *, partly: bool = False
    ) -> dict[int, int]:
        """Restore what `state` returned, and return a mapping from each of your entities in it to its entity now.

        These are entities with a wind, presser, lamp, shade or tree. `entities` maps those that exist already in the
        same way. Raises ValueError, and changes nothing, for a state that is damaged or does not fit the scene. If
        `partly`, what fits of a state of another version of the scene is restored, and the log says what does not.
        """
        self._must_be_there("restore a state")
        self._clock, became, kinds = self._saving.restore(state, self.site, self.loaded, entities, partly=partly)
        self.viewers.begin_anew()
        self._replace_site(self._ripening.resume(self.site, kinds))  # last, so that entities keep their winds
        self._advance_kinds()
        return became

    def release(self) -> None:
        """Free everything: GL objects in every window, groups in batches, entities, and what `install` added.

        The processor of `install` goes with its world's last prairie. This prairie cannot be drawn afterwards. If one
        of its systems calls this, the frame ends with that system, and nothing is drawn. Raises RuntimeError in a
        method of a wind.
        """
        self.winds.quarantine.must_be_idle("release it")
        self._released = True
        self._ripening.release()
        self._looking.release()
        for feature in self.features:
            feature.release()
        self._screen.release()
        self.world.release()
        self.systems.close()
        self._built.clear()

    def __del__(self) -> None:
        """Warn of a prairie that was drawn and then dropped, and have it released when another is drawn."""
        if "_screen" in vars(self):  # else it could not be loaded
            self._screen.release_later(self.release, self.loaded.path)  # `self.path` asks numpy, which may be gone

    def _advance_kinds(self, stage: Stage = lambda *_: True) -> None:
        """Advance changed kinds of grass to the present time; `stage` uploads what has grown anew."""
        site = self._ripening.step(self.site, self.time, stage)
        scene = self._seasons.scene_at(site.scene, self.time)
        if scene is not site.scene:
            site = replace(site, scene=scene)
        if site.growths is not self.site.growths:
            self._replace_site(site)
        else:
            self.site = site

    def _replace_site(self, site: Site) -> None:
        """Continue with another site; keep what has not changed."""
        before, self.site = self.site, site
        for outlook in self.viewers.values():
            settle_on(outlook, self.site, before, self.world)
        self._built, replaced = self._assembly.on(self.site), self._built
        replace_built_in(self.systems, self._built, replaced)
        for feature in self.features:
            feature.settle(self.site, before, time=self.time)
        self.statistics.blades_field = self.site.blades

    def _upload_rehearsal(self) -> None:
        """Upload a frame to rehearse, as a temporary viewer sees it by the scene's own camera."""
        camera = camera_at(self.scene.camera, None, self.height_at)
        seen = view_of(view_matrix(camera), projection_matrix(camera.view, 1.0))
        self._take(REHEARSAL, seen)
        for _, name, system in self._built:
            if name != "draw":
                system.run()
        self.viewers.forget(REHEARSAL)

    def _take(self, viewer: str, seen: View) -> None:
        """Let a viewer take a new view, without drawing."""
        self._looking.follow(self.site, viewer, seen, time=self.time)
        self._looking.look(self.site, viewer, seen, time=self.time)
