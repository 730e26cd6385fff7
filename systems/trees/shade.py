"""Maps of the optical depth of trees: along the sun's rays, near by and far off, and from above for the sky."""

from collections.abc import Sequence
from math import cos, radians, sin, tau

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles, Point
from ...engine.gl.guest import borrow, clear
from ...engine.gl.stream import Stream, release_all
from ...engine.gl.units import BORROWED
from ..wind.mean import MeanWind
from .kind import GpuKind
from .motion import CROWN_BENDS, TONES_APART, TRUNK_LEANS, TRUNK_SWINGS, tones, trunk_hertz
from .programs import Programs
from .standing import INSTANCE, Standing, far_instances
from .stream import CAST, QUAD, Uniforms

UNIT = BORROWED[0] - 1
"""Texture unit of the map, borrowed from the host and given back in the end."""

SIDE = 1024
"""Texels of each of the three maps, across and up."""

SIDES = 96.0, 800.0, 1024.0
"""Side of each map [m]."""

GLSL = {
    "SHADE_MAPS": float(len(SIDES)), "SHADE_SIDE": float(SIDE), "A_TURN": tau,
    "SHADE_LEANS": TRUNK_LEANS, "SHADE_SWINGS": TRUNK_SWINGS, "SHADE_TONES_APART": TONES_APART,
}  # fmt: skip

STEPS = 8.0, 64.0, 32.0
"""Distance a viewer goes before each map is drawn anew about another place [m]."""

USUAL_TRUNK = 0.03
"""Mean diameter of trunks, relative to their height."""

STEADY = 0.999995
"""Cosine of the sun's movement after which maps are drawn anew: 0.2 degrees."""


class ShadeMap:
    """The three maps side by side, drawn anew when the sun, the trees or the viewer have moved."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._texture = ctx.texture((len(SIDES) * SIDE, SIDE), 2, dtype="f2")
        self._texture.repeat_x = self._texture.repeat_y = False
        self._target = ctx.framebuffer([self._texture])
        self._sampler = ctx.sampler(repeat_x=False, repeat_y=False, filter=(moderngl.LINEAR, moderngl.LINEAR))
        self._streams: dict[int, Stream] = {}
        self._sun: Doubles = np.zeros(3)
        self._axes: Doubles = np.zeros((2, 3))
        self._drawn: list[object] = [None, None, None]
        self._wanted: list[tuple[object, tuple[float, float]]] = []
        self._standing: Standing | None = None

    def lose(self) -> None:
        """Draw all maps anew."""
        self._drawn = [None, None, None]
        release_all(*self._streams.values())
        self._streams = {}

    def sway(self, standing: Standing, wind: MeanWind | None, record: NDArray[np.void], /, *, time: float) -> None:
        """Write the displacement of crowns by the mean wind, which the maps leave out."""
        row, (high, _) = record[0], standing.medians
        strength, heading = (wind.strength, radians(wind.direction)) if wind else (0.0, 0.0)
        row["trees_aside"] = strength * CROWN_BENDS * high * np.array([sin(heading), -cos(heading)])
        row["trees_tones"] = tones(trunk_hertz(max(high, 1.0), USUAL_TRUNK * high), time)

    def follow(self, eye: Point, standing: Standing, record: NDArray[np.void], /) -> None:
        """Write where the maps lie for an eye."""
        row, sun = record[0], record["sun"][0].astype(np.float64)
        if float(sun @ self._sun) < STEADY:
            self._sun = sun
            across = np.array([sun[2], 0.0, -sun[0]])
            across = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-3 else np.array([1.0, 0.0, 0.0])
            self._axes = np.stack([across, np.cross(sun, across)])
        (_, low), self._wanted = standing.medians, []
        for step in STEPS:
            middle = np.array([round(eye[0] / step) * step, low, round(eye[2] / step) * step])
            centre = self._axes @ middle if step != STEPS[2] else middle[::2]
            self._wanted.append(((standing, tuple(middle), tuple(self._sun)), (float(centre[0]), float(centre[1]))))
        row["trees_across"], row["trees_up"] = self._axes
        row["trees_near"], row["trees_far"] = (_onto(number, self._wanted[number][1]) for number in range(2))
        row["trees_sky"] = *self._wanted[2][1], 1.0 / SIDES[2]

    def use(self) -> None:
        """Bind the maps for this frame."""
        borrow(UNIT, self._texture.glo)
        self._sampler.use(UNIT)

    def prepare(self, kinds: Sequence[GpuKind], programs: Programs, standing: Standing, numbers: Uniforms, /) -> int:
        """Draw the maps whose inputs have changed; return the number of draw calls."""
        due = [number for number, (inputs, _) in enumerate(self._wanted) if self._drawn[number] != inputs]
        if not due:
            return 0
        self._send(kinds, standing)
        ctx = self._ctx
        calls = 0
        for number in due:
            self._drawn[number], centre = self._wanted[number]
            self._target.viewport = self._target.scissor = number * SIDE, 0, SIDE, SIDE
            self._target.use()
            clear(self._target)
            ctx.enable_only(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE, moderngl.ONE
            tile = *centre, SIDES[number] / 2.0, float(number)
            for kind in kinds:
                for model in kind.models:
                    stream = self._streams.get(id(model))
                    if stream is None or not stream.count:
                        continue
                    array = programs.array(CAST, stream)
                    kind.set_uniforms(array.program, model, {**numbers, "tile": tile})
                    array.render(moderngl.TRIANGLES, vertices=QUAD, instances=stream.count)
                    calls += 1
            ctx.enable_only(moderngl.NOTHING)
        return calls

    def _send(self, kinds: Sequence[GpuKind], standing: Standing) -> None:
        if self._standing is standing and self._streams:
            return
        self._standing = standing
        for number, model in enumerate(model for kind in kinds for model in kind.models):
            rows = standing.of_model(number)
            rows = rows[rows["ring"] < 2]  # no shade is visible farther off
            if id(model) not in self._streams:
                self._streams[id(model)] = Stream(self._ctx, INSTANCE)
            self._streams[id(model)].write(far_instances(rows, np.float32(model.model.height), np.float32(0.0)))

    def release(self) -> None:
        """Release all GL objects."""
        release_all(*self._streams.values(), self._target, self._texture, self._sampler)


def _onto(number: int, middle: tuple[float, float]) -> tuple[float, ...]:
    """Return the scale [1/m] and the offset from a place on the sun's plane to texture coordinates on one of its maps.

    `middle` is the map's middle on that plane [m].
    """
    scale = 1.0 / (len(SIDES) * SIDES[number]), 1.0 / SIDES[number]
    return *scale, (0.5 + number) / len(SIDES) - scale[0] * middle[0], 0.5 - scale[1] * middle[1]
