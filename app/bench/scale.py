"""`tallgrass bench scale`: what a larger terrain costs, up to 10 km."""

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from functools import partial
from multiprocessing import get_context
from time import perf_counter

import numpy as np

from ...engine.camera import camera_at, projection_matrix, view_matrix
from ...engine.scene import LoadedScene, read_scene
from ...systems.prairie import Prairie
from ..studio.errors import InputError
from ..studio.offscreen import Offscreen
from ..studio.progress import counted
from ..studio.walker import MARGIN
from .frame import own_preset
from .machine import machine, resident_mb, tell
from .stroll import RATE, SECONDS, legs
from .walk import paced

Row = dict[str, float | None]

SIDES = (100.0, 1000.0, 10000.0)
"""Sides of the terrains [m]."""


def bench_scale(scene: str, *, preset: str | None, size: tuple[int, int], json: bool) -> int:
    """Measure a scene on larger and larger terrains, print the figures, and return the exit status.

    Each terrain has a process of its own. Raises InputError where the scene's terrain is not made from noise.
    """
    tell(scale_measured(scene, preset=preset, size=size), as_json=json)
    return 0


def scale_measured(scene: str, *, preset: str | None, size: tuple[int, int]) -> dict[str, object]:
    """Return what the benchmark tells of a scene on larger and larger terrains; raises InputError as `bench_scale`."""
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
