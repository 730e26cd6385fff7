"""Figures of every benchmark on its machine, and on the machine's speed at the time."""

import json
import os
import platform
from collections.abc import Mapping
from mmap import PAGESIZE
from pathlib import Path
from time import perf_counter

import moderngl
import numpy as np

from ... import __version__
from ...systems.prairie import Prairie
from ..studio.take import Take

TIMINGS = 5
"""Number of timings of the yardstick, of which the least counts."""

ROUNDS = 10
"""Number of rounds of arithmetic in each timing."""


def head(ctx: moderngl.Context, prairie: Prairie, take: Take, /) -> dict[str, object]:
    """Return the first figures of every benchmark: the machine, the scene, the preset and the size."""
    quality = prairie.scene.quality
    preset = take.preset or (quality if isinstance(quality, str) else "custom")
    return {"machine": machine(ctx), "scene": take.scene, "preset": preset, "size": list(take.size)}


def machine(ctx: moderngl.Context, /) -> dict[str, str | int]:
    """Return the machine's renderer, GL version, processor, cores, Python and tallgrass versions."""
    return {
        "renderer": str(ctx.info["GL_RENDERER"]),
        "gl": str(ctx.info["GL_VERSION"]),
        "cpu": _processor(),
        "cores": os.cpu_count() or 1,
        "python": platform.python_version(),
        "version": __version__,
    }


def _processor() -> str:
    try:
        with Path("/proc/cpuinfo").open(encoding="utf-8") as lines:
            names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    except OSError:
        names = []
    return names[0] if names else platform.processor() or platform.machine()


def resident_mb() -> float | None:
    """Return the resident memory of this process [MB]; on macOS its peak, on Windows None."""
    statm = Path("/proc/self/statm")
    if statm.is_file():
        return round(int(statm.read_text("ascii").split()[1]) * PAGESIZE / 1e6, 1)
    try:
        from resource import RUSAGE_SELF, getrusage
    except ImportError:
        return None
    return round(getrusage(RUSAGE_SELF).ru_maxrss / 1e6, 1)


def tell(result: Mapping[str, object], *, as_json: bool) -> None:
    """Print a benchmark's result: as JSON, or a line per figure for people."""
    if as_json:
        print(json.dumps(result, indent=2))
        return
    for name, value in result.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            print(f"{name}:")
            for row in value:
                print("  " + "  ".join(f"{key} {figure}" for key, figure in row.items()))
        elif isinstance(value, dict):
            print(f"{name}: " + "  ".join(f"{key} {figure}" for key, figure in value.items()))
        else:
            print(f"{name}: {value}")


def yardstick_ms() -> float:
    """Return the time of fixed arithmetic [ms]: sines and roots of 200,000 pairs of numbers, ten times."""
    places = np.random.default_rng(0).random((200_000, 2), np.float32)
    times = []
    for _ in range(TIMINGS):
        start = perf_counter()
        for _ in range(ROUNDS):
            np.sin(places) * places + np.sqrt(places)
        times.append(perf_counter() - start)
    return round(1000.0 * min(times), 3)
