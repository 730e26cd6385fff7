"""A window to walk through a prairie in."""

from collections import deque
from collections.abc import Callable
from itertools import count
from math import inf, radians
from pathlib import Path
from statistics import median

import moderngl
import pyglet
from pyglet.window import key

from ..components.arrays import Floats
from ..engine.camera import Camera, camera_at, projection_matrix, view_matrix
from ..engine.scene import SceneError
from ..systems.govern import LONGEST
from ..systems.overlay.layers import LAYERS, Layer
from ..systems.overlay.overlay import Overlay
from ..systems.prairie import Prairie
from .display import no_window, suited_rate
from .overlay import HELP, Note, statistics_lines
from .saucer import Flight
from .studio.encode import picture_writer
from .studio.errors import InputError, MachineError
from .studio.offscreen import Offscreen
from .studio.studio import about, written
from .studio.take import Take
from .studio.walker import Ground, Move, moved, settled, start, toggled, turned
from .watch import Watch
from .weather import Raised, Weather

MOVES: dict[int, Move] = {
    key.W: "ahead", key.UP: "ahead", key.S: "back", key.DOWN: "back",
    key.A: "left", key.LEFT: "left", key.D: "right", key.RIGHT: "right",
    key.E: "up", key.Q: "down", key.LSHIFT: "run", key.RSHIFT: "run",
}  # fmt: skip
"""Motions of the viewer by held key."""

WINDS: dict[int, Raised] = {ord("1"): "gust", ord("2"): "whirlwind", ord("3"): "blast"}
"""Winds that keys set off where the camera looks; pyglet's names for these key codes are private."""

OVERLAYS: tuple[frozenset[Layer], ...] = (
    frozenset(),
    frozenset({"masks", "arrows"}),
    frozenset({"levels", "weights"}),
    frozenset({"map"}),
    frozenset(LAYERS),
)
"""Sets of overlays that one key cycles through."""

SENSITIVITY = 0.0022
"""Rotation of the view per pixel of mouse motion [rad]."""

LONGEST_STEP = 0.1
"""Longest time step of a frame [s]: after a pause of the whole program, the prairie does not leap."""

RATE = 120
"""Largest frame rate where the display sets none [1/s]."""

OURS = 0.9
"""Fraction of a frame's time for the prairie; the rest is for the window."""

PATIENCE = 6.0
"""Duration of a message on the screen [s]."""

GLANCE = 0.5
"""Interval at which the scene's files are checked for changes [s]."""

MOST_TOLD = 4
"""Largest number of a scene's problems that are shown."""


def open_window(size: tuple[int, int], /, *, fullscreen: bool = False) -> pyglet.window.Window:
    """Return a new window of this size [pixels]; raises MachineError with a sentence where none can be opened."""
    try:
        if fullscreen:
            return pyglet.window.Window(caption="tallgrass", fullscreen=True)
        return pyglet.window.Window(*size, caption="tallgrass", resizable=True)
    except Exception as error:  # pyglet's backends share no narrower one
        raise MachineError(no_window(error)) from error


