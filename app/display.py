"""Whether windows can be opened here, and what suits the machine that draws in them."""

import importlib
import os

import moderngl
import pyglet

from ..engine.declared.quality import PRESETS
from ..engine.declared.scene import Scene
from ..engine.gl.rasteriser import draws_in_software
from .studio.errors import MachineError

CARD_RATE, SOFTWARE_RATE = 60.0, 20.0
"""Frames per second that are held, with a graphics card and without one."""

SOFTWARE_PRESET = "low"
"""What is walked in without one, where a scene names a finer preset."""


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


def suited_rate(ctx: moderngl.Context, /) -> float:
    """Return how many frames a second are held by what a context is drawn with."""
    return SOFTWARE_RATE if draws_in_software(ctx) else CARD_RATE


def suited_preset(scene: Scene, ctx: moderngl.Context, /) -> str | None:
    """Return the preset that a scene is walked in by what a context is drawn with, None for the scene's own quality.

    A processor draws finer presets than `SOFTWARE_PRESET` too slowly to walk in. Numbers of a scene's own stay.
    """
    finer = list(PRESETS)[list(PRESETS).index(SOFTWARE_PRESET) + 1 :]
    return SOFTWARE_PRESET if draws_in_software(ctx) and scene.quality in finer else None
