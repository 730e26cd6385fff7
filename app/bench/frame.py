"""`tallgrass bench frame`: what a frame costs, and what it is made of."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ...engine.camera import view_of
from ...systems.prairie import Prairie
from ...systems.reference import EveryBlade, stand_all, terrain_cells
from ...systems.show.blades.draw import BladePainter
from ...systems.stock.models import precompute_bytes
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.take import Take
from .machine import machine, tell
from .timing import timed
from .viewers import side_by_side

FRAMES = 60
"""Frames measured."""

WARM_UP = 6
"""Frames drawn before, not measured."""

EVERY = 12
"""Frames between two draws of every blade: taken in turn, since such machines change their speed."""

STEP = 1.0 / 60.0
"""Time between frames [s]."""


def bench_frame(scene: str, *, preset: str | None, size: tuple[int, int], json: bool, viewers: int = 1) -> int:
    """Measure a scene's frame from its fixed camera, print the figures, and return the exit status.

    Of more than one viewer, each one's part of a frame is measured besides.
    """
    take = Take(scene, size, preset=preset)
    first = {"cold": 0.0, "cached": 0.0}
    with _empty_cache():
        first["cold"] = _first_frame(take)
        first["cached"] = _first_frame(take)
    with Studio(take) as studio:
        result = _measure(studio, take, first)
        if viewers > 1:
            result["viewers"] = side_by_side(studio, viewers)
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


@dataclass(slots=True)
class _Samples:
    """Times of every frame measured [ms]."""

    frame: list[float] = field(default_factory=list)
    draw: list[float] = field(default_factory=list)
    systems: dict[str, list[float]] = field(default_factory=dict)
    all_3d: list[float] = field(default_factory=list)
    floor: list[float] = field(default_factory=list)


def _sample(studio: Studio) -> _Samples:
    """Draw the frames, and now and then every blade in one draw, and the floor: all from the same place."""
    prairie, ctx, samples = studio.prairie, studio.ctx, _Samples()
    view, projection = studio.matrices(studio.camera(None))
    seen = view_of(view, projection)

    def frame() -> None:
        studio.begin()
        prairie.draw(view, projection)

    for _ in range(WARM_UP):
        frame()
        prairie.advance(STEP)
    every = EveryBlade(prairie)
    stand_all(prairie, terrain_cells(prairie.site.ground), every.blades)

    def only(blades: list[BladePainter]) -> float:
        def draw() -> None:
            studio.begin()
            every.painter.draw(seen, blades=blades)

        return timed(ctx, draw)

    only([every.blades])
    for number in counted(range(FRAMES), total=FRAMES, doing="frames"):
        prairie.advance(STEP)
        samples.frame.append(timed(ctx, frame))
        samples.draw.append(prairie.statistics.draw_ms)
        for name, milliseconds in prairie.statistics.systems_ms.items():
            samples.systems.setdefault(name, []).append(milliseconds)
        if number % EVERY == EVERY - 1:
            samples.all_3d.append(only([every.blades]))
            samples.floor.append(only([]))
    every.release()
    return samples


def _measure(studio: Studio, take: Take, first: dict[str, float]) -> dict[str, object]:
    samples, prairie = _sample(studio), studio.prairie
    stats, kinds = prairie.statistics, zip(prairie.scene.grass, prairie.site.growths, strict=True)
    grown = {name: round(precompute_bytes(growth) / 1e6, 2) for name, growth in kinds}
    p50, p95, p99 = np.percentile(samples.frame, [50, 95, 99]).tolist()
    all_3d = float(np.median(samples.all_3d))
    return {
        "machine": machine(studio.ctx),
        "scene": take.scene,
        "preset": take.preset or own_preset(prairie),
        "size": list(take.size),
        "frames": FRAMES,
        "frame_ms": {"p50": _ms(p50), "p95": _ms(p95), "p99": _ms(p99)},
        "draw_ms": _median(samples.draw),
        "systems_ms": {name: _median(rows) for name, rows in samples.systems.items()},
        "systems_total_ms": _median(np.sum(list(samples.systems.values()), axis=0)),
        "blades": {
            "field": stats.blades_field,
            "considered": stats.blades_considered,
            "submitted": stats.blades_submitted,
        },
        "receivers": stats.receivers,
        "draw_calls": stats.draw_calls,
        "all_3d_ms": _ms(all_3d),
        "ratio_to_all_3d": round(all_3d / p50, 2),
        "floor_ms": _median(samples.floor),
        "precompute_mb": round(sum(grown.values()), 2),
        "precompute_mb_by_kind": grown,
        "first_frame_ms": {name: _ms(value) for name, value in first.items()},
        "rivals": [],
    }


def own_preset(prairie: Prairie) -> str:
    """Return the name of the quality that a scene asks for itself."""
    quality = prairie.scene.quality
    return quality if isinstance(quality, str) else "custom"


def _median(values: Sequence[float] | NDArray[np.float64]) -> float:
    return _ms(float(np.median(values)))


def _ms(value: float) -> float:
    return round(value, 3)
