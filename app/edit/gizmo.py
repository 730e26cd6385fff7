"""Drawings on the ground while editing: outlines of masks, grips, and the brush's disc."""

from collections.abc import Sequence

import numpy as np
from imgui_bundle import imgui

from ...components.arrays import Doubles, Place
from ...systems.overlay.marks import on_ground
from ...systems.overlay.masks import masked
from ...systems.overlay.paint import wind_color
from .editor import Editor
from .grips import Grip, blowing_of
from .pick import Sight

FAR = 400.0
"""Largest distance from the eye at which outlines are drawn [m]."""

_RING = np.stack([trace(np.linspace(0.0, 2.0 * np.pi, 49)) for trace in (np.sin, np.cos)], axis=1)
_WHITE, _DARK, _GREEN = 0xFFFFFFFF, 0xB0101010, 0xFF60F0A0


def show_gizmo(editor: Editor, sight: Sight, grips: Sequence[Grip], pointed: Place | None) -> None:
    """Draw the picked wind's outline and all grips, or the brush's disc at `pointed`, inside a frame of the panel."""
    if editor.brush is None:
        if editor.picked_wind is not None:
            _outline(editor, sight)
        ends = _flipped(sight, sight.pixels_on_ground([end for grip in grips for end in (grip.middle, grip.place)]))
        for grip, (middle, end) in zip(grips, ends.reshape(-1, 2, 2), strict=True):
            _grip(editor, grip, middle, end)
    elif pointed is not None:
        places = np.array(pointed) + editor.brush.radius * _RING
        pixels = _flipped(sight, sight.pixels_on_ground(places.tolist()))
        _lines(np.concatenate([pixels[:-1], pixels[1:]], axis=1), _GREEN, 2.0)


def _outline(editor: Editor, sight: Sight) -> None:
    prairie, wind = editor.prairie, editor.picked_wind
    assert wind is not None
    x, _, z = sight.seen.eye
    winds, quarantine = blowing_of(prairie, wind), prairie.winds.quarantine
    for mask in masked(winds, quarantine, time=prairie.time, around=(x, z), far=FAR):
        ends = sight.pixels(on_ground(sight.terrain, mask.edge))
        _lines(_flipped(sight, ends).reshape(-1, 4), _packed(mask.color), 2.5)


def _grip(editor: Editor, grip: Grip, middle: Doubles, end: Doubles) -> None:
    if np.isnan(end).any():
        return
    canvas, at = imgui.get_background_draw_list(), imgui.ImVec2(*end.tolist())
    color = _packed(wind_color(editor.winds[grip.number]))
    if grip.kind == "turn":
        _lines(np.concatenate([middle, end])[None], color, 2.0)
    size = 5.5 if grip.number == editor.picked else 3.5
    canvas.add_circle_filled(at, size + 1.5, _DARK)
    canvas.add_circle_filled(at, size, color if grip.kind == "move" else _WHITE)


def _lines(ends: Doubles, color: int, width: float) -> None:
    """Draw lines with ends (x, y, x, y), shape (n, 4), whose two ends are both visible."""
    canvas = imgui.get_background_draw_list()
    for x0, y0, x1, y1 in ends[~np.isnan(ends).any(axis=1)].tolist():
        canvas.add_line(imgui.ImVec2(x0, y0), imgui.ImVec2(x1, y1), color, width)


def _flipped(sight: Sight, pixels: Doubles) -> Doubles:
    """Return pixels (n, 2) counted from the upper left, as imgui does."""
    return np.stack([pixels[:, 0], sight.size[1] - pixels[:, 1]], axis=1)


def _packed(color: tuple[float, float, float]) -> int:
    red, green, blue = (round(255.0 * part) for part in color)
    return 0xFF000000 | blue << 16 | green << 8 | red
