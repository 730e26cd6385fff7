"""`tallgrass walk`: a window to walk in, with a panel or without."""

from ..systems.prairie import Prairie
from .display import need_display
from .studio.progress import busy
from .studio.take import Take


def walk_in(
    take: Take,
    /,
    *,
    fullscreen: bool = False,
    seconds: float | None = None,
    hold: float | None = None,
    edit: bool = False,
) -> None:
    """Open a window on a scene and return when it is closed: by the user, or after `seconds` by itself.

    So many frames a second as `hold` says are held; with None what suits the machine, with 0 none. With `edit`, a panel
    changes the scene. Raises `SceneError` where the scene is wrong, MachineError where no window can be opened, or no
    panel.
    """
    if edit:
        from .edit.need import need_panel

        need_panel()
    need_display()
    from .window import Walk, open_window

    kind = Walk
    if edit:
        from .edit.window import EditWalk

        kind = EditWalk
    with busy("growing the prairie"):
        prairie = Prairie.load(take.scene, preset=take.preset)
    walk = kind(open_window(take.size, fullscreen=fullscreen), prairie, take)
    walk.hold(hold)
    walk.run(seconds)
