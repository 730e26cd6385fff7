"""The presets side by side: their pictures and their costs (figure 16)."""

from collections.abc import Sequence
from functools import partial

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from ...engine.camera import camera_at, projection_matrix, view_matrix
from ...systems.prairie import Prairie
from ..studio.encode import Picture
from ..studio.offscreen import Offscreen
from ..studio.timing import timed
from .figure import Detail, PaperFigure
from .plot import Panel, plate

SCENE = "meadow"

ROWS = (("low", "medium", "high"), ("paper-low", "paper-medium", "paper-high"))
"""Names of the shown presets: the engine's own, and the paper's."""

UNIT = "high"
"""Preset whose frame time is the unit of the others' costs."""

TIME = 2.0
"""Instant of the scene [s]."""

ROUNDS = 5
"""Number of timings of each frame."""


def pictures(prairies: Sequence[Prairie], target: Offscreen, /) -> tuple[list[Picture], list[float]]:
    """Return each prairie's picture from the scene's camera, and the median time of its frame [ms].

    The prairies are drawn in turn, since a machine's speed varies over time.
    """
    views = [_matrices(prairie, target.size) for prairie in prairies]
    seen: list[Picture] = []
    times: list[list[float]] = [[] for _ in prairies]
    for number in range(ROUNDS + 1):
        for prairie, view, found in zip(prairies, views, times, strict=True):
            target.begin()
            took = timed(target.ctx, partial(prairie.draw, *view))
            if number:
                found.append(took)
            else:
                seen.append(target.read())
    return seen, [float(np.median(found)) for found in times]


def _matrices(prairie: Prairie, size: tuple[int, int]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    return view_matrix(camera), projection_matrix(camera.view, size[0] / size[1])


def draw_presets(detail: Detail, /) -> Figure:
    """Return figure 16: one view in all presets, with its blades and the cost of its frame."""
    names = [name for row in ROWS for name in row]
    with Offscreen(detail.size) as target:
        prairies = [Prairie.load(SCENE, ctx=target.ctx, preset=name, live=False) for name in names]
        for prairie in prairies:
            prairie.advance(TIME)
        seen, times = pictures(prairies, target)
        blades = [prairie.statistics.blades_considered for prairie in prairies]
        for prairie in prairies:
            prairie.release()
    unit = times[names.index(UNIT)]
    panels = {
        name: Panel(picture, f"{name}: {count / 1000:.0f}k blades, cost {time / unit:.1f}")
        for name, picture, count, time in zip(names, seen, blades, times, strict=True)
    }
    return plate([[panels[name] for name in row] for row in ROWS])


FIGURES = (
    PaperFigure(
        16,
        "The presets side by side",
        "One view of a meadow in low, medium and high quality; below, in the paper's own three. Under each, how many "
        "blades stand in the picture, in whatever representation, and what a frame costs, in frames of high.",
        "The bundled scene meadow from its fixed camera; costs are median times of frames that were drawn in turn.",
        draw_presets,
    ),
)
