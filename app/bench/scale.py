"""`tallgrass bench scale`: what a larger terrain costs, up to 10 km."""

from dataclasses import replace
from functools import partial
from time import perf_counter
from typing import Any

import numpy as np

from ...engine.scene import LoadedScene, read_scene
from ..studio.errors import InputError
from ..studio.progress import counted
from ..studio.studio import Studio
from ..studio.take import Take
from ..studio.walker import MARGIN
from .apart import apart
from .machine import head, resident_mb
from .many import Survey
from .sent import Job
from .stroll import RATE, SECONDS, legs
from .walk import paced

Row = dict[str, float | None]

SIDES = (100.0, 1000.0, 10000.0)
"""Sides of the terrains [m]."""


def scale_measured(take: Take, _output: str | None = None, /) -> dict[str, Any]:
    """Return the benchmark's figures of a scene on larger and larger terrains, each in a process of its own.

    Raises InputError where the scene's terrain is not made from noise.
    """
    if read_scene(take.scene).scene.terrain.heights is not None:
        raise InputError(f"{take.scene}: its terrain comes from a file; only one from noise can be stretched")
    with Studio(take) as studio:  # this grows and caches the grass, so that no row includes it
        common = head(studio.ctx, studio.prairie, take)
    measured = map(partial(apart, _measured, take), SIDES)
    rows = list(counted(measured, total=len(SIDES), doing="larger and larger terrains"))
    return {**common, "frames": round(SECONDS * RATE), "rows": rows}


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


def _cells(result: dict[str, Any]) -> dict[str, object]:
    """Return the table's cells for a scene: frame times by terrain side, memory and first frame of the largest."""
    frames = {f"ms_{row['terrain_m']:.0f}_m": row["frame_ms"] for row in result["rows"]}
    return {**frames, "rss_mb": result["rows"][-1]["rss_mb"], "first_ms": result["rows"][-1]["first_frame_ms"]}


SURVEY = Survey(
    scale_measured, "larger and larger terrains", _cells, kept=("rows",), job=Job(scale_measured, timed=True)
)
"""The benchmark for many scenes."""


def stretched(loaded: LoadedScene, side: float, /) -> LoadedScene:
    """Return a scene on a square terrain of this side [m], with its camera moved onto it."""
    scene = loaded.scene
    half = side / 2.0 - MARGIN
    place = [min(max(coordinate, -half), half) for coordinate in scene.camera.position]
    return replace(
        loaded,
        scene=scene.model_copy(
            update={
                "terrain": scene.terrain.model_copy(update={"size": [side, side]}),
                "camera": scene.camera.model_copy(update={"position": place, "path": []}),
            }
        ),
    )
