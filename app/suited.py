"""What suits the machine that a walk is drawn on."""

import moderngl

from ..engine.declared.quality import PRESETS
from ..engine.declared.scene import Scene
from ..engine.gl.rasteriser import draws_in_software

CARD_RATE, SOFTWARE_RATE = 60.0, 20.0
"""Frames per second that are held, with a graphics card and without one."""

SOFTWARE_PRESET = "low"
"""What is walked in without one, where a scene names a finer preset."""


def suited_rate(ctx: moderngl.Context, /) -> float:
    """Return how many frames a second are held by what a context is drawn with."""
    return SOFTWARE_RATE if draws_in_software(ctx) else CARD_RATE


def suited_preset(scene: Scene, ctx: moderngl.Context, /) -> str | None:
    """Return the preset that a scene is walked in by what a context is drawn with, None for the scene's own quality.

    A processor draws finer presets than `SOFTWARE_PRESET` too slowly to walk in. Numbers of a scene's own stay.
    """
    finer = list(PRESETS)[list(PRESETS).index(SOFTWARE_PRESET) + 1 :]
    return SOFTWARE_PRESET if draws_in_software(ctx) and scene.quality in finer else None
