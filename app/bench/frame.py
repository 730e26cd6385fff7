"""`tallgrass bench frame`: the cost of a frame, and of its parts."""

import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from ...systems.reference import EveryBlade, cells_within, stand_all, terrain_cells
from ...systems.show.blades.draw import BladeDrawing
from ...systems.stock.models import precompute_bytes
from ..studio.progress import counted, course
from ..studio.studio import Studio
from ..studio.take import Take
from ..studio.timing import card_timer, spread, timed
from .machine import head, yardstick_ms
from .processor import on_processor
from .rivals import Rivals
from .still import FRAMES, Still, still_frames
from .viewers import side_by_side

EVERY = 12
"""Frames between two draws of every blade: they alternate, as a machine's speed varies over time."""

PARTS = {"growing": 6.0, "drawing": 60.0, "without drawing": 6.0}
"""Names of the steps, with their approximate durations [s]."""

MOVING = ("press", "wind")
"""Systems that animate (paper, section 5); the others choose what is shown, and plant it."""

TURN = 6
"""Number of frames between two draws of the rivals."""


def frame_measured(take: Take, /, *, viewers: int = 1) -> dict[str, object]:
    """Return the benchmark's figures of a scene's frame from its fixed camera.

    With several `viewers`, each viewer's part of a frame is measured too.
    """
    first = {"cold": 0.0, "cached": 0.0}
    with course("a frame", PARTS | ({"viewers": 30.0} if viewers > 1 else {})) as way:
        with way.part("growing"), _empty_cache():
            first["cold"] = _first_frame(take)
            first["cached"] = _first_frame(take)
        with Studio(take) as studio:
            with way.part("drawing"):
                result = _measure(studio, take, first)
            if viewers > 1:
                with way.part("viewers"):
                    result["viewers"] = side_by_side(studio, viewers)
        with way.part("without drawing"):
            return result | _on_processor(take) | {"yardstick_ms": yardstick_ms()}


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
class Samples:
    """Times of all measured frames [ms]."""

    frame: list[float] = field(default_factory=list)
    draw: list[float] = field(default_factory=list)
    systems: dict[str, list[float]] = field(default_factory=dict)
    all_3d: list[float] = field(default_factory=list)
    seen_3d: list[float] = field(default_factory=list)
    floor: list[float] = field(default_factory=list)
    heard: list[float] = field(default_factory=list)
    """Times of the passes in which all receivers hear the winds."""

    card: list[float] = field(default_factory=list)
    """Times measured by the graphics card; empty without one."""


class _Blades:
    """Every blade of the terrain, and every blade in view, each in one draw, over the ground of the last frame."""

    def __init__(self, still: Still) -> None:
        self._still, prairie = still, still.studio.prairie
        self._every = EveryBlade(prairie)
        self._all = self._every.blades
        self._seen = self._every.painter.blade_painter(prairie.site.finest)
        ground, viewer = prairie.site.ground, self._every.outlook.viewer
        stand_all(prairie, terrain_cells(ground), self._all)
        stand_all(prairie, cells_within(ground, viewer.eye, viewer.cone, sway=prairie.site.sway), self._seen)
        self.add_to(Samples())  # warms up: a program's first draw takes longer

    def add_to(self, samples: Samples) -> None:
        """Measure all blades, those in view, and the bare floor once."""
        samples.all_3d.append(self._timed([self._all]))
        samples.seen_3d.append(self._timed([self._seen]))
        samples.floor.append(self._timed([]))

    def _timed(self, blades: list[BladeDrawing]) -> float:
        def draw() -> None:
            self._still.studio.begin()
            self._every.painter.draw(self._still.view, blades=blades)

        return timed(self._still.studio.ctx, draw)

    def release(self) -> None:
        self._seen.release()
        self._every.release()


