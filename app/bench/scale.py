"""`tallgrass bench scale`: what a larger terrain costs, up to 10 km."""

import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from json import loads
from multiprocessing import get_context
from time import perf_counter
from typing import Any

import numpy as np

from ...engine.scene import LoadedScene, read_scene
from ..studio.errors import InputError, MachineError
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.take import Take, words_of
from ..studio.walker import MARGIN
from .machine import head, resident_mb
from .many import Survey
from .sent import Asked
from .stroll import RATE, SECONDS, legs
from .walk import paced

Row = dict[str, float | None]

BAD_INPUT = 2
"""The exit status of a command that was told something wrong."""

SIDES = (100.0, 1000.0, 10000.0)
"""Sides of the terrains [m]."""


def scale_measured(take: Take, output: str | None = None, /) -> dict[str, Any]:
    """Return what the benchmark tells of a scene on larger and larger terrains, each in a process of its own.

    It draws no pictures: nothing goes to `output`. Raises InputError where the scene's terrain is not made from noise.
    """
    del output
    if read_scene(take.scene).scene.terrain.heights is not None:
        raise InputError(f"{take.scene}: its terrain comes from a file; only one from noise can be stretched")
    with Studio(take) as studio:  # that grows the scene's grass: no row pays for it
        told = head(studio.ctx, studio.prairie, take)
    rows = list(counted(map(partial(_alone, take), SIDES), total=len(SIDES), doing="larger and larger terrains"))
    return {**told, "frames": round(SECONDS * RATE), "rows": rows}


def _alone(take: Take, side: float) -> Row:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        return pool.submit(_measured, take, side).result()


def _measured(take: Take, side: float) -> Row:
    start = perf_counter()
    with Studio(take, stretched(read_scene(take.scene), side)) as studio:
        studio.picture(studio.camera(None))
        first = 1000.0 * (perf_counter() - start)
        times = [pace.frame_ms for pace in paced(studio, legs(studio.prairie)[0])]
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
    command = [sys.executable, "-m", "tallgrass", "bench", "scale", "--json", *words_of(take)]
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
