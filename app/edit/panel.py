"""The panel over the prairie: the scene's keys, the brush, and the frame."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from imgui_bundle import imgui

from ...engine.plugins import wind_kinds
from ...systems.prairie import Prairie
from ..overlay import statistics_lines
from .editor import Editor
from .tree import Bounds, Tree, last_box, show_refusal

WIDTH = 400.0
"""Initial width of the panel [pixels]."""

_EDGE = 8.0

_HEIGHT = 20.0
_COLORS = {
    "INPUT": 0xFF808080,
    "TILE": 0xFF4FA66B,
    "SEE": 0xFFC08A3E,
    "BLOW": 0xFFD9B24A,
    "DRAW": 0xFF5A6FD0,
}
"""Colours of the phases, packed as imgui does: alpha, blue, green, red."""


class Panel:
    """The panel of an editor: it shows the scene, and passes changes on."""

    def __init__(self, editor: Editor) -> None:
        self.editor = editor
        self.tree = Tree(editor, wind_kinds().names())
        self.message = ""
        """Message of the last saving."""
        self.buttons: dict[str, Bounds] = {}
        """Boxes of buttons and tabs in the last frame, by name."""
        self._held = False
        self._picked: int | None = None
        self._size = (0.0, 0.0)
        """Size of the window in the last frame [pixels]."""

    def show(self, frames_ms: Sequence[float]) -> None:
        """Show the panel in the current frame; `frames_ms` are the last intervals between frames [ms]."""
        self._lay()
        imgui.set_next_window_bg_alpha(0.86)
        imgui.begin(f"{self.editor.pen.path.name}{'' if self.editor.history.is_saved else ' *'}###scene")
        self._menu()
        self._brush()
        if imgui.begin_tab_bar("tabs"):
            if self._tab("scene"):
                if self.editor.picked not in (self._picked, None):  # it was picked on the ground
                    self.tree.open(("wind", self.editor.picked))
                self._picked = self.editor.picked
                imgui.begin_child("keys")
                self.tree.show()
                imgui.end_child()
                imgui.end_tab_item()
            if self._tab("frame"):
                show_frame(self.editor.prairie, frames_ms)
                imgui.end_tab_item()
            imgui.end_tab_bar()
        imgui.end()
        self._settle()

    def save(self) -> None:
        """Save, and show which files were written."""
        self.message = self.editor.save()

    def _lay(self) -> None:
        """Lay the panel along the right edge of a window of another size; it then stays where it is dragged."""
        size = imgui.get_io().display_size
        when = imgui.Cond_.first_use_ever if (size.x, size.y) == self._size else imgui.Cond_.always
        self._size = size.x, size.y
        width = min(WIDTH, size.x / 2)
        imgui.set_next_window_pos(imgui.ImVec2(size.x - width - _EDGE, _EDGE), when)
        imgui.set_next_window_size(imgui.ImVec2(width, size.y - 2 * _EDGE), when)

    def _menu(self) -> None:
        history = self.editor.history
        for name, able, act in (
            ("save", not history.is_saved, self.save),
            ("undo", history.can_undo, self.editor.undo),
            ("redo", history.can_redo, self.editor.redo),
        ):
            imgui.begin_disabled(not able)
            if imgui.button(name):
                act()
            self._remember(name)
            imgui.end_disabled()
            imgui.same_line()
        message = self.message if history.is_saved else ""
        imgui.text_unformatted("growing ..." if self.editor.remaking.is_growing else message)
        refusal = self.editor.refusal
        if refusal is not None and refusal.way not in self.tree.boxes:
            show_refusal(refusal)

    def _brush(self) -> None:
        brush = self.editor.brush
        if brush is None:
            return
        imgui.separator_text(f"painting where {brush.kind} grows")
        imgui.set_next_item_width(170.0)
        _, radius = imgui.slider_float("radius", brush.radius, 0.5, 50.0, "%.3g m", imgui.SliderFlags_.logarithmic)
        imgui.set_next_item_width(170.0)
        _, density = imgui.slider_float("density", brush.density, 0.0, 1.0, "%.2f")
        imgui.set_next_item_width(170.0)
        _, pressure = imgui.slider_float("pressure", brush.pressure, 0.05, 1.0, "%.2f")
        _, alone = imgui.checkbox("other kinds make room", brush.alone)
        self.editor.brush = replace(brush, radius=radius, density=density, pressure=pressure, alone=alone)
        if imgui.button("done"):
            self.editor.brush = None
        self._remember("done")
        imgui.same_line()
        imgui.text_disabled("Shift takes the grass away")

    def _tab(self, name: str) -> bool:
        shown = bool(imgui.begin_tab_item(name)[0])
        self._remember(name)
        return shown

    def _settle(self) -> None:
        """End the step of a change when its field is released."""
        held = imgui.is_any_item_active()
        if self._held and not held:
            self.editor.rest()
        self._held = held

    def _remember(self, name: str) -> None:
        self.buttons[name] = last_box()


def show_frame(prairie: Prairie, frames_ms: Sequence[float]) -> None:
    """Show statistics, the last frames and the last timeline; `frames_ms` are the intervals between frames [ms]."""
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
    """Return begin and end of each system, and last of the drawing, as fractions of the frame in [0, 1]."""
    ends = np.cumsum([*milliseconds, draw_ms])
    whole = max(float(ends[-1]), 1e-9)
    starts = [0.0, *ends[:-1].tolist()]
    return [(start / whole, end / whole) for start, end in zip(starts, ends.tolist(), strict=True)]


def _timeline(prairie: Prairie) -> None:
    """Show a bar for each system, one below the other, each beginning at the end of the one before."""
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
