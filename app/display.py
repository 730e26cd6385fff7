"""Finding out whether windows can be opened here."""

import importlib
import os

import pyglet

from .studio.errors import MachineError


def need_display() -> None:
    """Load what opens windows, before anything else imports it; raises MachineError where there is no display.

    pyglet checks every GL call for errors unless told not to; that is for tests, which set `PYGLET_DEBUG_GL`.
    """
    if "PYGLET_DEBUG_GL" not in os.environ:
        pyglet.options.debug_gl = False
    try:
        importlib.import_module("pyglet.window")
    except Exception as error:
        raise MachineError(no_window(error)) from error


def no_window(error: Exception, /) -> str:
    """Return the sentence that says that no window can be opened, and what to do instead."""
    why = str(error).replace('Cannot connect to "None"', "there is no display")
    return f"no window can be opened here ({why}); tallgrass shot and tallgrass film need none"
