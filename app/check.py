"""Checking scene files, their maps included."""

from ..engine.scene import SceneError, load_maps, printable, read_scene


def check(scenes: list[str]) -> int:
    """Print every problem of every scene (paths or bundled names), or that it is ok.

    Returns the exit status: 0 when all are ok, 2 otherwise.
    """
    status = 0
    for scene in scenes:
        try:
            load_maps(read_scene(scene))
        except SceneError as error:
            print(error)
            status = 2
        else:
            print(f"{printable(scene)}: ok")
    return status