class Walk:
    """A prairie in a window, and its viewer: a handler of pyglet's events.

    It owns the window and the prairie, and releases both when the window closes.
    """

    def __init__(self, window: pyglet.window.Window, prairie: Prairie, take: Take) -> None:
        self.window = window
        self.prairie = prairie
        self.take = take
        self.ctx = moderngl.create_context(require=330)
        self.walker = start(camera_at(prairie.scene.camera, None, prairie.height_at), self.ground)
        self.flight: Flight | None = None
        self.weather = Weather(prairie)
        self.overlay = Overlay(take.overlay)
        self.paused = False
        self.captured = False
        self.helping = False
        self.counting = False
        self.leaving = False
        self.closed = False
        self.keys: tuple[str, ...] = HELP
        self._held: set[int] = set()
        self.frames: deque[float] = deque(maxlen=60)
        """Intervals between the last frames [ms]."""
        self._age = 0.0
        self._message_at = 0.0
        self._watch = Watch(prairie.files.values())
        self._checked = 0.0
        self._top, self._bottom = Note(top=True), Note(top=False)
        self.tell(["F1 shows the keys"])
        window.push_handlers(self)

    @property
    def ground(self) -> Ground:
        """The ground of the prairie that is walked in."""
        site = self.prairie.site
        return Ground(self.prairie.height_at, site.ground.terrain.size, site.top_at)

    @property
    def camera(self) -> Camera:
        """The camera of this instant."""
        view = radians(self.prairie.scene.camera.view)
        return self.walker.camera(view) if self.flight is None else self.flight.camera(view, self.ground)

    def hold(self, rate: float | None = None) -> None:
        """Hold a frame rate [1/s] by drawing less; None is the rate that suits the machine, 0 is none."""
        chosen = suited_rate(self.ctx) if rate is None else rate
        self.prairie.governor.hold = min(OURS / chosen, LONGEST) if chosen else None

    def run(self, seconds: float | None = None) -> None:
        """Walk until the window closes: by the user, or after `seconds`."""
        pyglet.clock.schedule_interval(self.frame, 1.0 / RATE)
        if seconds is not None:
            pyglet.clock.schedule_once(self._time_is_up, seconds)
        try:
            pyglet.app.run(interval=None)
        finally:
            self.close()

    def frame(self, dt: float) -> None:
        """Move everything on by `dt` [s] and draw the window once, or close it if asked to."""
        if self.leaving:
            self.close()
        else:
            self.step(dt)
            self.window.draw(dt)

    def step(self, dt: float) -> None:
        """Move the viewer, and the prairie unless it is paused, on by `dt` [s]; at most by `LONGEST_STEP`."""
        self.frames.append(1000.0 * dt)
        self._age += dt
        if self._age - self._checked >= GLANCE:
            self._checked = self._age
            if self._watch.changed():
                self.reload()
        step = min(dt, LONGEST_STEP)
        held = {MOVES[symbol] for symbol in self._held}
        if self.flight is None:
            self.walker = moved(self.walker, held, step, self.ground)
        else:
            self.flight.step(held, step, self.ground)
        if not self.paused:
            self.prairie.advance(step)
            self.weather.settle()

    def tell(self, lines: list[str], *, lasting: bool = False) -> None:
        """Show a message for a while, or until there is another."""
        self._message_at = inf if lasting else self._age
        self._bottom.write(lines)

    def reload(self) -> None:
        """Read the scene again; if it is broken, keep the old one and show its problems until it is right."""
        self.go_on(self.prairie.reload)

    def go_on(self, read: Callable[[], None]) -> None:
        """Call `read`, which reads the scene's files again, and adapt to the new scene, or show its problems."""
        try:
            read()
        except SceneError as error:
            self.tell(_problem_lines(error), lasting=True)
            return
        self._watch.turn_to(self.prairie.files.values())
        self.settle()
        self.tell([f"{self.take.scene} is read again"])

    def settle(self) -> None:
        """Stand, or hover, on the ground as it is now."""
        self.walker = settled(self.walker, self.ground)
        if self.flight is not None:
            self.flight.settle(self.ground)

    def escape(self) -> None:
        """Let the mouse go, or else leave."""
        if self.captured:
            self._capture(caught=False)
        else:
            self.leaving = True

    def pause(self) -> None:
        """Stop the prairie's time, or start it again."""
        self.paused = not self.paused

    def fly(self) -> None:
        """Take off, or land; in a saucer, do nothing."""
        if self.flight is None:
            self.walker = toggled(self.walker)

    def board(self) -> None:
        """Fly a saucer, or leave it."""
        if self.flight is None:
            self.flight = Flight(self.prairie, self.walker, self.ground)
        else:
            self.walker, self.flight = self.flight.leave(self.ground), None

    def show_help(self) -> None:
        """Show the keys, or hide them."""
        self.helping = not self.helping

    def show_statistics(self) -> None:
        """Show the statistics of frames, or hide them."""
        self.counting = not self.counting

    def next_overlay(self) -> None:
        """Show the next set of overlays, or after the last one none."""
        known = self.overlay.layers in OVERLAYS
        number = OVERLAYS.index(self.overlay.layers) + 1 if known else 0
        self.overlay.layers = OVERLAYS[number % len(OVERLAYS)]
        self.tell(
            [f"shown: {', '.join(part for part in LAYERS if part in self.overlay.layers) or 'the prairie alone'}"]
        )

    def save_picture(self) -> None:
        """Write the picture, without overlays, as the next numbered PNG in the working folder."""
        size = self.window.get_framebuffer_size()
        if min(size) < 1:
            self.tell(["a window without pixels has no picture"])
            return
        stem = Path(self.take.scene).stem
        name = next(name for k in count(1) if not Path(name := f"tallgrass-{stem}-{k:03d}.png").exists())
        with Offscreen(size, self.ctx) as offscreen:
            offscreen.begin()
            governor = self.prairie.governor
            held, governor.hold = governor.hold, None
            self._draw_prairie(offscreen.size)
            governor.hold = held
            picture = offscreen.read()
        try:
            metadata = about(self.prairie.scene, self.take, time=self.prairie.time)
            picture_writer(name)(picture, {**metadata, "camera": written(self.camera)})
            self.tell([f"{name} is written"])
        except (InputError, OSError) as error:
            self.tell([str(error)])

    def close(self) -> None:
        """Give back the prairie and the window; a second time does nothing."""
        if self.closed:
            return
        self.leaving = self.closed = True
        pyglet.clock.unschedule(self.frame)
        pyglet.clock.unschedule(self._time_is_up)
        self.window.switch_to()
        self.overlay.release()
        self.prairie.release()
        self._top.release()
        self._bottom.release()
        self.window.close()

    def on_draw(self) -> None:
        """Draw the prairie, then the overlays."""
        self.window.clear()
        size = self.window.get_framebuffer_size()
        self._draw_prairie(size)
        self.overlay.draw(self.prairie, *self.matrices(size))
        self._write_notes()
        for note in (self._top, self._bottom):
            note.draw(*self.window.get_size())

    def on_key_press(self, symbol: int, modifiers: int) -> bool:
        """Hold a key down, or do its action; always handled, so that pyglet does not close the window on Escape."""
        if symbol in MOVES:
            self._held.add(symbol)
        elif symbol in _ACTIONS:
            getattr(self, _ACTIONS[symbol])()
        elif symbol in WINDS:
            self.weather.raise_wind(WINDS[symbol], self.camera, self.ground)
        return pyglet.event.EVENT_HANDLED

    def on_key_release(self, symbol: int, modifiers: int) -> None:
        """Let a key go."""
        self._held.discard(symbol)

    def on_mouse_press(self, x: int, y: int, button: int, modifiers: int) -> None:
        """Catch the mouse."""
        self._capture(caught=True)

    def on_mouse_motion(self, x: int, y: int, dx: int, dy: int) -> None:
        """Look around."""
        if self.captured:
            self.look(dx, dy)

    def look(self, dx: float, dy: float) -> None:
        """Turn the view for a motion of the mouse by (dx, dy) [pixels]."""
        right, up = dx * SENSITIVITY, dy * SENSITIVITY
        if self.flight is None:
            self.walker = turned(self.walker, right=right, up=up)
        else:
            self.flight.look(right=right, up=up)

    def on_mouse_drag(self, x: int, y: int, dx: int, dy: int, buttons: int, modifiers: int) -> None:
        """Look around with a button held as well."""
        self.on_mouse_motion(x, y, dx, dy)

    def on_deactivate(self) -> None:
        """Let go of everything when another window takes over."""
        self._held.clear()
        self._capture(caught=False)

    def on_close(self) -> bool:
        """Leave: the window closes with the next frame, when no event of its own is under way."""
        self.leaving = True
        return pyglet.event.EVENT_HANDLED

    def _time_is_up(self, dt: float) -> None:
        self.leaving = True

    def _capture(self, *, caught: bool) -> None:
        self.captured = caught
        self.window.set_exclusive_mouse(caught)

    def _draw_prairie(self, size: tuple[int, int]) -> None:
        self.prairie.draw(*self.matrices(size), depth="none")

    def matrices(self, size: tuple[int, int]) -> tuple[Floats, Floats]:
        """Return view and projection of this instant, (4, 4) each, for a picture of this size [pixels]."""
        camera = self.camera
        return view_matrix(camera), projection_matrix(camera.view, max(1, size[0]) / max(1, size[1]))

    def _write_notes(self) -> None:
        lines: list[str] = list(self.keys) if self.helping else []
        if self.counting:
            frame_ms = median(self.frames) if self.frames else 0.0
            lines += [""] * bool(lines)
            lines += statistics_lines(self.prairie.statistics, frame_ms=frame_ms, time=self.prairie.time)
        self._top.write(lines)
        if self._age - self._message_at > PATIENCE:
            self._bottom.write([])


_ACTIONS = {
    key.ESCAPE: "escape",
    key.SPACE: "pause",
    key.F: "fly",
    key.G: "board",
    key.F1: "show_help",
    key.F2: "next_overlay",
    key.F3: "show_statistics",
    key.F5: "reload",
    key.F12: "save_picture",
}
"""Names of the methods that keys call."""


def _problem_lines(error: SceneError) -> list[str]:
    lines = [line for problem in error.problems[:MOST_TOLD] for line in str(problem).splitlines()]
    more = len(error.problems) - MOST_TOLD
    return lines + ([f"and {more} more problems"] if more > 0 else [])
