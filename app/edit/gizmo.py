"""What is drawn on the ground while one edits: outlines, grips, and the brush's disc."""

from collections.abc import Sequence

import numpy as np
from imgui_bundle import imgui

from ...systems.overlay.marks import on_ground
from ...systems.overlay.masks import masked
from ...systems.overlay.paint import wind_color
from .editor import Editor
from .grips import Grip, Place, blowing_of
from .pick import Doubles, Floats, pixels_of

FAR = 400.0
"""How far from the eye an outline is drawn [m]."""

_RING = np.linspace(0.0, 2.0 * np.pi, 49)
_WHITE, _DARK, _GREEN = 0xFFFFFFFF, 0xB0101010, 0xFF60F0A0


class Gizmo:
    """Draws on the picture of one frame, seen by two matrices (4, 4) on a window of a size [pixels]."""

    def __init__(self, editor: Editor, size: tuple[int, int], view: Floats, projection: Floats) -> None:
        self.editor, self.size, self.view, self.projection = editor, size, view, projection
        self._canvas = imgui.get_background_draw_list()

    def show(self, grips: Sequence[Grip], pointed: Place | None) -> None:
        """Draw the picked wind's outline and the grips, or the brush where it points at the ground (x, z) [m]."""
        if self.editor.brush is not None:
            if pointed is not None:
                self._ring(pointed, self.editor.brush.radius)
            return
        if self.editor.picked is not None and self.editor.picked < len(self.editor.winds):
            self._outline(self.editor.picked)
        for grip in grips:
            self._grip(grip)

    def pixels(self, places: Sequence[Place]) -> Doubles:
        """Return where ground positions (x, z) [m] are seen, in pixels from the lower left, shape (n, 2)."""
        flat = np.array(places, np.float32).reshape(-1, 2)
        return pixels_of(on_ground(self._terrain, flat), self.size, self.view, self.projection)

    @property
    def _terrain(self):  # noqa: ANN202
        return self.editor.prairie.site.ground.terrain

    def _outline(self, number: int) -> None:
        prairie, wind = self.editor.prairie, self.editor.winds[number]
        eye = np.linalg.inv(self.view.astype(np.float64))[:3, 3]
        masks = masked(
            blowing_of(prairie, wind), prairie.winds.quarantine, time=prairie.time,
            around=(float(eye[0]), float(eye[2])), far=FAR,
        )  # fmt: skip
        color = _packed(wind_color(wind))
        for mask in masks:
            ends = self._seen(on_ground(self._terrain, mask.edge).reshape(-1, 3)).reshape(-1, 4)
            for x0, y0, x1, y1 in ends[~np.isnan(ends).any(axis=1)].tolist():
                self._canvas.add_line(imgui.ImVec2(x0, y0), imgui.ImVec2(x1, y1), color, 2.5)

    def _grip(self, grip: Grip) -> None:
        places = [grip.place] if grip.kind == "move" else [grip.middle, grip.place]
        pixels = self._seen(on_ground(self._terrain, np.array(places, np.float32)))
        if np.isnan(pixels).any():
            return
        color = _packed(wind_color(self.editor.winds[grip.number]))
        at = imgui.ImVec2(*pixels[-1].tolist())
        if grip.kind == "turn":
            self._canvas.add_line(imgui.ImVec2(*pixels[0].tolist()), at, color, 2.0)
        picked = grip.number == self.editor.picked
        self._canvas.add_circle_filled(at, 7.0 if picked else 5.0, _DARK)
        self._canvas.add_circle_filled(at, 5.5 if picked else 3.5, color if grip.kind == "move" else _WHITE)

    def _ring(self, middle: Place, radius: float) -> None:
        places = np.array(middle) + radius * np.stack([np.sin(_RING), np.cos(_RING)], axis=1)
        pixels = self._seen(on_ground(self._terrain, places.astype(np.float32)))
        for start, end in zip(pixels[:-1].tolist(), pixels[1:].tolist(), strict=True):
            if not np.isnan([*start, *end]).any():
                self._canvas.add_line(imgui.ImVec2(*start), imgui.ImVec2(*end), _GREEN, 2.0)

    def _seen(self, points: Floats) -> Doubles:
        """Return points (n, 3) as imgui counts pixels, from the upper left, shape (n, 2)."""
        pixels = pixels_of(points, self.size, self.view, self.projection)
        return np.stack([pixels[:, 0], self.size[1] - pixels[:, 1]], axis=1)


def _packed(color: tuple[float, float, float]) -> int:
    red, green, blue = (round(255.0 * part) for part in color)
    return 0xFF000000 | blue << 16 | green << 8 | red
