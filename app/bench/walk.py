"""`tallgrass bench walk`: whether frames keep taking the same time while the viewer walks."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Levels
from ..studio.progress import counted, course
from ..studio.studio import Studio
from ..studio.take import Take
from ..studio.timing import spread, timed
from .machine import head, resident_mb, yardstick_ms
from .processor import on_processor
from .stroll import REST, Leg, Moment, advance_to, legs, moments, raise_gusts

PARTS = {"drawing": 10.0, "without drawing": 1.0}
"""Names of the steps, with their approximate relative durations."""

MANY = 12
"""Number of patches in transition from which a frame counts as busy."""


@dataclass(frozen=True, slots=True)
class Pace:
    """Time and changes of one frame of the walk."""

    frame_ms: float

    changing: int
    """Number of patches in transition."""

    begun: int
    """Number of patches in view that began a change of representation."""

    refined: int
    """Number of patches in view that began a change of sub-level alone."""


def walk_measured(take: Take, /) -> dict[str, object]:
    """Return the benchmark's figures of a walk through a scene."""
    with course("a walk", PARTS) as way:
        with way.part("drawing"), Studio(take) as studio:
            result = head(studio.ctx, studio.prairie, take) | _measure(studio)
        with way.part("without drawing"):
            on_cpu = on_processor(take, walk=True)
            return result | {"cpu_ms": on_cpu and on_cpu["cpu_ms"], "yardstick_ms": yardstick_ms()}


def _measure(studio: Studio) -> dict[str, object]:
    every = paces(studio)
    taken = [next(every)]
    start = resident_mb()
    taken.extend(every)
    times = np.array([pace.frame_ms for pace in taken])
    busy = np.array([pace.changing >= MANY for pace in taken])
    p50, p99 = np.percentile(times, [50, 99]).tolist()
    return {
        "frames": len(taken),
        "frame_ms": spread(times.tolist(), 50, 95, 99) | {"max": round(times.max(), 3)},
        "p99_over_p50": round(p99 / p50, 3),
        "busy_over_p50": round(float(np.median(times[busy])) / p50, 3) if busy.any() else None,
        "transitions": sum(pace.begun for pace in taken),
        "sublevel_changes": sum(pace.refined for pace in taken),
        "rss_mb": {"start": start, "end": resident_mb()},
    }


def paces(studio: Studio, /) -> Iterator[Pace]:
    """Walk all legs through a prairie, in gusts, and yield the pace of each frame."""
    prairie = studio.prairie
    walk = legs(prairie)
    raise_gusts(prairie, walk)
    total = sum(len(list(moments(prairie, leg))) - 1 for leg in walk)
    yield from counted((pace for leg in walk for pace in paced(studio, leg)), total=total, doing="walking")


def paced(studio: Studio, leg: Leg, /) -> Iterator[Pace]:
    """Yield the pace of each frame of a leg, without the first, to which the viewer leaps."""
    prairie = studio.prairie
    first, *others = moments(prairie, leg)
    _draw(studio, first, time=first.time - REST / 2)
    _draw(studio, first)
    table = prairie.viewers["main"].patches
    for moment in others:
        cell, representation, sublevel = table.cell.copy(), table.representation.copy(), table.sublevel.copy()
        taken = _draw(studio, moment)
        stayed = table.alive & table.visible & (table.cell == cell).all(axis=1)
        begun = stayed & (table.representation != representation)
        refined = stayed & ~begun & sublevel_changed(table.representation, sublevel, table.sublevel)
        yield Pace(taken, prairie.statistics.transitions, int(begun.sum()), int(refined.sum()))


def sublevel_changed(representation: Levels, before: Levels, now: Levels) -> NDArray[np.bool_]:
    """Return the mask of patches with another sub-level of their `representation` (rows,) than before, shape (rows,).

    Sub-levels have shape (representations, rows). A patch's first sub-level is no change.
    """
    rows = np.arange(len(representation))
    had, has = before[representation, rows], now[representation, rows]
    return np.asarray((had >= 0) & (had != has) & (representation >= 0))


def _draw(studio: Studio, moment: Moment, *, time: float | None = None) -> float:
    prairie, matrices = studio.prairie, studio.matrices(moment.camera)
    advance_to(prairie, moment.time if time is None else time)

    def frame() -> None:
        studio.begin()
        prairie.draw(*matrices)

    return timed(studio.ctx, frame)
