"""`python played.py PROGRAM PICTURE FRAMES`: plays an example without a window, and keeps its last picture."""

import runpy
import sys
from typing import Any

import pyglet

from tallgrass.testing import fixed_clock

pyglet.options.headless = True

BITS = {"double_buffer": True, "depth_size": 24, "red_size": 8, "green_size": 8, "blue_size": 8}


def main(program: str, picture: str, frames: str) -> None:
    """Play a program for some frames of 1/60 s, and write what its window showed last."""
    from pyglet.window import Window

    config: Any = pyglet.gl.Config
    begin, flip, shown = Window.__init__, Window.flip, list[str]()

    def in_full_colour(window: Window, *args: Any, **keys: Any) -> None:
        # Without a window pyglet takes the first configuration that comes, which has 5 bits of red
        begin(window, *args, **{"config": config(**BITS)} | keys)

    def keep(window: Window) -> None:
        pyglet.image.get_buffer_manager().get_color_buffer().save(picture)
        shown.append(picture)
        flip(window)

    loop = pyglet.app.event_loop

    def step() -> float:
        clock.tick()
        loop.has_exit = len(shown) >= int(frames)
        return 0.0

    Window.__init__, Window.flip, Window.set_exclusive_mouse = in_full_colour, keep, lambda *_: None
    with fixed_clock() as clock:
        loop.clock, loop.idle = pyglet.clock.get_default(), step  # type: ignore[method-assign]
        runpy.run_path(program, run_name="__main__")


if __name__ == "__main__":
    main(*sys.argv[1:])
