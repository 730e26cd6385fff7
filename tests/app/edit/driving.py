"""A walk with a panel, driven by mouse and key events. Modules that open windows are imported late."""

# ruff: noqa: PLC0415

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tallgrass.app.edit.pick import Sight
from tallgrass.app.edit.values import Way
from tallgrass.engine.camera import View

if TYPE_CHECKING:
    from tallgrass.app.edit.window import EditWalk

SIZE = (720, 480)
LEFT = 1

SCENE = """\
# A lawn with a whirlwind.
tallgrass: 2
seed: 5
terrain: { size: [60, 60] } # flat
grass:
  green: # short
    height: [0.3, 0.5]
    root: "#204010"
    tip: "#40a020"
wind:
  - kind: whirlwind # it stays
    position: [-2, 10]
    radius: 3
camera: { position: [5, 20], pitch: -25 }
light: { elevation: 40 } # high
quality:
  blades: 40
  models: 1
  blade_rings: [{ to: 1, segments: 2 }]
  strip_rings: [{ to: 3, strips: 2, columns: 1, sections: 1, texel: 0.02 }]
  carpet_to: 10
  carpet: 16
"""


def frames(walk: "EditWalk", count: int = 1, dt: float = 1 / 30) -> None:
    for _ in range(count):
        walk.frame(dt)
        if not walk.closed:
            walk.window.dispatch_events()


def tell(walk: "EditWalk", event: str, *arguments: object) -> None:
    walk.window.dispatch_event(event, *arguments)
    walk.window.dispatch_events()


def strike(walk: "EditWalk", name: str, *, ctrl: bool = False) -> None:
    from pyglet.window import key

    modifiers = key.MOD_CTRL if ctrl else 0
    tell(walk, "on_key_press", getattr(key, name), modifiers)
    tell(walk, "on_key_release", getattr(key, name), 0)
    frames(walk)


def drag(walk: "EditWalk", *places: tuple[float, float], modifiers: int = 0) -> None:
    """Press the left button at the first place [pixels from the lower left], pull it along the others, let go."""
    x, y = places[0]
    tell(walk, "on_mouse_motion", x, y, 0, 0)
    frames(walk)
    tell(walk, "on_mouse_press", x, y, LEFT, modifiers)
    frames(walk)
    for new_x, new_y in places[1:]:
        tell(walk, "on_mouse_drag", new_x, new_y, new_x - x, new_y - y, LEFT, modifiers)
        x, y = new_x, new_y
        frames(walk)
    tell(walk, "on_mouse_release", x, y, LEFT, modifiers)
    frames(walk)


def field(walk: "EditWalk", way: Way, part: float = 0.5) -> tuple[float, float]:
    """Return a place in the field of a key, at a fraction of its width [pixels from the window's lower left]."""
    left, top, right, bottom = walk.panel.tree.boxes[way]
    return left + part * (right - left), SIZE[1] - (top + bottom) / 2


def opened(walk: "EditWalk", *ways: Way) -> None:
    for way in ways:
        walk.panel.tree.open(way)
    frames(walk, 2)


def button(walk: "EditWalk", name: str) -> tuple[float, float]:
    left, top, right, bottom = walk.panel.buttons[name]
    return (left + right) / 2, SIZE[1] - (top + bottom) / 2


def on_ground(walk: "EditWalk", x: float, z: float) -> tuple[float, float]:
    """Return the pixel of a place on the ground, from the lower left."""
    sight = Sight(SIZE, View(*walk.matrices(SIZE)), walk.prairie.site.ground.terrain)
    ((right, up),) = sight.pixels_on_ground([(x, z)]).tolist()
    return right, up


def seen(walk: "EditWalk") -> NDArray[np.float64]:
    """Draw the prairie without panel and notes, and return the window's picture."""
    walk.window.switch_to()
    walk.window.clear()
    walk.prairie.draw(*walk.matrices(SIZE))
    return shown()


def shown() -> NDArray[np.float64]:
    """Return the current window's picture (height, width, 3)."""
    from pyglet.image import get_buffer_manager

    buffers: Any = get_buffer_manager()
    image = buffers.get_color_buffer().get_image_data()
    picture = np.frombuffer(image.get_data("RGBA"), np.uint8).reshape(image.height, image.width, 4)
    return picture[::-1, :, :3].astype(np.float64)
