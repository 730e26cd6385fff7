"""`python played.py PROGRAM PICTURE FRAMES`: plays an example without a window, and keeps its last picture."""

import runpy
import sys
from typing import Any

import pyglet

pyglet.options.headless = True

BITS = {"double_buffer": True, "depth_size": 24, "red_size": 8, "green_size": 8, "blue_size": 8}


def main(program: str, picture: str, frames: str) -> None:
    """Play a program for some frames of 1/60 s, and write what its window showed last."""
    from pyglet.window import Window

    config: Any = pyglet.gl.Config
    begin, flip = Window.__init__, Window.flip

    def in_full_colour(window: Window, *args: Any, **keys: Any) -> None:
        # Without a window pyglet takes the first configuration that comes, which has 5 bits of red
        begin(window, *args, **{"config": config(**BITS)} | keys)

    def keep(window: Window) -> None:
        pyglet.image.get_buffer_manager().get_color_buffer().save(picture)
        flip(window)

    Window.__init__, Window.flip = in_full_colour, keep
    sys.argv = [program, "--frames", frames]
    runpy.run_path(program, run_name="__main__")


if __name__ == "__main__":
    main(*sys.argv[1:])
