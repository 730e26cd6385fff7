"""A site and a viewer on it, to make single systems from."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

import numpy as np

from ..components.arrays import Floats
from ..components.viewer import Viewer
from ..engine.camera import Camera, View, camera_at, projection_matrix, view_matrix
from ..engine.scene.compose import read_document
from ..engine.scene.read import LoadedScene
from ..engine.scene.validate import validate
from ..engine.schedule import Schedule
from ..engine.terrain.sample import height_at
from ..engine.world import World
from ..systems.around.clearing import Clearings
from ..systems.around.outlook import Outlook
from ..systems.assembly import built_in
from ..systems.blow import Hear
from ..systems.entities import PatchEntities
from ..systems.govern import Governor
from ..systems.painter import Painter
from ..systems.site import Site, found_site, outlook_on
from ..systems.wind.blow import ReceiverArrays
from .little import LITTLE
from .looking import must_be_camera

ASPECT = 16 / 9
"""Width over height of the picture that a viewer is taken to have."""


@lru_cache(maxsize=8)
def little_site(scene: str = LITTLE) -> Site:
    """Return the ground, the grown kinds and the representations of a scene, the text of a scene file.

    It is what systems are made from, and grown once for all tests: leave it as it is. Raises SceneError with every
    problem of the text.
    """
    document = read_document(scene, file="<scene>")
    declared = validate(document)
    return found_site(LoadedScene(declared, Path("scene.yaml"), Path(), document))


def viewer_on(site: Site, world: World, camera: Camera | None = None, /, *, name: str = "main") -> Outlook:
    """Return the outlook of a viewer who stands on a site and has looked once; no system has run for it yet.

    `camera` is where, as `looking` makes one; without it the scene's own.
    """
    viewer = Viewer(name)
    outlook = outlook_on(site, viewer, world.create(viewer))
    look(outlook, site, camera)
    return outlook


def look(outlook: Outlook, site: Site, camera: Camera | None = None, /, *, time: float = 0.0) -> None:
    """Let a viewer look from where a camera stands, the scene's own if none is given, at an instant [s]."""
    if camera is not None:
        must_be_camera(camera)
    seen = camera or camera_at(site.scene.camera, None, lambda xz: height_at(site.ground.terrain, xz))
    view = View(view_matrix(seen), projection_matrix(seen.view, ASPECT))
    outlook.look(view, time=time, leap=2.0 * site.ground.patch)


def systems_on(site: Site, outlooks: Sequence[Outlook], world: World, /, *, hear: Hear | None = None) -> Schedule:
    """Return a schedule of the built-in systems for some viewers on a site: `run(last=Phase.BLOW)` needs no GL.

    `hear` gives the messages (n, 2) of receivers at a time [s]; without it there is no wind.
    """
    schedule = Schedule()
    entities = PatchEntities(world, Clearings(), site.representations)
    parts = built_in(
        site, outlooks, entities, now=lambda _: (), hear=hear or _calm, painter=_no_painter, governor=Governor()
    )
    for phase, name, system in parts:
        schedule.add(phase, name, system, trusted=True)
    return schedule


def _calm(receivers: ReceiverArrays, /, *, time: float) -> Floats:
    del time
    return np.zeros_like(receivers.place)


def _no_painter() -> Painter:
    raise RuntimeError("this system draws: it needs a prairie that has a GL context")
