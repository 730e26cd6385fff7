"""`tallgrass bench walk`: whether frames keep taking the same time while the viewer walks."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...engine.camera import projection_matrix, view_matrix
from ...systems.prairie import Prairie
from ..studio.offscreen import Offscreen
from ..studio.progress import counted
from .frame import own_preset
from .machine import machine, resident_mb, tell
from .stroll import REST, Leg, Moment, legs, moments, raise_gusts
from .timing import timed

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


def bench_walk(scene: str, *, preset: str | None, size: tuple[int, int], json: bool) -> int:
    """Walk through a scene, print what its frames took, and return the exit status."""
    with Offscreen(size) as target:
        prairie = Prairie.load(scene, ctx=target.ctx, preset=preset, live=False)
        try:
            head = {"machine": machine(target.ctx), "scene": scene, "preset": preset or own_preset(prairie)}
            result = {**head, "size": list(size), **_measure(target, prairie)}
        finally:
            prairie.release()
    tell(result, as_json=json)
    return 0


def _measure(target: Offscreen, prairie: Prairie) -> dict[str, object]:
    walk = legs(prairie)
    raise_gusts(prairie, walk)
    total = sum(len(list(moments(prairie, leg))) - 1 for leg in walk)
    every = (frame for leg in walk for frame in paced(target, prairie, leg))
    paces = [next(every)]
    start = resident_mb()
    paces.extend(counted(every, total=total - 1, doing="walking"))
    times = np.array([pace.frame_ms for pace in paces])
    busy = np.array([pace.changing >= MANY for pace in paces])
    p50, p95, p99 = np.percentile(times, [50, 95, 99]).tolist()
    return {
        "frames": len(paces),
        "frame_ms": {"p50": round(p50, 3), "p95": round(p95, 3), "p99": round(p99, 3), "max": round(times.max(), 3)},
        "p99_over_p50": round(p99 / p50, 3),
        "busy_over_p50": round(float(np.median(times[busy])) / p50, 3) if busy.any() else None,
        "transitions": sum(pace.begun for pace in paces),
        "rss_mb": {"start": start, "end": resident_mb()},
    }


def paced(target: Offscreen, prairie: Prairie, leg: Leg, /) -> Iterator[Pace]:
    """Yield what each frame of a leg took but the first, to which the viewer leaps."""
    first, *others = moments(prairie, leg)
    _draw(target, prairie, first, time=first.time - REST / 2)
    _draw(target, prairie, first)
    for moment in others:
        table = prairie.viewers["main"].patches
        cell, representation = table.cell.copy(), table.representation.copy()
        taken = _draw(target, prairie, moment)
        begun = (
            table.alive & table.visible & (table.cell == cell).all(axis=1) & (table.representation != representation)
        )
        yield Pace(taken, prairie.statistics.transitions, int(begun.sum()))


def _draw(target: Offscreen, prairie: Prairie, moment: Moment, *, time: float | None = None) -> float:
    width, height = target.size
    view, projection = view_matrix(moment.camera), projection_matrix(moment.camera.view, width / height)
    prairie.advance(max(0.0, (moment.time if time is None else time) - prairie.time))

    def frame() -> None:
        target.begin()
        prairie.draw(view, projection)

    return timed(target.ctx, frame)
