"""The panel's view of a frame: what it holds, and which system takes how long of it."""

from collections.abc import Sequence

import numpy as np
from imgui_bundle import imgui

from ...systems.prairie import Prairie
from ..overlay import statistics_lines

_HEIGHT = 20.0
_COLORS = {
    "INPUT": 0xFF808080,
    "TILE": 0xFF4FA66B,
    "SEE": 0xFFC08A3E,
    "BLOW": 0xFFD9B24A,
    "DRAW": 0xFF5A6FD0,
}
"""Of each phase, as imgui packs them: alpha, blue, green, red."""


def show_frame(prairie: Prairie, frames_ms: Sequence[float]) -> None:
    """Show statistics, the last frames and the timeline of the last one; `frames_ms` is from frame to frame [ms]."""
    last = frames_ms[-1] if frames_ms else 0.0
    imgui.push_text_wrap_pos(0.0)
    for line in statistics_lines(prairie.statistics, frame_ms=last, time=prairie.time):
        imgui.text_unformatted(" ".join(line.split()))
    imgui.pop_text_wrap_pos()
    imgui.separator_text("frames")
    values = np.array(frames_ms or [0.0], np.float32)
    size = imgui.ImVec2(imgui.get_content_region_avail().x, 60.0)
    imgui.plot_lines("##frames", values, 0, f"{values.mean():.1f} ms", 0.0, float(values.max()) * 1.2 + 1e-3, size)
    imgui.separator_text("systems of the last frame")
    _timeline(prairie)


def spans_of(milliseconds: Sequence[float], draw_ms: float, /) -> list[tuple[float, float]]:
    """Return from where to where in the frame each system runs, and then the drawing, as parts of it in [0, 1]."""
    ends = np.cumsum([*milliseconds, draw_ms])
    whole = max(float(ends[-1]), 1e-9)
    starts = [0.0, *ends[:-1].tolist()]
    return [(start / whole, end / whole) for start, end in zip(starts, ends.tolist(), strict=True)]


def _timeline(prairie: Prairie) -> None:
    """Show a bar for each system, one below the other, each beginning where the one before it ends."""
    taken = prairie.statistics.systems_ms
    rows = [(each.name, each.phase.name, taken.get(each.name, 0.0)) for each in prairie.systems if each.name != "draw"]
    spans = spans_of([row[2] for row in rows], prairie.statistics.draw_ms)
    rows.append(("drawing", "DRAW", prairie.statistics.draw_ms))
    width, canvas = imgui.get_content_region_avail().x, imgui.get_window_draw_list()
    for (name, phase, spent), (start, end) in zip(rows, spans, strict=True):
        corner = imgui.get_cursor_screen_pos()
        left, right = corner.x + start * width, corner.x + max(end * width, start * width + 2.0)
        color = _COLORS.get(phase, 0xFF909090)
        canvas.add_rect_filled(imgui.ImVec2(left, corner.y), imgui.ImVec2(right, corner.y + _HEIGHT - 3.0), color, 2.0)
        canvas.add_text(imgui.ImVec2(corner.x + 2.0, corner.y + 1.0), 0xFFFFFFFF, f"{name}  {spent:.2f} ms")
        imgui.dummy(imgui.ImVec2(width, _HEIGHT))
        imgui.set_item_tooltip(f"{name}, in phase {phase}: {spent:.3f} ms")
