"""Rendered scenes: a gust, a whirlwind and a blast as they pass through grass (figures 9, 11 and 12)."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from ...engine.camera import Camera
from ...systems.overlay.layers import Layer
from ..studio.encode import Picture
from ..studio.studio import Studio
from ..studio.take import Take
from .figure import Detail, PaperFigure
from .plot import Panel, plate


@dataclass(frozen=True, slots=True)
class Viewpoint:
    """A place and a direction of a camera in a scene."""

    place: tuple[float, float]
    """Ground position (x, z) [m]."""

    eye: float
    """Height above the ground [m]."""

    yaw: float
    """Yaw of the camera [degrees]."""

    pitch: float
    """Pitch of the camera [degrees]."""

    view: float = 42.0
    """Vertical angle of view [degrees]."""

    def camera(self, studio: Studio, /) -> Camera:
        """Return the camera there."""
        x, z = self.place
        ground = float(studio.prairie.height_at(np.array([self.place], np.float32))[0])
        return Camera(
            (x, ground + self.eye, z), math.radians(self.yaw), math.radians(self.pitch), math.radians(self.view)
        )


def pictures(
    scene: str, times: Sequence[float], viewpoint: Viewpoint, parts: Sequence[frozenset[Layer]], detail: Detail, /
) -> list[list[Picture]]:
    """Return pictures of a scene: a row for each of the rising `times` [s], with each overlay of `parts` in turn."""
    with Studio(Take(scene, detail.size, detail.preset)) as studio:
        camera, rows = viewpoint.camera(studio), []
        for time in times:
            studio.prairie.advance(time - studio.prairie.time)
            row = []
            for overlay in parts:
                studio.overlay.layers = overlay
                row.append(studio.picture(camera))
            rows.append(row)
    return rows


PLAIN: frozenset[Layer] = frozenset()
ARROWS: frozenset[Layer] = frozenset({"arrows"})
LEVELS: frozenset[Layer] = frozenset({"levels", "masks"})


def draw_gust(detail: Detail, /) -> Figure:
    """Return figure 9: a gust passes over a prairie, at three instants."""
    times = (4.6, 5.2, 6.0)
    rows = pictures("gust", times, Viewpoint((0.0, 64.0), 4.0, -8.0, -17.0), (PLAIN, ARROWS), detail)
    said = ("it comes from the left", "it passes", "the grass swings back behind it")
    return plate([
        [Panel(seen, f"{letter})  {time:.1f} s: {what}"), Panel(felt, "what its receivers feel")]
        for letter, time, what, (seen, felt) in zip("abc", times, said, rows, strict=True)
    ])  # fmt: skip


def draw_whirlwind(detail: Detail, /) -> Figure:
    """Return figure 11: a whirlwind."""
    ((seen, felt),) = pictures("whirlwind", (5.0,), Viewpoint((-1.0, 11.5), 5.5, 0.0, -28.0), (PLAIN, ARROWS), detail)
    return plate([[Panel(seen, "a)  a whirlwind"), Panel(felt, "b)  what its receivers feel")]])


def draw_blast(detail: Detail, /) -> Figure:
    """Return figure 12: a blast that meets 3D and 2.5D patches at once."""
    ((seen, parts),) = pictures("saucer", (4.0,), Viewpoint((0.0, 16.0), 4.2, -10.0, -17.0), (PLAIN, LEVELS), detail)
    return plate([[Panel(seen, "a)  a blast under a saucer"), Panel(parts, "b)  representations, and the mask")]])


FIGURES = (
    PaperFigure(
        9,
        "A gust of wind",
        "A gust passes over a field of barley from left to right; on the right, the same with what the grass feels.",
        "The bundled scene gust at three instants from one place; arrows are messages that receivers hold.",
        draw_gust,
    ),
    PaperFigure(
        11,
        "A whirlwind",
        "Grass lies along the circles of a whirlwind, the flatter the nearer to its middle.",
        "The bundled scene whirlwind; arrows are messages that receivers hold.",
        draw_whirlwind,
    ),
    PaperFigure(
        12,
        "A blast over two representations",
        "The blast of air under a flying saucer presses 3D blades and 2.5D strips alike.",
        "The bundled scene saucer, and the same picture with the representations in colours and the blast's mask.",
        draw_blast,
    ),
)
