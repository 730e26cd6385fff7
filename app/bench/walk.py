"""`tallgrass bench walk`: whether frames keep taking the same time while the viewer walks."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Levels
from ...engine.camera import projection_matrix, view_matrix
from ...systems.prairie import Prairie
from ..studio.offscreen import Offscreen
from ..studio.progress import counted, course
from ..studio.timing import spread, timed
from .frame import own_preset
from .machine import machine, resident_mb, tell
from .processor import on_processor
from .stroll import REST, Leg, Moment, legs, moments, raise_gusts
from .yardstick import yardstick_ms

PARTS = {"drawing": 10.0, "without drawing": 1.0}
"""What there is to do, and how long it takes in terms of one another, about."""

MANY = 12
"""Patches in transition from which a frame counts as busy."""


@dataclass(frozen=True, slots=True)
class Pace:
    """What one frame of the walk took."""

    frame_ms: float

    changing: int
    """Patches in transition."""

    begun: int
    """Patches in view that got another representation to come to."""

    refined: int
    """Patches in view that kept their representation and got another of its sub-levels to come to."""


def bench_walk(scene: str, *, preset: str | None, size: tuple[int, int], json: bool) -> int:
    """Walk through a scene, print what its frames took, and return the exit status."""
    tell(walk_measured(scene, preset=preset, size=size), as_json=json)
    return 0


def walk_measured(scene: str, *, preset: str | None, size: tuple[int, int]) -> dict[str, object]:
    """Return what the benchmark tells of a walk through a scene."""
    with course("a walk", PARTS) as way:
        with way.part("drawing"), Offscreen(size) as target:
            prairie = Prairie.load(scene, ctx=target.ctx, preset=preset, live=False)
            try:
                head = {"machine": machine(target.ctx), "scene": scene, "preset": preset or own_preset(prairie)}
                result = {**head, "size": list(size), **_measure(target, prairie)}
            finally:
                prairie.release()
        with way.part("without drawing"):
            told = on_processor(scene, preset=preset, size=size, walk=True)
            return result | {"cpu_ms": told and told["cpu_ms"], "yardstick_ms": yardstick_ms()}


def _measure(target: Offscreen, prairie: Prairie) -> dict[str, object]:
    every = paces(target, prairie)
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


def paces(target: Offscreen, prairie: Prairie, /) -> Iterator[Pace]:
    """Walk all legs through a prairie, in gusts, and yield what each frame took."""
    walk = legs(prairie)
    raise_gusts(prairie, walk)
    total = sum(len(list(moments(prairie, leg))) - 1 for leg in walk)
    yield from counted((pace for leg in walk for pace in paced(target, prairie, leg)), total=total, doing="walking")


def paced(target: Offscreen, prairie: Prairie, leg: Leg, /) -> Iterator[Pace]:
    """Yield what each frame of a leg took but the first, to which the viewer leaps."""
    first, *others = moments(prairie, leg)
    _draw(target, prairie, first, time=first.time - REST / 2)
    _draw(target, prairie, first)
    table = prairie.viewers["main"].patches
    for moment in others:
        cell, representation, sublevel = table.cell.copy(), table.representation.copy(), table.sublevel.copy()
        taken = _draw(target, prairie, moment)
        stayed = table.alive & table.visible & (table.cell == cell).all(axis=1)
        begun = stayed & (table.representation != representation)
        refined = stayed & ~begun & another(table.representation, sublevel, table.sublevel)
        yield Pace(taken, prairie.statistics.transitions, int(begun.sum()), int(refined.sum()))


def another(representation: Levels, before: Levels, now: Levels) -> NDArray[np.bool_]:
    """Return which patches have another sub-level of their representation (rows,) than before, shape (rows,).

    Sub-levels have shape (representations, rows); from none at all to the first one counts as no change.
    """
    rows = np.arange(len(representation))
    had, has = before[representation, rows], now[representation, rows]
    return np.asarray((had >= 0) & (had != has) & (representation >= 0))


def _draw(target: Offscreen, prairie: Prairie, moment: Moment, *, time: float | None = None) -> float:
    width, height = target.size
    view, projection = view_matrix(moment.camera), projection_matrix(moment.camera.view, width / height)
    prairie.advance(max(0.0, (moment.time if time is None else time) - prairie.time))

    def frame() -> None:
        target.begin()
        prairie.draw(view, projection)

    return timed(target.ctx, frame)
