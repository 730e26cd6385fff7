"""Streaming ground: its window moves with the viewers."""

from collections.abc import Iterable
from concurrent.futures import Future
from dataclasses import dataclass

from ..components.arrays import Point
from ..components.viewer import Viewer
from ..engine.executor import DaemonExecutor
from ..engine.terrain.blocks import Blocks, Numbers
from ..engine.terrain.record import Terrain
from ..engine.terrain.stream import paste, window_of
from .show.carpet.found import Found

GOES, WAITS = 0.75, 2.0
"""Distance of viewers from the window's middle from which it moves, and from which a frame waits for it [steps]."""

APART = 0.25
"""Largest distance from the looking viewer to the middle of all at which the window follows that middle, over its
width."""

LATELY = 1.0
"""Time since their last look for which other viewers count [s]: games do not close the viewer of a map or a mirror."""


@dataclass(frozen=True, slots=True, eq=False)
class _Pending:
    """A window that is being made on another thread."""

    window: "Future[Terrain]"
    first: Numbers
    """Numbers (row, column) of its first sample."""

    before: dict[Numbers, object]
    """Changes of the ground when it was requested, by square."""


class Streaming:
    """Moves the window of streaming ground with its viewers; new windows are made on another thread."""

    def __init__(self, *, live: bool) -> None:
        self._live = live
        self._pending: _Pending | None = None
        self._executor = DaemonExecutor()

    def follow(self, terrain: Terrain, eye: Point, others: Iterable[Viewer], /, *, time: float) -> None:
        """Move a terrain's window towards the middle of all viewers, if it streams.

        The viewer that looks now sees from `eye` (x, y, z) [m]. If the middle is too far from it, only this viewer
        counts: the others may have been left behind, or follow later in the same frame.
        """
        blocks = terrain.blocks
        if blocks is None:
            return
        eyes = [eye, *(other.eye for other in others if abs(time - other.time) <= LATELY)]
        middle = [0.5 * (min(each) + max(each)) for each in zip(*eyes, strict=True)]
        most = APART * blocks.cells * blocks.cell
        x, _, z = middle if max(abs(middle[0] - eye[0]), abs(middle[2] - eye[2])) <= most else eye
        place = x, z
        off = self._off(terrain, blocks, place)
        if off <= GOES:
            self._pending = None
            return
        due = blocks.first_about(*place)
        waits = not self._live or off > WAITS
        if due == terrain.first:
            return
        if self._pending is None or (waits and self._pending.first != due):
            self._pending = _Pending(self._executor.submit(_made, blocks, due), due, dict(blocks.changed))
        if waits or self._pending.window.done():
            self._take_over(terrain, blocks, self._pending, leaps=waits)
            self._pending = None

    def _off(self, terrain: Terrain, blocks: Blocks, place: tuple[float, float]) -> float:
        """Return the distance of a place (x, z) [m] from the window's middle, along the farther axis [steps]."""
        assert terrain.first is not None
        row, column = (at + blocks.cells // 2 for at in terrain.first)
        return max(abs(place[0] / blocks.cell - column), abs(place[1] / blocks.cell - row)) / blocks.step

    def _take_over(self, terrain: Terrain, blocks: Blocks, pending: _Pending, *, leaps: bool) -> None:
        """Give a terrain the window that was made, with the changes of the ground made meanwhile."""
        made = pending.window.result()
        terrain.become(made, leaps=leaps)
        Found.of(made).attach(terrain)
        for square in {*pending.before, *blocks.changed}:
            if pending.before.get(square) is not blocks.changed.get(square):
                paste(blocks, terrain, square)

    def release(self) -> None:
        """Cancel what is pending, and make no more windows."""
        self._executor.release()


def _made(blocks: Blocks, first: Numbers) -> Terrain:
    made = window_of(blocks, first)
    made.derived = Found.of(made)
    return made
