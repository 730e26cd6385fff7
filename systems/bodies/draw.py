"""Drawing what flies over the prairie: opaque, with a soft border along the outline."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from math import cos, sin

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.body import Body
from ...components.shade import Shade
from ...engine.gl.shaders import Texts
from ...engine.gl.stream import Stream, attributes, release_all
from ..frame.block import FrameBlock, joined
from ..light.color import linear
from .saucer import RADIUS, THICK, borders, saucer

Axis = tuple[float, float, float]

PLACED = np.dtype([("middle", "3f4"), ("right", "3f4"), ("up", "3f4"), ("back", "3f4")])
"""Where a body is [m], and its own axes in the world."""

COLORS = {"metal": "#d4d6d0", "glass": "#24414a", "paint": "#c9502a"}
"""The saucer's colours (sRGB): of its hull, of its dome and of its fin."""


def placed(bodies: Sequence[Body], /) -> NDArray[np.void]:
    """Return where bodies are and how they are turned, records of `PLACED`."""
    rows = np.zeros(len(bodies), PLACED)
    for row, body in zip(rows, bodies, strict=True):
        right, up, back = axes(body)
        row["middle"], row["right"], row["up"], row["back"] = body.place, right, up, back
    return rows


def shade_of(body: Body, /) -> Shade:
    """Return what a body is to the sun."""
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
TOLD: Sequence[Mapping[str, str | int]] = {}, {"BORDER": 1}
"""What the programs of the body itself and of the border along its outline are told."""


class _Layer:
    """A mesh with its program: the body itself, or the border along its outline."""

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


def texts_of_bodies(block: FrameBlock, /) -> Iterator[Texts]:
    """Return what the programs of saucers are made of."""
    return (block.texts(*FILES, told) for told in TOLD)


def programs_of_bodies(
    ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /
) -> Iterator[moderngl.Program]:
    """Return them, each made when it is its turn."""
    return (joined(ctx, block, units, *FILES, told) for told in TOLD)


class BodyPainter:
    """Draws saucers with their programs."""

    def __init__(self, ctx: moderngl.Context, programs: Iterable[moderngl.Program]) -> None:
        self.stream = Stream(ctx, PLACED)
        mesh, (solid, border) = saucer(), programs
        self.solid, self.border = _Layer(solid, mesh, self.stream), _Layer(border, borders(*mesh), self.stream)

    def write(self, bodies: Sequence[Body]) -> None:
        """Send the bodies that are in the air."""
        self.stream.write(placed(bodies))

    def draw(self) -> int:
        """Draw the bodies, opaque; return the number of draw calls."""
        return self._draw(self.solid)

    def draw_border(self) -> int:
        """Draw their soft outlines over what is behind them; return the number of draw calls."""
        return self._draw(self.border)

    def _draw(self, layer: _Layer) -> int:
        if self.stream.count:
            layer.array.render(moderngl.TRIANGLES, instances=self.stream.count)
        return int(self.stream.count > 0)

    def release(self) -> None:
        """Give everything back."""
        release_all(self.solid, self.border, self.stream)
