"""The rivals before the same camera: their frame times, and the fidelity of their pictures."""

from collections.abc import Sequence

import numpy as np

from ...engine.gl.stream import release_all
from ...systems.reference import carpet_painter, draw_truth
from ..studio.errors import MachineError
from ..studio.take import SAMPLES
from ..studio.timing import timed
from .multisampled import Multisampled
from .rival import ByHand
from .still import Still
from .stroll import advance_to

HARD, SMOOTH = "by hand", "by hand, 4 samples a pixel"

WARM_UP = 3
"""Number of unmeasured draws of each."""


class Rivals:
    """Grass drawn by hand, with hard edges, and with smooth ones where the driver has enough samples."""

    def __init__(self, still: Still) -> None:
        self._still, self._ctx = still, still.studio.ctx
        prairie, size = still.studio.prairie, still.studio.take.size
        assert prairie.painter is not None
        self._carpet, self._outlook = carpet_painter(prairie.painter), prairie.viewers["main"]
        self._hand = ByHand(prairie.painter, prairie.site)
        self._fine = Multisampled(self._ctx, size)
        self.times: dict[str, list[float]] = {}
        for _ in range(WARM_UP):
            self.measure()
        self.times = {name: [] for name in self.times}

    def measure(self) -> None:
        """Draw this instant once in each way, and keep the times."""
        self._carpet.lay(self._outlook, None)
        self._add(HARD, timed(self._ctx, self._draw_hard))
        if self._fine.smooth:
            self._add(SMOOTH, timed(self._ctx, self._draw_smooth))

    def _add(self, name: str, took: float) -> None:
        self.times.setdefault(name, []).append(took)

    def _draw_hard(self) -> None:
        self._still.studio.begin()
        self._hand.draw(self._still.view, time=self._still.studio.prairie.time)

    def _draw_smooth(self) -> None:
        self._still.studio.begin()
        target = self._ctx.fbo
        self._fine.begin()
        self._hand.draw(self._still.view, time=self._still.studio.prairie.time)
        self._fine.resolve(target)

    def rows(self, ours: Sequence[float]) -> list[dict[str, object]]:
        """Return a row for each rival; `ours` are the times of the engine's frames [ms].

        The prairie moves on to the instant of `bench picture`, so that the values of `flip` compare with its values.
        """
        taken = {name: float(np.median(times)) for name, times in self.times.items()}
        flips = self._flips()
        return [
            {
                "name": name,
                "frame_ms": round(median, 3),
                "ratio": round(median / float(np.median(ours)), 3),
                "flip": flips.get(name),
            }
            for name, median in taken.items()
        ]

    def _flips(self) -> dict[str, float]:
        """Return the FLIP of each rival's picture against the reference; empty where pictures cannot be compared."""
        from .flip import MOMENT, evaluator, flip

        try:
            evaluator()
        except MachineError:
            return {}
        studio = self._still.studio
        advance_to(studio.prairie, MOMENT)
        self._still.draw()
        self._carpet.lay(self._outlook, None)
        pictures = {}
        for name, draw in ((HARD, self._draw_hard), (SMOOTH, self._draw_smooth)):
            if name in self.times:
                draw()
                pictures[name] = studio.read()
        reference = draw_truth(studio.prairie, *self._still.matrices, studio.take.size, samples=SAMPLES).picture
        return {name: round(flip(picture, reference), 5) for name, picture in pictures.items()}

    def release(self) -> None:
        """Give everything back."""
        release_all(self._fine, self._hand)
