"""`tallgrass bench frame`: what a frame costs, and what it is made of."""

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter

import moderngl
import numpy as np

from ...systems.draw.painter import view_of
from ...systems.growth.models import precompute_bytes
from ...systems.prairie import Prairie
from ...systems.reference import EveryBlade, stand_all, terrain_cells
from ..progress import counted
from ..studio import Studio
from ..take import Take
from .machine import machine, tell

FRAMES = 60
"""Frames measured."""

WARM_UP = 6
"""Frames drawn before, not measured."""

EVERY = 12
"""Frames between two draws of every blade: taken in turn, since such machines change their speed."""

STEP = 1.0 / 60.0
"""Time between frames [s]."""


def bench_frame(scene: str, *, preset: str | None, size: tuple[int, int], json: bool) -> int:
    """Measure a scene's frame from its fixed camera, print the figures, and return the exit status."""
    take = Take(scene, size, preset=preset)
    first = {"cold": 0.0, "cached": 0.0}
    with _empty_cache():
        first["cold"] = _first_frame(take)
        first["cached"] = _first_frame(take)
    with Studio(take) as studio:
        result = _measure(studio, take, first)
    tell(result, as_json=json)
    return 0


@contextmanager
def _empty_cache() -> Iterator[None]:
    before = os.environ.get("TALLGRASS_CACHE")
    with tempfile.TemporaryDirectory() as folder:
        os.environ["TALLGRASS_CACHE"] = folder
        try:
            yield
        finally:
            del os.environ["TALLGRASS_CACHE"]
            if before is not None:
                os.environ["TALLGRASS_CACHE"] = before


def _first_frame(take: Take) -> float:
    start = perf_counter()
    with Studio(take) as studio:
        studio.picture(studio.camera(None))
        return 1000.0 * (perf_counter() - start)


def _timed(ctx: moderngl.Context, work: Callable[[], object]) -> float:
    ctx.finish()
    start = perf_counter()
    work()
    ctx.finish()
    return 1000.0 * (perf_counter() - start)


def _measure(studio: Studio, take: Take, first: dict[str, float]) -> dict[str, object]:
    prairie, ctx = studio.prairie, studio.ctx
    view, projection = studio.matrices(studio.camera(None))
    frame: list[float] = []
    draw: list[float] = []
    systems: dict[str, list[float]] = {}

    def one() -> None:
        studio.begin()
        prairie.draw(view, projection)

    for _ in range(WARM_UP):
        one()
        prairie.advance(STEP)
    every = EveryBlade(prairie)
    stand_all(prairie, terrain_cells(prairie.field), every.blades)
    seen = view_of(view, projection)

    def all_blades() -> None:
        studio.begin()
        every.painter.draw(seen, time=prairie.time, blades=[every.blades])

    def floor() -> None:
        studio.begin()
        every.painter.draw(seen, time=prairie.time, blades=[])

    all_3d, floors = [_timed(ctx, all_blades)], [_timed(ctx, floor)]
    for number in counted(range(FRAMES), total=FRAMES, doing="frames"):
        prairie.advance(STEP)
        frame.append(_timed(ctx, one))
        draw.append(prairie.statistics.draw_ms)
        for name, milliseconds in prairie.statistics.systems_ms.items():
            systems.setdefault(name, []).append(milliseconds)
        if number % EVERY == EVERY - 1:
            all_3d.append(_timed(ctx, all_blades))
            floors.append(_timed(ctx, floor))
    every.release()
    totals = np.sum(list(systems.values()), axis=0)
    p50, p95, p99 = np.percentile(frame, [50, 95, 99])
    stats, field = prairie.statistics, prairie.field
    kinds = zip(prairie.scene.grass, field.growths, strict=True)
    grown = {name: round(precompute_bytes(growth) / 1e6, 2) for name, growth in kinds}
    baseline = float(np.median(all_3d[1:]))
    return {
        "machine": machine(ctx),
        "scene": take.scene,
        "preset": take.preset or _own_preset(prairie),
        "size": list(take.size),
        "frames": FRAMES,
        "frame_ms": {"p50": _ms(p50), "p95": _ms(p95), "p99": _ms(p99)},
        "draw_ms": _ms(np.median(draw)),
        "systems_ms": {name: _ms(np.median(rows)) for name, rows in systems.items()},
        "systems_total_ms": _ms(np.median(totals)),
        "blades": {
            "field": stats.blades_field,
            "considered": stats.blades_considered,
            "submitted": stats.blades_submitted,
        },
        "receivers": stats.receivers,
        "draw_calls": stats.draw_calls,
        "all_3d_ms": _ms(baseline),
        "ratio_to_all_3d": round(baseline / float(p50), 2),
        "floor_ms": _ms(np.median(floors)),
        "precompute_mb": round(sum(grown.values()), 2),
        "precompute_mb_by_kind": grown,
        "first_frame_ms": {name: _ms(value) for name, value in first.items()},
        "rivals": [],
    }


def _own_preset(prairie: Prairie) -> str:
    quality = prairie.scene.quality
    return quality if isinstance(quality, str) else "custom"


def _ms(value: float | np.floating) -> float:
    return round(float(value), 3)
