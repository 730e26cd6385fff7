"""The feature of bodies that fly over a prairie."""

from collections.abc import Iterator, Mapping, Sequence
from math import dist

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.body import Body
from ...components.shade import Shade
from ...engine.gl.shaders import Texts
from ...engine.gl.stream import release_all
from ..around.outlook import Outlook
from ..frame.block import BODIES, FrameBlock, joined
from ..frame.feature import Feature, Part, Start
from ..shadows.shades import round_shade
from ..space.grown import Grown
from .draw import DEFINES, FILES, BodyPainter, shade_of
from .fly import flying, may_fly


class Bodies(Feature):
    """Feature: entities of one world with a `Body`, and bodies that hover over its winds."""

    def __init__(self, start: Start, /) -> None:
        self._world, self._grown, self._quarantine = start.world, start.grown, start.quarantine

    def settle(self, grown: Grown, before: Grown, /, *, time: float) -> None:
        """Take the new grass, over which bodies fly."""
        self._grown = grown

    def flying(self, time: float, /) -> list[Body]:
        """Return the bodies in the air at a time [s]."""
        return flying(self._world, self._grown.top_at, self._quarantine, time=time)

    @property
    def are_due(self) -> bool:
        """Whether a body is in the air, or will hover over a wind once that blows."""
        return may_fly(self._world, self._quarantine)

    def part(self, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int], /) -> "BodiesPart":
        """Return the part that draws the bodies."""
        return BodiesPart(self, ctx, block, units)


class BodiesPart(Part):
    """Draws bodies and writes their shadows into the frame block; the painter is made when it is first due."""

    def __init__(self, bodies: Bodies, ctx: moderngl.Context, block: FrameBlock, units: Mapping[str, int]) -> None:
        self._bodies, self._ctx, self._block, self._units = bodies, ctx, block, units
        self.painter: BodyPainter | None = None

    def make_ready(self, grown: Grown, /) -> None:
        """Make the painter before anything flies."""
        self._make()

    def texts(self) -> Iterator[Texts]:
        """Return the sources of the painter's programs, if it is due."""
        return (self._block.texts(*FILES, each) for each in DEFINES if self._is_due)

    def making(self) -> Iterator[None]:
        """Make the painter, if it is due, a program at a time."""
        programs = list[moderngl.Program]()
        try:
            for program in self._programs() if self._is_due else ():
                programs.append(program)
                yield
            if programs and self.painter is None:
                self.painter, programs = BodyPainter(self._ctx, programs), []
        finally:
            release_all(*programs)

    @property
    def _is_due(self) -> bool:
        """Whether the painter is missing, and bodies may fly."""
        return self.painter is None and self._bodies.are_due

    def rehearse(self, record: NDArray[np.void], /) -> None:
        """Set one body with its shadow."""
        body = Body((0.0, 0.0, 0.0))
        cast(record, [shade_of(body)])
        if self.painter is not None:
            self.painter.write([body])

    def _make(self) -> None:
        if self.painter is None:
            self.painter = BodyPainter(self._ctx, self._programs())

    def _programs(self) -> Iterator[moderngl.Program]:
        """Compile the painter's programs, one each time the iterator is advanced."""
        return (joined(self._ctx, self._block, self._units, *FILES, each) for each in DEFINES)

    def send(self, outlook: Outlook, record: NDArray[np.void], /) -> None:
        """Upload the bodies in the air, and write the nearest ones' shadows."""
        flies = self._bodies.flying(outlook.viewer.time)
        cast(record, nearest([*map(shade_of, flies)], outlook.viewer.eye))
        if flies:
            self._make()
        if self.painter is not None:
            self.painter.write(flies)

    def draw_solid(self) -> int:
        """Draw the bodies, opaque."""
        return 0 if self.painter is None else self.painter.draw()

    def draw_soft(self, beyond: float = 0.0) -> int:
        """Draw their soft silhouettes."""
        return 0 if self.painter is None else self.painter.draw(border=True)

    def release(self) -> None:
        """Release the painter."""
        release_all(self.painter)


def nearest(shades: Sequence[Shade], eye: tuple[float, float, float], /) -> list[Shade]:
    """Return the shades nearest to the eye, nearest first, at most `BODIES`."""
    return sorted(shades, key=lambda shade: dist(shade.place, eye))[:BODIES]


def cast(record: NDArray[np.void], shades: Sequence[Shade], /) -> None:
    """Write at most `BODIES` round shades into the frame block's record."""
    row = record[0]
    row["bodies"]["radius"] = 0.0
    for into, shade in zip(row["bodies"], shades, strict=False):
        into["middle"], into["axis"], into["radius"], into["pressed"] = shade.place, *round_shade(shade)
