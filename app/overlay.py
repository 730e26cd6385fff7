"""Texts over the picture in the window: help, statistics, messages."""

from collections.abc import Sequence

import pyglet

from ..systems.statistics import Statistics

HELP = (
    "W A S D, arrows   walk",
    "mouse             look around, once a click has caught it",
    "Shift             run",
    "F                 fly, or come down again",
    "Q  E              down and up, in flight",
    "G                 board a saucer (A and D turn it), or leave it",
    "1  2  3           gust, whirlwind, blast where you look",
    "Space             stop and start time",
    "F1                this help",
    "F2                how it works: winds, levels of detail, map, all",
    "F3                statistics",
    "F5                read the scene file again (as is done when it changes)",
    "F12               picture into this folder",
    "Escape            let the mouse go, then close",
)

FONTS = ["DejaVu Sans Mono", "Menlo", "Consolas", "Courier New", "monospace"]
_EDGE = 12
_PAPER = (12, 16, 10, 180)
_INK = (240, 240, 230, 255)


def statistics_lines(statistics: Statistics, /, *, frame_ms: float, time: float) -> list[str]:
    """Return the lines of the statistics overlay for the last frame; `frame_ms` is the interval between frames [ms]."""
    patches = ", ".join(f"{count} {name}" for name, count in statistics.patches.items())
    systems = ", ".join(f"{name} {spent:.2f}" for name, spent in statistics.systems_ms.items())
    drawn, seen = statistics.blades_submitted, statistics.blades_considered
    blades = f"{drawn} drawn of {seen} in view, {statistics.blades_field} in the field"
    fine = statistics.fineness
    rate = 1000.0 / frame_ms if frame_ms > 0.0 else 0.0
    return [
        f"frame      {frame_ms:.1f} ms, {rate:.0f} per second; time {time:.1f} s",
        f"pixels     {100.0 * fine.scale:.0f} % across and up; grass drawn in to {100.0 * fine.range:.0f} %",
        f"blades     {blades}",
        f"receivers  {statistics.receivers}",
        f"patches    {patches}",
        f"systems    {sum(statistics.systems_ms.values()):.2f} ms: {systems}",
        f"drawing    {statistics.draw_ms:.2f} ms, {statistics.draw_calls} draw calls",
    ]


class Note:
    """Lines of text on a dark ground at the top or the bottom of the window; hidden while it has none."""

    def __init__(self, *, top: bool) -> None:
        self._top = top
        self._paper = pyglet.shapes.Rectangle(0, 0, 1, 1, color=_PAPER)
        self._text = pyglet.text.Label(
            font_name=FONTS, font_size=11, color=_INK, anchor_x="left", anchor_y="top", multiline=True, width=10
        )
        self._lines: tuple[str, ...] = ()

    def write(self, lines: Sequence[str], /) -> None:
        """Show these lines, or with none of them, hide."""
        if tuple(lines) != self._lines:
            self._lines = tuple(lines)
            self._text.text = "\n".join(lines)

    def draw(self, width: int, height: int, /) -> None:
        """Draw into a window of this size, in pyglet's own coordinates."""
        if not self._lines:
            return
        self._text.width = max(10, width - 4 * _EDGE)
        self._paper.width = self._text.content_width + 2 * _EDGE
        self._paper.height = self._text.content_height + 2 * _EDGE
        self._paper.position = (_EDGE, height - _EDGE - self._paper.height if self._top else _EDGE)
        x, y = self._paper.position
        self._text.position = (x + _EDGE, y + self._paper.height - _EDGE, 0)
        self._paper.draw()
        self._text.draw()

    def release(self) -> None:
        """Give its GL objects back."""
        self._paper.delete()
        self._text.delete()
