"""A walk in which the scene is edited: the panel, and the mouse's actions on the ground."""

import logging
from dataclasses import replace

import pyglet
from pyglet.window import key, mouse

from ...components.arrays import Place
from ...engine.camera import View
from ...systems.prairie import Prairie
from ..overlay import HELP
from ..studio.take import Take
from ..watch import Watch
from ..weather import looked_at
from ..window import Walk
from . import events
from .brush import Brush
from .editor import Editor
from .gizmo import show_gizmo
from .grips import Grip, grip_at, grips_of, pulled
from .gui import Gui
from .history import Draft
from .panel import Panel
from .pick import Sight, nearest
from .rescue import Rescue, rescued

log = logging.getLogger("tallgrass")

NEAR = 14.0
"""Largest distance between pointer and grip at which the grip is taken [pixels]."""

KEYS = (
    "Ctrl S            save the scene",
    "Ctrl Z  Ctrl Y    undo, redo",
    "left button       take hold of a wind and pull it, or paint",
    "right button      look around",
)

UNSAVED = "what has changed is not saved: Ctrl S saves it, Escape once more leaves without"


class EditWalk(Walk):
    """A walk with a panel over it; the left button of the mouse is the editor's, the right one looks around."""

    def __init__(self, window: pyglet.window.Window, prairie: Prairie, take: Take) -> None:
        super().__init__(window, prairie, take)
        self.editor = Editor(prairie)
        self.gui = Gui(self.ctx)
        self.panel = Panel(self.editor)
        self.keys = (*KEYS, *(line for line in HELP if not line.startswith("mouse")))
        self._grip: Grip | None = None
        self._stroke: tuple[Place, Brush] | None = None
        self._pointer: tuple[float, float] = (-1.0, -1.0)
        self._dt = 0.0
        self._warned: Draft | None = None
        """The unsaved draft of the last warning."""
        self._rescue = Rescue()
        self._gave_up = False
        """Whether the user has left without saving, and was warned."""
        pen = self.editor.pen
        if left := rescued(pen.path, pen.folder):
            self.tell([f"{left[-1]} has what was not saved when the editor last ended"])

    def run(self, seconds: float | None = None) -> None:
        """Walk until the window closes; what is not saved by then stays in a copy, unless the user gave it up."""
        try:
            super().run(seconds)
        finally:
            kept = None if self._gave_up else self._rescue.keep(self.editor)
            if kept is not None:
                log.warning("what was not saved is in %s", kept)

    def step(self, dt: float) -> None:
        """Move on by `dt` [s], and take over what has grown since the last frame."""
        super().step(dt)
        self._dt = dt
        terrain = self.prairie.site.ground.terrain
        self.editor.step()
        self._rescue.step(self.editor, dt)
        if self.prairie.site.ground.terrain is not terrain:
            self.settle()
        self.editor.spot = looked_at(self.camera, self.ground, self.prairie.site.ground.terrain)

    def reload(self) -> None:
        """Read the scene again; unsaved changes stay until F5 discards them."""
        self._read_again(asked=False)

    def save(self) -> None:
        """Write the scene back."""
        self.panel.save()
        if self.editor.history.is_saved:
            self._watch = Watch(self.editor.loaded.paths.values())

    def escape(self) -> None:
        """Put the brush away, or leave; with unsaved changes only when asked twice."""
        if self.editor.brush is not None:
            self.editor.brush = None
        elif self._may_leave():
            super().escape()

    def close(self) -> None:
        """Release the panel, then the walk."""
        if not self.closed:
            self.window.switch_to()
            self.gui.release()
            self.editor.close()
        super().close()

    def on_draw(self) -> None:
        """Draw the prairie, and the panel over it."""
        super().on_draw()
        size = self.window.get_size()
        saved = self.editor.history.is_saved
        self.gui.begin(size, self.window.get_framebuffer_size(), self._dt)
        brush = self.editor.brush
        grips, pointed = (grips_of(self.editor), None) if brush is None else ([], self._pointed())
        show_gizmo(self.editor, self._sight(), grips, pointed)
        self.panel.show(list(self.frames))
        self.gui.end()
        if self.editor.history.is_saved and not saved:
            self._watch = Watch(self.editor.loaded.paths.values())

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        """Type into the panel, undo, redo or save; all else is the walk's."""
        typing = self.gui.wants_keys
        self.gui.use()
        events.tell_key(symbol, modifiers, down=True)
        if typing:
            return pyglet.event.EVENT_HANDLED
        if modifiers & key.MOD_ACCEL:
            if symbol == key.S:
                self.save()
            elif symbol == key.Z and not modifiers & key.MOD_SHIFT:
                self.editor.undo()
            elif symbol in (key.Y, key.Z):
                self.editor.redo()
            return pyglet.event.EVENT_HANDLED
        if symbol == key.F5:
            self._read_again(asked=True)
            return pyglet.event.EVENT_HANDLED
        return super().on_key_press(symbol, modifiers)

    def on_key_release(self, symbol: int, modifiers: int) -> None:
        """Release a key, here and in the panel."""
        self.gui.use()
        events.tell_key(symbol, modifiers, down=False)
        super().on_key_release(symbol, modifiers)

    def on_text(self, text: str) -> None:
        """Type into the panel."""
        if self.gui.wants_keys:
            events.tell_text(text)

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Take hold of whatever is under the pointer: the panel, a grip, a wind, or the grass."""
        self._point(x, y)
        events.tell_button(button, modifiers, down=True)
        if self.gui.wants_mouse or button != mouse.LEFT:
            return
        place = self._pointed()
        if self.editor.brush is not None and place is not None:
            brush = self.editor.brush.erasing() if modifiers & key.MOD_SHIFT else self.editor.brush
            self._stroke = place, brush
            self.editor.paint([place], brush)
        elif self.editor.brush is None:
            self._take_hold(place)

    def on_mouse_release(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Let go; the pull or the stroke becomes a step of its own."""
        self._point(x, y)
        events.tell_button(button, modifiers, down=False)
        if self._grip is not None or self._stroke is not None:
            self.editor.rest()
        self._grip = self._stroke = None

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Move the pointer."""
        self._point(x, y)
        super().on_mouse_motion(x, y, dx, dy)

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, modifiers: int) -> None:
        """Pull, paint, or look around."""
        self._point(x, y)
        place = self._pointed()
        if self._grip is not None and place is not None:
            pulled(self.editor, self._grip, place)
        elif self._stroke is not None and place is not None:
            start, brush = self._stroke
            self._stroke = place, brush
            self.editor.paint([start, place], brush)
        elif buttons & mouse.RIGHT and not self.gui.wants_mouse:
            self.look(dx, dy)

    def on_mouse_scroll(self, x: int, y: int, scroll_x: float, scroll_y: float) -> None:
        """Scroll the panel, or make the brush wider and narrower."""
        self._point(x, y)
        events.tell_wheel(scroll_x, scroll_y)
        brush = self.editor.brush
        if brush is not None and not self.gui.wants_mouse:
            radius = min(max(brush.radius * 1.15**scroll_y, 0.5), 50.0)
            self.editor.brush = replace(brush, radius=radius)

    def on_deactivate(self) -> None:
        """Let go of everything when another window takes over."""
        self._grip = self._stroke = None
        self.gui.use()
        events.let_go()
        self.editor.rest()
        super().on_deactivate()

    def on_close(self) -> bool:
        """Leave, or warn first of unsaved changes."""
        return super().on_close() if self._may_leave() else pyglet.event.EVENT_HANDLED

    def _may_leave(self) -> bool:
        history = self.editor.history
        may = history.is_saved or self._warned is history.now
        self._warned = history.now
        if may:
            self._rescue.drop()
            self._gave_up = True
        else:
            self.tell([UNSAVED])
        return may

    def _read_again(self, *, asked: bool) -> None:
        if not asked and not self.editor.history.is_saved:
            self.tell(
                [f"{self.take.scene} has changed: F5 reads it again, and what is not saved is gone"], lasting=True
            )
            return
        self.go_on(self.editor.read_again)

    def _point(self, x: float, y: float) -> None:
        self._pointer = x, y
        self.gui.use()
        events.tell_mouse(x, y)

    def _pointed(self) -> Place | None:
        """Return the ground position (x, z) [m] under the pointer; None on the panel and in the sky."""
        if self.gui.wants_mouse and self._grip is None and self._stroke is None:
            return None
        return self._sight().ground(self._pointer)

    def _sight(self) -> Sight:
        width, height = self.window.get_size()
        size = max(1, width), max(1, height)
        return Sight(size, View(*self.matrices(size)), self.prairie.site.ground.terrain)

    def _take_hold(self, place: Place | None) -> None:
        grips = grips_of(self.editor)
        found = nearest(self._pointer, self._sight().pixels_on_ground([each.place for each in grips]), NEAR)
        if place is None:
            self._grip = None
        else:
            self._grip = grip_at(self.editor, place) if found is None else replace(grips[found], place=place)
        self.editor.picked = None if self._grip is None else self._grip.number
