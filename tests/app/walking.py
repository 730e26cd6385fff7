"""A player's actions at the window of a walk, and the picture in it. Modules that open windows are imported late."""

# ruff: noqa: PLC0415

import ctypes
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from tallgrass.app.window import Walk

SIZE = (160, 90)


def press(walk: "Walk", *names: str) -> None:
    from pyglet.window import key

    for name in names:
        walk.window.dispatch_event("on_key_press", getattr(key, name), 0)
        walk.window.dispatch_events()


def let_go(walk: "Walk", name: str) -> None:
    from pyglet.window import key

    walk.window.dispatch_event("on_key_release", getattr(key, name), 0)
    walk.window.dispatch_events()


def strike(walk: "Walk", digit: str) -> None:
    walk.window.dispatch_event("on_key_press", ord(digit), 0)
    walk.window.dispatch_events()


def click(walk: "Walk") -> None:
    walk.window.dispatch_event("on_mouse_press", 5, 5, 1, 0)
    walk.window.dispatch_events()


def seen(walk: "Walk") -> NDArray[np.uint8]:
    """Draw the window once more without moving, and return what is in it."""
    from pyglet import gl

    walk.window.switch_to()
    walk.on_draw()
    width, height = walk.window.get_framebuffer_size()
    data = (ctypes.c_ubyte * (3 * width * height))()
    gl.glReadBuffer(gl.GL_BACK)
    gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
    gl.glReadPixels(0, 0, width, height, gl.GL_RGB, gl.GL_UNSIGNED_BYTE, data)
    walk.window.flip()
    return np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1]


def winds(walk: "Walk") -> set[str]:
    return {source.primitive.kind for source in walk.prairie.winds.sources()}
