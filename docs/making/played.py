"""`python played.py PROGRAM PICTURE FRAMES`: plays an example without a window, and keeps its last picture."""

import runpy
import sys

import pyglet

pyglet.options.headless = True


def main(program: str, picture: str, frames: str) -> None:
    """Play a program for some frames of 1/60 s, and write what its window showed last."""
    from pyglet.window import Window

    flip = Window.flip

    def keep(window: Window) -> None:
        pyglet.image.get_buffer_manager().get_color_buffer().save(picture)
        flip(window)

    Window.flip = keep
    sys.argv = [program, "--frames", frames]
    runpy.run_path(program, run_name="__main__")


if __name__ == "__main__":
    main(*sys.argv[1:])
