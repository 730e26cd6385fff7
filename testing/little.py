"""A prairie so small that every test can grow one, its site to make systems from, and single steps of systems."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path

import moderngl
import numpy as np

from ..components.arrays import Floats
from ..components.patch import Clearings
from ..components.viewer import Viewer
from ..components.wind import WindPrimitive
from ..engine.camera import Camera, View, camera_at, projection_matrix, view_matrix
from ..engine.declared.quality import LodName
from ..engine.scene.compose import read_document
from ..engine.scene.read import LoadedScene, load_document
from ..engine.schedule import Phase, Schedule
from ..engine.terrain.sample import height_at
from ..engine.world import World
from ..systems.around.outlook import Outlook
from ..systems.around.transitions import SEAMLESS, Transitions
from ..systems.assembly import Assembly
from ..systems.blow import Hear
from ..systems.entities import PatchEntities
from ..systems.govern import Governor
from ..systems.painter import Painter
from ..systems.prairie import Prairie
from ..systems.site import Site, found_site, outlook_on
from ..systems.wind.blow import ReceiverArrays
from .stage import must_be_camera

LITTLE = """\
tallgrass: 2
seed: 5
terrain: { noise: rolling, seed: 2, size: [60, 60], feature: 30, scale: 4 }
grass:
  tall: { height: [0.5, 0.9], width: 0.02, root: "#5a5a2c", tip: "#dcc98f" }
  short: { height: [0.2, 0.4], width: 0.02, root: "#27401a", tip: "#8fae4a", stiffness: 2 }
camera: { position: [0, 20], eye: 1.7, pitch: -12, view: 45 }
quality:
  blades: 60
  models: 2
  blade_rings: [{ to: 1, segments: 3 }, { to: 2, segments: 2 }]
  strip_rings:
    - { to: 5, strips: 4, columns: 2, sections: 2, texel: 0.02 }
    - { to: 8, strips: 2, columns: 1, sections: 1, texel: 0.03 }
  carpet_to: 12
  carpet: 32
"""
"""Scene of two kinds of grass on 60 by 60 m of rolling ground, without wind; all three representations show."""

SPARSE = """\
tallgrass: 2
quality:
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.03 }]
  carpet_to: 12
  carpet: 32
"""
"""Beginning of scenes in which grass matters little: a quality that is grown quickly."""

ASPECT = 16 / 9
"""Aspect ratio (width over height) of a viewer's picture."""


@contextmanager
def little_prairie(
    *winds: WindPrimitive,
    scene: str = LITTLE,
    ctx: moderngl.Context | None = None,
    lod: LodName = "auto",
    transitions: Transitions = SEAMLESS,
) -> Iterator[Prairie]:
    """Grow a small prairie in the current esper world, and release it in the end.

    `winds` blow on it, in addition to those of `scene`, the text of a scene file; the default scene, `LITTLE`, has
    none. `ctx` is the context to draw in; the default is the one that is current at the first draw. `lod` and
    `transitions` are those of `Prairie.load`. Raises SceneError with every problem of the text.
    """
    prairie = Prairie(_loaded(scene), ctx=ctx, lod=lod, transitions=transitions)
    try:
        for wind in winds:
            prairie.add(wind)
        yield prairie
    finally:
        prairie.release()


@lru_cache(maxsize=8)
def little_site(scene: str = LITTLE) -> Site:
    """Return the ground, the grown kinds and the representations of a scene, the text of a scene file.

    Systems are made from it. It is grown once for all tests, so do not change it. Raises SceneError with every problem
    of the text.
    """
    return found_site(_loaded(scene))


def _loaded(scene: str) -> LoadedScene:
    return load_document(read_document(scene, file="<scene>"), Path("scene.yaml"))


def viewer_on(site: Site, world: World, camera: Camera | None = None, /, *, name: str = "main") -> Outlook:
    """Return the outlook of a viewer on a site, which has looked once; no system has run for it yet.

    `camera` is one of `looking`; the default is the scene's own.
    """
    viewer = Viewer(name)
    outlook = outlook_on(site, viewer, world.create(viewer))
    look(outlook, site, camera)
    return outlook


def look(outlook: Outlook, site: Site, camera: Camera | None = None, /, *, time: float = 0.0) -> None:
    """Let a viewer look from a camera, by default the scene's own, at a time [s]."""
    if camera is not None:
        must_be_camera(camera)
    seen = camera or camera_at(site.scene.camera, None, lambda xz: height_at(site.ground.terrain, xz))
    view = View(view_matrix(seen), projection_matrix(seen.view, ASPECT))
    outlook.look(view, time=time, leap=2.0 * site.ground.patch)


def systems_on(site: Site, outlooks: Sequence[Outlook], world: World, /, *, hear: Hear | None = None) -> Schedule:
    """Return a schedule of the built-in systems for some viewers on a site: `run(last=Phase.BLOW)` needs no GL.

    `hear` returns the messages (n, 2) of receivers at a time [s]; without it there is no wind.
    """
    schedule = Schedule()
    assembly = Assembly(outlooks, PatchEntities(world, Clearings()), hear or _calm, _no_painter, Governor())
    for phase, name, system in assembly.on(site):
        schedule.add(phase, name, system, trusted=True)
    return schedule


def _calm(receivers: ReceiverArrays, /, **_: float) -> Floats:
    return np.zeros_like(receivers.place)


def _no_painter() -> Painter:
    raise RuntimeError("this system draws: it needs a prairie that has a GL context")


def watch(prairie: Prairie, camera: Camera | None = None, /) -> None:
    """Let a viewer look at a prairie for a frame, without drawing and without any GL.

    `camera` is one of `looking`; the default is the scene's own. Afterwards all patches around the viewer are there, in
    their final representation. TypeError for anything but a camera, RuntimeError after `release`.
    """
    if camera is not None:
        must_be_camera(camera)
    seen = camera_at(prairie.scene.camera, None, prairie.height_at) if camera is None else camera
    prairie.follow(view_matrix(seen), projection_matrix(seen.view, ASPECT))


def step(prairie: Prairie, which: Phase | str, /) -> None:
    """Run once one system of a prairie, by its name, or all of one phase, and nothing else.

    The names are those of `prairie.systems`; tile, cull, lod, transition, see, plant, wind, gather and draw are built
    in. The results of earlier systems have to be there: `watch` does all before `Phase.BLOW`, and a picture has to be
    drawn before `Phase.DRAW`. Raises KeyError for an unknown name, RuntimeError where something is missing.
    """
    phase, name = (which, which.name) if isinstance(which, Phase) else (prairie.systems[which].phase, which)
    looking = list(prairie.viewers)
    if not looking:
        raise RuntimeError(f"'{name}' needs a viewer: call watch(prairie) first")
    if phase == Phase.DRAW and prairie.painter is None:
        raise RuntimeError(f"'{name}' needs a graphics context: draw the prairie first")
    for outlook in looking:
        outlook.viewer.time = prairie.time  # it may have moved on since they looked
    prairie.systems.step(which)
