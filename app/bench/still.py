"""A scene before its fixed camera, frame after frame."""

from contextlib import nullcontext
from functools import partial

import moderngl

from ...engine.camera import view_of
from ..studio.studio import Studio
from ..studio.take import Take
from ..studio.timing import spread, timed
from .machine import yardstick_ms

FRAMES = 60
"""Number of frames measured."""

WARM_UP = 40
"""Number of frames drawn before, unmeasured, until all patches have their entities."""

STEP = 1.0 / 60.0
"""Time between frames [s]."""


class Still:
    """A studio's scene before its fixed camera, warmed up."""

    def __init__(self, studio: Studio) -> None:
        self.studio = studio
        self.matrices = studio.matrices(studio.camera(None))
        self.view = view_of(*self.matrices)
        for _ in range(WARM_UP):
            self.draw()
            studio.prairie.advance(STEP)

    def draw(self) -> None:
        """Draw this instant."""
        self.studio.begin()
        self.studio.prairie.draw(*self.matrices)

    def hear(self) -> float:
        """Let all receivers hear the winds of this instant once more, and return the time that takes [ms]."""
        painter = self.studio.prairie.painter
        assert painter is not None
        return timed(self.studio.ctx, partial(painter.hear, self.view))

    def step(self, timer: moderngl.Query | None = None) -> float:
        """Draw the next frame, and return the time that takes [ms]; `timer` measures the graphics card meanwhile."""
        self.studio.prairie.advance(STEP)

        def frame() -> None:
            with timer or nullcontext():
                self.draw()

        return timed(self.studio.ctx, frame)


def still_frames(take: Take, /) -> dict[str, object]:
    """Return the times of a take's frames, of their systems, and of the yardstick [ms]."""
    times: list[float] = []
    systems: dict[str, list[float]] = {}
    with Studio(take) as studio:
        still = Still(studio)
        for _ in range(FRAMES):
            times.append(still.step())
            for name, milliseconds in studio.prairie.statistics.systems_ms.items():
                systems.setdefault(name, []).append(milliseconds)
    return {
        "cpu_ms": spread(times, 50, 95),
        "cpu_by_system_ms": {name: spread(each, 50)["p50"] for name, each in systems.items()},
        "yardstick_ms": yardstick_ms(),
    }