def sample(still: Still, rivals: Rivals) -> Samples:
    """Draw the frames, and in between every blade in one draw, the bare floor, and the rivals, all from one camera."""
    prairie, samples, timer = still.studio.prairie, Samples(), card_timer(still.studio.ctx)
    blades = _Blades(still)
    for number in counted(range(FRAMES), total=FRAMES, doing="frames"):
        samples.frame.append(still.step(timer))
        if timer is not None:
            samples.card.append(timer.elapsed / 1e6)
        samples.heard.append(still.hear())
        samples.draw.append(prairie.statistics.draw_ms)
        for name, milliseconds in prairie.statistics.systems_ms.items():
            samples.systems.setdefault(name, []).append(milliseconds)
        if number % EVERY == EVERY - 1:
            blades.add_to(samples)
        if number % TURN == TURN - 1:
            rivals.measure()  # after the blades, which need the carpet that the frame has laid
    blades.release()
    return samples


def _measure(studio: Studio, take: Take, first: dict[str, float]) -> dict[str, object]:
    still = Still(studio)
    rivals = Rivals(still)
    samples = sample(still, rivals)
    result = _figures(studio, take, first, samples) | {"rivals": rivals.rows(samples.frame)}
    rivals.release()
    return result


def _figures(studio: Studio, take: Take, first: dict[str, float], samples: Samples) -> dict[str, object]:
    prairie = studio.prairie
    stats, kinds = prairie.statistics, zip(prairie.scene.grass, prairie.site.growths, strict=True)
    grown = {name: round(precompute_bytes(growth) / 1e6, 2) for name, growth in kinds}
    return {
        **head(studio.ctx, prairie, take),
        "frames": FRAMES,
        "frame_ms": spread(samples.frame, 50, 95, 99),
        "gpu_ms": spread(samples.card, 50, 95) if any(samples.card) else None,
        "draw_ms": _median(samples.draw),
        "systems_ms": {name: _median(rows) for name, rows in samples.systems.items()},
        "systems_total_ms": _median(np.sum(list(samples.systems.values()), axis=0)),
        **_animation(samples),
        "blades": {
            "field": stats.blades_field,
            "considered": stats.blades_considered,
            "submitted": stats.blades_submitted,
        },
        "receivers": stats.receivers,
        "draw_calls": stats.draw_calls,
        **_against_every_blade(samples),
        "precompute_mb": round(sum(grown.values()), 2),
        "precompute_mb_by_kind": grown,
        "first_frame_ms": {name: _ms(value) for name, value in first.items()},
    }


def _animation(samples: Samples) -> dict[str, float]:
    """Return the time of animation, and its fraction of a frame: wind and press systems, and the receivers' passes."""
    moving = np.sum([samples.heard, *(samples.systems[name] for name in MOVING if name in samples.systems)], axis=0)
    took = float(np.median(moving))
    return {"animation_ms": _ms(took), "animation_part": round(took / float(np.median(samples.frame)), 3)}


def _against_every_blade(samples: Samples) -> dict[str, float]:
    frame, all_3d, seen_3d = (float(np.median(each)) for each in (samples.frame, samples.all_3d, samples.seen_3d))
    return {
        "all_3d_ms": _ms(all_3d),
        "ratio_to_all_3d": round(all_3d / frame, 2),
        "seen_3d_ms": _ms(seen_3d),
        "ratio_to_seen_3d": round(seen_3d / frame, 2),
        "floor_ms": _median(samples.floor),
    }


def _on_processor(take: Take) -> dict[str, object]:
    """Return the cost of frames on the CPU alone; figures are None where it cannot be measured."""
    measured = on_processor(still_frames, take)
    if measured is None:
        return {"cpu_ms": None, "cpu_by_system_ms": None, "cpu_over_yardstick": None}
    return {
        "cpu_ms": measured["cpu_ms"],
        "cpu_by_system_ms": measured["cpu_by_system_ms"],
        "cpu_over_yardstick": round(measured["cpu_ms"]["p50"] / measured["yardstick_ms"], 3),
    }


def _median(values: Sequence[float] | NDArray[np.float64]) -> float:
    return _ms(float(np.median(values)))


def _ms(value: float) -> float:
    return round(value, 3)
