"""Ground that streams: its window goes with those who look."""

from collections.abc import Iterable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass

from ..components.viewer import Viewer
from ..engine.terrain.blocks import Blocks, Numbers
from ..engine.terrain.record import Terrain
from ..engine.terrain.stream import paste, window_of
from .show.carpet.found import Found

GOES, WAITS = 0.75, 2.0
"""How far off the middle of the window viewers come before it goes on, and before a frame waits for it [steps]."""

APART = 0.25
"""How far off the middle of all viewers one is shown ground at most, of the window's width."""

LATELY = 1.0
"""How long ago others have looked at most for the window to go with them [s]: nobody closes a map or a mirror."""

Eye = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class _Asked:
    """A window that is being made."""

    window: "Future[Terrain]"
    first: Numbers
    before: dict[Numbers, object]
    """What had been changed of the ground when it was asked for."""


class Streaming:
    """Lets a ground's window go with its viewers: what is new of it is asked for on another thread."""

    def __init__(self, *, live: bool) -> None:
        self._live = live
        self._asked: _Asked | None = None
        self._hands = ThreadPoolExecutor(1, thread_name_prefix="tallgrass")  # without a thread, until it is asked

    def follow(self, terrain: Terrain, eye: Eye, others: Iterable[Viewer], /, *, time: float) -> None:
        """Let a terrain be the window about the middle of all who look, if it streams.

        Who looks now sees from `eye` (x, y, z) [m]. Others who are too far off do not count: they may have been left
        where they were, or come after in the same frame.
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
            self._asked = None
            return
        due = blocks.first_about(*place)
        waits = not self._live or off > WAITS
        if due == terrain.first:
            return
        if self._asked is None or (waits and self._asked.first != due):
            self._ask(blocks, due)
        assert self._asked is not None
        if waits or self._asked.window.done():
            self._take(terrain, blocks, self._asked, leaps=waits)
            self._asked = None

    def _off(self, terrain: Terrain, blocks: Blocks, place: tuple[float, float]) -> float:
        assert terrain.first is not None
        row, column = (at + blocks.cells // 2 for at in terrain.first)
        return max(abs(place[0] / blocks.cell - column), abs(place[1] / blocks.cell - row)) / blocks.step

    def _ask(self, blocks: Blocks, first: Numbers) -> None:
        self._asked = _Asked(self._hands.submit(_made, blocks, first), first, dict(blocks.changed))

    def _take(self, terrain: Terrain, blocks: Blocks, asked: _Asked, *, leaps: bool) -> None:
        made = asked.window.result()
        terrain.become(made, leaps=leaps)
        Found.of(made).attach(terrain)
        for square in {*asked.before, *blocks.changed}:
            if asked.before.get(square) is not blocks.changed.get(square):
                paste(blocks, terrain, square)

    def release(self) -> None:
        """Ask for nothing any more."""
        self._hands.shutdown(wait=False, cancel_futures=True)


def _made(blocks: Blocks, first: Numbers) -> Terrain:
    made = window_of(blocks, first)
    made.set_derived(Found.of(made))
    return made
