"""A walk through the prairie: frames around changes of representation (figure 17)."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from ...systems.overlay.layers import Layer
from ..studio.encode import Picture
from ..studio.studio import Studio
from ..studio.take import Take
from .figure import Detail, PaperFigure
from .plot import Panel, plate

SCENE = "meadow"

TIMES = (7.7, 8.0, 8.4, 8.7)
"""Instants before, during and after changes [s]."""

RATE = 30
"""Frames of the walk per second."""

BEFORE = 2.0
"""Duration of the walk before the first frame [s]."""

LEVELS: frozenset[Layer] = frozenset({"levels", "weights"})


def walk_frames(detail: Detail, times: Sequence[float], /) -> list[tuple[Picture, Picture, int]]:
    """Return for rising `times` [s] of a walk: the picture, the same in colours, and the number of changing patches."""
    frames, shown = [], {round(time * RATE) for time in times}
    with Studio(Take(SCENE, detail.size, detail.preset)) as studio:
        prairie = studio.prairie
        for number in range(round((times[0] - BEFORE) * RATE), round(times[-1] * RATE) + 1):
            time = number / RATE
            prairie.advance(time - prairie.time)
            if number not in shown:
                studio.follow(studio.camera(time))
                continue
            seen = studio.picture(studio.camera(time))
            changing = prairie.statistics.transitions
            studio.overlay.layers = LEVELS
            frames.append((seen, studio.picture(studio.camera(time)), changing))
            studio.overlay.layers = frozenset()
    return frames


def draw_walk(detail: Detail, /) -> Figure:
    """Return figure 17: four frames of a walk, and under each its representations."""
    frames = walk_frames(detail, TIMES)
    rows = []
    for first in (0, 2):
        pair = list(zip("abcd", TIMES, frames, strict=True))[first : first + 2]
        rows.append([Panel(seen, f"{letter})  {time:.1f} s") for letter, time, (seen, _, _) in pair])
        rows.append([Panel(levels, _told(changing)) for _, _, (_, levels, changing) in pair])
    return plate(rows)


def _told(changing: int) -> str:
    return f"{changing} patches are changing" if changing else "none is changing"


FIGURES = (
    PaperFigure(
        17,
        "A walk through the prairie",
        "Four frames within a second of a walk, before, during and after patches change their representation; under "
        "each, the same frame with the representations in colours.",
        "The bundled scene meadow on its camera path. A patch that is two things at once has a square of the finer "
        "one's colour on the coarser one's, as large as its share.",
        draw_walk,
    ),
)
