"""Drawing of bodies: opaque, with a soft border along the silhouette."""

from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from math import cos, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.body import Body
from ...components.shade import Shade
from ...engine.gl.stream import Stream, attributes, release_all
from ..light.color import linear
from .saucer import RADIUS, THICK, borders, saucer

Axis = tuple[float, float, float]

INSTANCE = np.dtype([("middle", "3f4"), ("right", "3f4"), ("up", "3f4"), ("back", "3f4")])
"""Instance of a body: position [m], and its axes in the world."""

COLORS = {"metal": "#d4d6d0", "glass": "#24414a", "paint": "#c9502a"}
"""sRGB colours of the saucer's hull, dome and fin."""


def instances_of(bodies: Sequence[Body], /) -> NDArray[np.void]:
    """Return the instances of bodies, records of `INSTANCE`."""
    rows = np.zeros(len(bodies), INSTANCE)
    for row, body in zip(rows, bodies, strict=True):
        right, up, back = axes(body)
        row["middle"], row["right"], row["up"], row["back"] = body.place, right, up, back
    return rows


def shade_of(body: Body, /) -> Shade:
    """Return the shade by which a body casts its shadow."""
    return Shade(body.place, RADIUS, THICK, axes(body)[1])


@lru_cache(maxsize=64)
def axes(body: Body, /) -> tuple[Axis, Axis, Axis]:
    """Return a body's right, up and back in the world, unit vectors."""
    c, s = cos(body.yaw), sin(body.yaw)
    level, lifts, flat, tips = cos(body.nose), sin(body.nose), cos(body.bank), sin(body.bank)
    up = -lifts * s, level, lifts * c  # before it banks
    return (
        (flat * c - tips * up[0], -tips * up[1], flat * s - tips * up[2]),
        (flat * up[0] + tips * c, flat * up[1], flat * up[2] + tips * s),
        (-level * s, -lifts, level * c),
    )


FILES = "systems/bodies/body.vert", "systems/bodies/body.frag"
DEFINES: Sequence[Mapping[str, str | int]] = {}, {"BORDER": 1}
"""GLSL defines of the programs of a `BodyPainter`: for the body, and for its soft border."""


class _Layer:
    """A mesh with its program: the body, or the border along its silhouette."""

    def __init__(
        self, made: moderngl.Program, mesh: tuple[NDArray[np.void], NDArray[np.int32]], stream: Stream
    ) -> None:
        self.program = made
        for name, color in COLORS.items():
            made[name] = tuple(linear(color))
        self.buffers = [made.ctx.buffer(part) for part in mesh]
        form, names = attributes(mesh[0].dtype)
        contents = [(self.buffers[0], form, *names), stream.binding(made)]
        self.array = made.ctx.vertex_array(made, contents, index_buffer=self.buffers[1])

    def release(self) -> None:
        release_all(self.array, *self.buffers, self.program)


class BodyPainter:
    """Draws saucers with their programs."""

    def __init__(self, ctx: moderngl.Context, programs: Iterable[moderngl.Program]) -> None:
        self.stream = Stream(ctx, INSTANCE)
        mesh, (solid, border) = saucer(), programs
        self.solid, self.border = _Layer(solid, mesh, self.stream), _Layer(border, borders(*mesh), self.stream)

    def write(self, bodies: Sequence[Body]) -> None:
        """Upload the instances of bodies."""
        self.stream.write(instances_of(bodies))

    def draw(self, *, border: bool = False) -> int:
        """Draw the bodies, opaque, or blend their soft silhouettes over that; return the number of draw calls."""
        layer = self.border if border else self.solid
        if self.stream.count:
            layer.array.render(moderngl.TRIANGLES, instances=self.stream.count)
        return int(self.stream.count > 0)

    def release(self) -> None:
        """Release all GL objects."""
        release_all(self.solid, self.border, self.stream)
