"""`tallgrass walk`: a window to walk in, with a panel or without."""

from ..engine.scene.read import read_scene
from ..systems.prairie import Prairie
from .display import need_display, suited_preset
from .grow import grow_ahead
from .studio.errors import needed
from .studio.progress import busy
from .studio.take import Take


def walk_in(take: Take, /, *, fullscreen: bool, seconds: float | None, hold: float | None, edit: bool) -> None:
    """Open a window on a scene and return when it is closed: by the user, or after `seconds` by itself.

    `hold` is the frame rate to hold [1/s]: None is the one that suits the machine, 0 is none. Without a graphics card,
    presets finer than `low` become `low`, unless the take names one. With `edit`, a panel changes the scene. Raises
    `SceneError` where the scene is wrong, MachineError where no window can be opened, or no panel.
    """
    if edit:
        needed("imgui_bundle", "the panel of --edit is drawn by imgui-bundle", extra="edit")
    need_display()
    import moderngl

    from .window import Walk, open_window

    kind = Walk
    if edit:
        from .edit.window import EditWalk

        kind = EditWalk
    scene = read_scene(take.scene).scene  # reports a scene's problems before a window opens
    window = open_window(take.size, fullscreen=fullscreen)
    suited = None if edit or take.preset else suited_preset(scene, moderngl.create_context(require=330))
    grow_ahead(take.scene, preset=take.preset or suited)
    with busy("growing the prairie"):
        prairie = Prairie.load(take.scene, preset=take.preset or suited)
    walk = kind(window, prairie, take)
    if suited:
        walk.tell(["F1 shows the keys", f"no graphics card draws: quality {suited}, unless --preset says another"])
    walk.hold(hold)
    walk.run(seconds)
