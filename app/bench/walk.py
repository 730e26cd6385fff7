"""`tallgrass bench walk`: whether frames keep taking the same time while the viewer walks."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..studio.progress import counted, course
from ..studio.studio import Studio
from ..studio.take import Take
from ..studio.timing import spread, timed
from .machine import head, resident_mb, yardstick_ms
from .processor import on_processor
from .steps import let_trees_stay
from .stroll import REST, Leg, Moment, advance_to, legs, moments, raise_gusts

PARTS = {"drawing": 10.0, "without drawing": 1.0}
"""Names of the steps, with their approximate relative durations."""


@dataclass(frozen=True, slots=True)
class Pace:
    """Time and changes of one frame of the walk."""

    frame_ms: float

    begun: int
    """Number of patches in view that began a change of representation."""


def walk_measured(take: Take, /) -> dict[str, object]:
    """Return the benchmark's figures of a walk through a scene."""
    with course("a walk", PARTS) as way:
        with way.part("drawing"), Studio(take) as studio:
            result = head(studio.ctx, studio.prairie, take) | _measure(studio)
        with way.part("without drawing"):
            on_cpu = on_processor(walked_frames, take)
            return result | {"cpu_ms": on_cpu and on_cpu["cpu_ms"], "yardstick_ms": yardstick_ms()}


def walked_frames(take: Take, /) -> dict[str, object]:
    """Return the times of a walk's frames alone [ms]."""
    with Studio(take) as studio:
        return {"cpu_ms": spread([pace.frame_ms for pace in paces(studio)], 50, 95, 99)}


def _measure(studio: Studio) -> dict[str, object]:
    every = paces(studio)
    taken = [next(every)]
    start = resident_mb()
    taken.extend(every)
    times = np.array([pace.frame_ms for pace in taken])
    p50, p99 = np.percentile(times, [50, 99]).tolist()
    return {
        "frames": len(taken),
        "frame_ms": spread(times.tolist(), 50, 95, 99) | {"max": round(times.max(), 3)},
        "p99_over_p50": round(p99 / p50, 3),
        "transitions": sum(pace.begun for pace in taken),
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
    let_trees_stay(prairie)
    first, *others = moments(prairie, leg)
    _draw(studio, first, time=first.time - REST / 2)
    _draw(studio, first)
    table = prairie.viewers["main"].patches
    for moment in others:
        cell, representation = table.cell.copy(), table.representation.copy()
        taken = _draw(studio, moment)
        stayed = table.alive & table.visible & (table.cell == cell).all(axis=1)
        yield Pace(taken, int((stayed & (table.representation != representation)).sum()))


def _draw(studio: Studio, moment: Moment, *, time: float | None = None) -> float:
    prairie, matrices = studio.prairie, studio.matrices(moment.camera)
    advance_to(prairie, moment.time if time is None else time)

    def frame() -> None:
        studio.begin()
        prairie.draw(*matrices)

    return timed(studio.ctx, frame)
