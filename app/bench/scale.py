"""`tallgrass bench scale`: what a larger terrain costs, up to 10 km."""

import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from json import loads
from multiprocessing import get_context
from time import perf_counter
from typing import Any

import numpy as np

from ...engine.camera import camera_at, projection_matrix, view_matrix
from ...engine.scene import LoadedScene, read_scene
from ...systems.prairie import Prairie
from ..studio.errors import InputError, MachineError
from ..studio.offscreen import Offscreen
from ..studio.progress import counted
from ..studio.take import Take
from ..studio.walker import MARGIN
from .asked import Asked
from .frame import own_preset
from .machine import machine, resident_mb
from .many import Survey, bench_many
from .stroll import RATE, SECONDS, legs
from .walk import paced

Row = dict[str, float | None]

BAD_INPUT = 2
"""The exit status of a command that was told something wrong."""

SIDES = (100.0, 1000.0, 10000.0)
"""Sides of the terrains [m]."""


def bench_scale(scene: str, *, preset: str | None, size: tuple[int, int], json: bool, on: str | None = None) -> int:
    """Measure a scene on larger and larger terrains, print the figures, and return the exit status.

    Each terrain has a process of its own. Where `scene` is a folder, all scenes in it are measured, and a table is
    printed. With `on`, workers do it, one at a time on each machine. Raises InputError where a scene's terrain is not
    made from noise.
    """
    return bench_many(scene, SURVEY, preset=preset, size=size, json=json, on=on)


def scale_measured(take: Take, output: str | None = None, /) -> dict[str, Any]:
    """Return what the benchmark tells of a scene on larger and larger terrains; raises InputError as `bench_scale`.

    It draws no pictures: nothing goes to `output`.
    """
    del output
    scene, preset, size = take.scene, take.preset, take.size
    head = _head(scene, preset, size)
    one = partial(_measured, scene, preset, size)
    rows = list(counted(_alone(one, SIDES), total=len(SIDES), doing="larger and larger terrains"))
    return {**head, "frames": round(SECONDS * RATE), "rows": rows}


def _head(scene: str, preset: str | None, size: tuple[int, int]) -> dict[str, object]:
    """Return what all benchmarks tell, after the scene's grass has been grown, so that no row pays for it."""
    loaded = read_scene(scene)
    if loaded.scene.terrain.heights is not None:
        raise InputError(f"{scene}: its terrain comes from a file; only one from noise can be stretched")
    prairie = Prairie(loaded, preset=preset)
    prairie.release()
    with Offscreen(size) as target:
        told = machine(target.ctx)
    return {"machine": told, "scene": scene, "preset": preset or own_preset(prairie), "size": list(size)}


def _alone(one: Callable[[float], Row], sides: tuple[float, ...]) -> Iterator[Row]:
    for side in sides:
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            yield pool.submit(one, side).result()


def _measured(scene: str, preset: str | None, size: tuple[int, int], side: float) -> Row:
    start = perf_counter()
    with Offscreen(size) as target:
        prairie = Prairie(stretched(read_scene(scene), side), ctx=target.ctx, preset=preset, live=False)
        camera = camera_at(prairie.scene.camera, None, prairie.height_at)
        target.begin()
        prairie.draw(view_matrix(camera), projection_matrix(camera.view, size[0] / size[1]))
        target.ctx.finish()
        first = 1000.0 * (perf_counter() - start)
        times = [pace.frame_ms for pace in paced(target, prairie, legs(prairie)[0])]
        prairie.release()
    return {
        "terrain_m": side,
        "frame_ms": round(float(np.median(times)), 3),
        "rss_mb": resident_mb(),
        "first_frame_ms": round(first, 3),
    }


def measured_apart(take: Take, output: str | None = None, /) -> dict[str, Any]:
    """Return what `scale_measured` tells, by a process begun for it: a worker's own may not begin others.

    Raises InputError and MachineError with what that process says of its own.
    """
    del output
    width, height = take.size
    command = [sys.executable, "-m", "tallgrass", "bench", "scale", "--json", "--size", f"{width}x{height}"]
    command += (["--preset", take.preset] if take.preset else []) + ["--", take.scene]
    done = subprocess.run(  # noqa: S603 - it is our own command
        command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False,
    )  # fmt: skip
    if done.returncode:
        raise (InputError if done.returncode == BAD_INPUT else MachineError)(done.stderr.strip())
    told: dict[str, Any] = loads(done.stdout)
    return told


def _cells(told: dict[str, Any]) -> dict[str, object]:
    """Return what a table tells of a scene: its frames by the sides of the terrains, and the largest one's memory."""
    frames = {f"ms_{row['terrain_m']:.0f}_m": row["frame_ms"] for row in told["rows"]}
    return {**frames, "rss_mb": told["rows"][-1]["rss_mb"], "first_ms": told["rows"][-1]["first_frame_ms"]}


SURVEY = Survey(
    scale_measured, "larger and larger terrains", _cells, kept=("rows",), asked=Asked(measured_apart, timed=True)
)
"""Larger and larger terrains of many scenes."""


def stretched(loaded: LoadedScene, side: float, /) -> LoadedScene:
    """Return a scene on a square terrain of this side [m], its camera on it."""
    scene = loaded.scene
    half = side / 2.0 - MARGIN
    place = [min(max(part, -half), half) for part in scene.camera.position]
    return replace(
        loaded,
        scene=scene.model_copy(
            update={
                "terrain": scene.terrain.model_copy(update={"size": [side, side]}),
                "camera": scene.camera.model_copy(update={"position": place, "path": []}),
            }
        ),
    )
