"""The gust: a strip that travels across its long axis, its profile the grass's own response (paper, section 3.3)."""

from bisect import bisect_right
from collections.abc import Sequence
from functools import lru_cache
from math import cos, radians, sin
from typing import ClassVar, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from ...components.arrays import Floats
from ...components.declaration import DeclarationError, Pair
from ...components.pose import Pose
from ...components.wind import Extent, Grass, TwinValues, WindPrimitive
from ...engine.camera import ahead
from ...engine.memo import by_identity
from .shape import rim, rim_width

LATEST = 36000.0
"""Least period after which the random series of repetitions recurs [s]."""

BENDS, LOWER = np.array((4.1, 1.7), np.float32), np.float32(0.6)
"""Scale of each of the two sine waves of the ragged front [m/rad]; height of the second relative to the first."""

MOST_KEPT = 64
"""Most repetitions of a gust that are kept in memory."""


class Gust(WindPrimitive):
    """A front of wind that crosses the prairie: grass bows as it arrives, holds, and swings back to rest behind it.

    Its own frame travels with the middle of the front.
    """

    twin: ClassVar[str | None] = "gust.glsl"
    color: ClassVar[tuple[float, float, float] | None] = (1.00, 0.90, 0.25)

    kind: Literal["gust"] = "gust"
    """A gust of wind."""

    priority: int = Field(default=10, ge=-1000, le=1000)
    """The highest priority at a place cancels the others; a gust's goes over a breeze's."""

    ease: float = Field(default=0.6, ge=0.0, le=60.0)
    """Time to set in and to die down [s]; a wind that starts at 0 is there from the beginning."""

    position: Pair = Field(default=[0.0, 0.0])
    """Ground position (x, z) of the front's middle where it sets out [m]."""

    direction: float = Field(default=90.0, ge=-360.0, le=360.0)
    """Where it travels and blows to, as a camera's yaw: 0 is -z, 90 is +x [degrees]."""

    width: float = Field(default=40.0, gt=0.1, le=10000.0)
    """Length of the front, across its travel [m]."""

    speed: float = Field(default=8.0, gt=0.1, le=60.0)
    """Speed at which it travels [m/s]."""

    reach: float = Field(default=80.0, gt=0.1, le=100000.0)
    """Distance that it travels [m]."""

    strength: float = Field(default=0.8, ge=0.0, le=1.0)
    """Posture index of the grass in it; grass first swings beyond it."""

    hold: float = Field(default=1.0, ge=0.0, le=60.0)
    """Time that it blows at a place before it lets go [s]."""

    tail: float = Field(default=3.0, gt=0.0, le=60.0)
    """Time that the grass behind it still swings [s]."""

    ragged: float = Field(default=1.5, ge=0.0, le=50.0)
    """Largest lag of parts of the front behind others [m]."""

    soft: float = Field(default=4.0, ge=0.0, le=1000.0)
    """Distance from its sides and ends over which it sets in, unless winds meet by priority [m]."""

    every: Pair | None = None
    """Shortest and longest time after which it comes again, at random; without it, it comes once [s]."""

    wander: float = Field(default=0.0, ge=0.0, le=10000.0)
    """Largest distance to either side of `position` at which it starts when it comes again [m]."""

    @model_validator(mode="after")
    def _sensible_intervals(self) -> Self:
        if self.every is not None and not 0.5 <= self.every[0] <= self.every[1] <= LATEST:
            raise DeclarationError(f"every must be [shortest, longest], rising, from 0.5 to {LATEST:g} s", "every")
        return self

    @property
    def life(self) -> float:
        """Time from setting out until its last grass is at rest again [s]."""
        return (self.reach + self.ragged) / self.speed + self.hold + self.tail

    def rates(self) -> tuple[float]:
        """Return its speed [m/s]."""
        return (self.speed,)

    def ends(self) -> float:
        """Return the time when its last grass is at rest again [s]; `inf` for one that repeats without end."""
        stop = super().ends()
        return stop if self.every is not None else min(stop, self.start + self._longest)

    @property
    def _longest(self) -> float:
        """Largest possible `life`, at the slowest speed that it has ever had [s]."""
        slowest = self.speed if self.course is None else self.course.slowest[0]
        return (self.reach + self.ragged) / slowest + self.hold + self.tail

    def is_on_its_way(self, time: float, /) -> bool:
        """Return whether it has set out at `time` [s] and not all of its grass is at rest again."""
        return self.start <= time and self._way(time) < self.speed * self.life

    def parts(self, *, time: float, seed: int) -> Sequence[WindPrimitive]:
        """Return the gusts on their way at `time` [s]: itself, or those of its repetitions that have set out."""
        if self.every is None:
            return (self,) if self.is_on_its_way(time) else ()
        waits, sides = _repetitions(seed, *self.every)
        once, period = len(waits) - 1, waits[-1]
        first, last = (_set_out(waits, time - self.start - past) for past in (self._longest, 0.0))
        known = _kept_repetitions(self)
        if len(known) > MOST_KEPT:
            known.clear()
        repetitions = (
            known.get((seed, k))
            or known.setdefault((seed, k), self._repeated(k // once * period + waits[k % once], sides[k % once]))
            for k in range(first, last)
        )
        return [each for each in repetitions if each.is_on_its_way(time)]

    def _repeated(self, wait: float, side: float) -> "Gust":
        heading, aside = radians(self.direction), self.wander * side
        x, z = self.position[0] + aside * cos(heading), self.position[1] + aside * sin(heading)
        return self.model_copy(update={"start": self.start + wait, "position": [x, z], "every": None})

    def pose(self, *, time: float) -> Pose:
        """Return the frame of the front's middle at `time` [s]."""
        heading, way = radians(self.direction), self._way(time)
        return Pose(*ahead((self.position[0], self.position[1]), heading, way), heading)

    def extent(self, *, time: float) -> Extent:
        """Return its rectangle: from the front back to where grass is at rest again."""
        way = self._way(time)
        depth = self.speed * (self.hold + self.tail) + self.ragged
        half, ahead = self.width / 2, max(0.0, way - self.reach)
        return Extent(-half, half, ahead, max(min(depth, way), ahead))  # at the very end rounding may swap its ends

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return 1 in the middle of the strip, falling to 0 at its edges over `soft` [m]."""
        held = self.extent(time=time)
        return rim(place[:, 0], held.left, held.right, self.soft) * rim(place[:, 1], held.ahead, held.behind, self.soft)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return its messages: the response over time, read as a profile from the front to the tail."""
        behind = place[:, 1] - self._lag(place[:, 0], seed)
        elapsed = behind / np.float32(self.speed)
        index = grass.after_start(elapsed) + grass.after_stop(elapsed - np.float32(self.hold)) - np.float32(1.0)
        fade = np.clip((np.float32(self.hold + self.tail) - elapsed) / np.float32(0.5 * self.tail), 0.0, 1.0)
        message = np.zeros((len(place), 2), np.float32)
        message[:, 1] = np.clip(-np.float32(self.strength) * index * fade, -1.0, 1.0)
        return message

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the strip's front and back, the widths of its rims [m], and the phases of its front's waves [rad]."""
        held = self.extent(time=time)
        side, end = rim_width(held.left, held.right, self.soft), rim_width(held.ahead, held.behind, self.soft)
        along = held.ahead, held.behind
        return TwinValues({"ahead_behind": along, "side": side, "end": end, "waves": _phases(seed)})

    def _way(self, time: float) -> float:
        """Return the distance that the front has travelled at `time` [s] [m]."""
        return self.phases(time=time, since=self.start)[0]

    def _lag(self, across: Floats, seed: int) -> Floats:
        """Return the lag of the front at each x, from 0 to `ragged` [m], shape (n,)."""
        first, second = (np.float32(phase) for phase in _phases(seed))
        wave = np.sin(across / BENDS[0] + first) + np.sin(across / BENDS[1] + second) * LOWER
        return np.asarray(
            np.float32(self.ragged) * (np.float32(0.5) + np.float32(0.5) * wave / (np.float32(1.0) + LOWER)), np.float32
        )


@by_identity(most=256)
def _kept_repetitions(_: Gust) -> dict[tuple[int, int], Gust]:
    """Return the store of a gust's repetitions, by seed and number."""
    return {}


@lru_cache(maxsize=256)
def _phases(seed: int) -> tuple[float, float]:
    """Return the phases of the two waves of a front [rad]."""
    first, second = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, 2).tolist()
    return first, second


def _set_out(waits: list[float], elapsed: float) -> int:
    """Return the number of gusts that have set out `elapsed` [s] after the first; the waits recur after the last."""
    if elapsed < 0.0:
        return 0
    again, rest = divmod(elapsed, waits[-1])
    return int(again) * (len(waits) - 1) + bisect_right(waits, rest, hi=len(waits) - 1)


@lru_cache(maxsize=256)
def _repetitions(seed: int, shortest: float, longest: float) -> tuple[list[float], list[float]]:
    """Return the times when a gust sets out [s], rising from 0, and its offsets aside, in [-1, 1], the first one 0."""
    random = np.random.default_rng((seed, 0x67757374))
    count = int(LATEST / shortest) + 1
    waits = np.concatenate([[0.0], np.cumsum(random.uniform(shortest, longest, count))])
    return waits.tolist(), [0.0, *random.uniform(-1.0, 1.0, count).tolist()]
