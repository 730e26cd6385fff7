"""Whether windows can be opened, and the frame rate and preset that suit the machine."""

import importlib
import os
import sys

import moderngl
import pyglet

from ..engine.declared.quality import PRESETS
from ..engine.declared.scene import Scene
from ..engine.gl.rasteriser import draws_in_software
from .studio.errors import MachineError

CARD_RATE, SOFTWARE_RATE = 60.0, 20.0
"""Frame rates that are held with a graphics card, and without one [1/s]."""

DISPLAYS = "DISPLAY", "WAYLAND_DISPLAY"
"""Variables of the environment that name a Linux desktop's display."""

SOFTWARE_PRESET = "low"
"""Preset of a walk without a graphics card, in place of finer presets of scenes."""


def need_display() -> None:
    """Import pyglet's windows, before anything else does; raises MachineError where there is no display.

    pyglet checks every GL call for errors unless told not to; that is for tests, which set `PYGLET_DEBUG_GL`.
    """
    if "PYGLET_DEBUG_GL" not in os.environ:
        pyglet.options.debug_gl = False
    try:
        importlib.import_module("pyglet.window")
    except Exception as error:
        raise MachineError(no_window(error)) from error


def no_window(error: Exception, /) -> str:
    """Return a sentence on why no window can be opened, and on the alternatives."""
    why = "there is no display" if lacks_display() else error
    return f"no window can be opened here ({why}); tallgrass shot and tallgrass film need none"


def lacks_display() -> bool:
    """Return whether this is a Linux without a display; without one, libraries say all sorts of other things."""
    return sys.platform.startswith("linux") and not any(os.environ.get(name) for name in DISPLAYS)


def suited_rate(ctx: moderngl.Context, /) -> float:
    """Return the frame rate to hold [1/s] for a context's renderer."""
    return SOFTWARE_RATE if draws_in_software(ctx) else CARD_RATE


def suited_preset(scene: Scene, ctx: moderngl.Context, /) -> str | None:
    """Return the preset for a walk with a context's renderer, None for the scene's own quality.

    Software draws finer presets than `SOFTWARE_PRESET` too slowly to walk in. A scene's own numbers stay.
    """
    finer = list(PRESETS)[list(PRESETS).index(SOFTWARE_PRESET) + 1 :]
    return SOFTWARE_PRESET if draws_in_software(ctx) and scene.quality in finer else None
