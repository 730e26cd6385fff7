"""One step of one system of a prairie, and what has to stand before it."""

from ..engine.camera import Camera, camera_at, projection_matrix, view_matrix
from ..engine.schedule import Phase
from ..systems.prairie import Prairie
from .little import ASPECT
from .looking import must_be_camera


def watch(prairie: Prairie, camera: Camera | None = None, /) -> None:
    """Let a viewer stand in a prairie for a frame, without drawing it and without any GL.

    `camera` is where, as `looking` makes one; without it the scene's own. Afterwards patches are where they are due,
    in the representation that they are due in. TypeError for what is no camera, RuntimeError after `release`.
    """
    if camera is not None:
        must_be_camera(camera)
    seen = camera_at(prairie.scene.camera, None, prairie.height_at) if camera is None else camera
    prairie.follow(view_matrix(seen), projection_matrix(seen.view, ASPECT))


def step(prairie: Prairie, which: Phase | str, /) -> None:
    """Run one system of a prairie once, by its name, or all those of one phase, and nothing else.

    The names are those of `prairie.systems`; tile, cull, lod, transition, see, plant, wind, gather and draw come along.
    What earlier systems leave behind has to be there: `watch` does what comes before `Phase.BLOW`, and a picture has
    to be drawn before `Phase.DRAW`. Raises KeyError for a name that is none, RuntimeError where something is missing.
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
