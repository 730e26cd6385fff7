"""Maps of what trees leave of the light: of the sun's near by and far off, and of the sky's from above."""

from collections.abc import Sequence
from math import cos, radians, sin, tau

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.arrays import Doubles
from ...engine.gl.guest import borrow
from ...engine.gl.stream import Stream, release_all
from ...engine.gl.units import BORROWED
from ..wind.mean import MeanWind
from .kind import GpuKind
from .motion import CROWN_BENDS, TONES_APART, TRUNK_LEANS, TRUNK_SWINGS, tones, trunk_hertz
from .programs import Programs
from .standing import INSTANCE, Standing, far_instances
from .stream import CAST, QUAD, Numbers

UNIT = BORROWED[0] - 1
"""The texture unit that the map is bound to: a host's, and given back in the end."""

SIDE = 1024
"""Texels of each of the three maps, across and up."""

SIDES = 96.0, 800.0, 1024.0
"""How far each reaches from edge to edge [m]."""

GLSL = {
    "SHADE_MAPS": float(len(SIDES)), "SHADE_SIDE": float(SIDE), "A_TURN": tau,
    "SHADE_LEANS": TRUNK_LEANS, "SHADE_SWINGS": TRUNK_SWINGS, "SHADE_TONES_APART": TONES_APART,
}  # fmt: skip

STEPS = 8.0, 64.0, 32.0
"""How far a viewer goes before one is drawn anew about another place [m]."""

USUAL_TRUNK = 0.03
"""How thick trunks are in the mean, of their height."""

STEADY = 0.999995
"""Cosine of how far the sun goes before they are drawn anew: 0.2 degrees."""

Place = tuple[float, float, float]


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
        self._due: list[tuple[object, tuple[float, float]]] = []
        self._standing: Standing | None = None

    def lose(self) -> None:
        """Draw all anew."""
        self._drawn = [None, None, None]
        release_all(*self._streams.values())
        self._streams = {}

    def sway(self, standing: Standing, wind: MeanWind | None, record: NDArray[np.void], /, *, time: float) -> None:
        """Write how far the mean wind blows crowns aside just now, which the maps do not have."""
        row, (high, _) = record[0], standing.medians
        strength, heading = (wind.strength, radians(wind.direction)) if wind else (0.0, 0.0)
        row["trees_aside"] = strength * CROWN_BENDS * high * np.array([sin(heading), -cos(heading)])
        row["trees_tones"] = tones(trunk_hertz(max(high, 1.0), USUAL_TRUNK * high), time)

    def follow(self, eye: Place, standing: Standing, record: NDArray[np.void], /) -> None:
        """Write where the maps lie for an eye, and note which of them are due."""
        row, sun = record[0], record["sun"][0].astype(np.float64)
        if float(sun @ self._sun) < STEADY:
            self._sun = sun
            across = np.array([sun[2], 0.0, -sun[0]])
            across = across / np.linalg.norm(across) if np.linalg.norm(across) > 1e-3 else np.array([1.0, 0.0, 0.0])
            self._axes = np.stack([across, np.cross(sun, across)])
        (_, low), self._due = standing.medians, []
        for step in STEPS:
            middle = np.array([round(eye[0] / step) * step, low, round(eye[2] / step) * step])
            at = self._axes @ middle if step != STEPS[2] else middle[::2]
            self._due.append(((standing, tuple(middle), tuple(self._sun)), (float(at[0]), float(at[1]))))
        row["trees_across"], row["trees_up"] = self._axes
        row["trees_middle"] = *self._due[0][1], *self._due[1][1]
        row["trees_sky"], row["trees_spans"] = (*self._due[2][1], 1.0 / SIDES[2]), (1.0 / SIDES[0], 1.0 / SIDES[1])

    def use(self) -> None:
        """Bind them for this frame."""
        borrow(UNIT, self._texture.glo)
        self._sampler.use(UNIT)

    def prepare(self, kinds: Sequence[GpuKind], programs: Programs, standing: Standing, numbers: Numbers, /) -> int:
        """Draw those that are due; return the number of draw calls."""
        due = [number for number, (made_of, _) in enumerate(self._due) if self._drawn[number] != made_of]
        if not due:
            return 0
        self._send(kinds, standing)
        ctx = self._ctx
        calls = 0
        for number in due:
            self._drawn[number], at = self._due[number]
            self._target.viewport = self._target.scissor = number * SIDE, 0, SIDE, SIDE
            self._target.use()
            self._target.clear()
            ctx.enable_only(moderngl.BLEND)
            ctx.blend_func = moderngl.ONE, moderngl.ONE
            tile = *at, SIDES[number] / 2.0, float(number)
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
            own = standing.of_model(number)
            own = own[own["ring"] < 2]  # what is farther off shades nothing that is seen to be shaded
            if id(model) not in self._streams:
                self._streams[id(model)] = Stream(self._ctx, INSTANCE)
            self._streams[id(model)].write(far_instances(own, np.float32(model.model.height), np.float32(0.0)))

    def release(self) -> None:
        """Give everything back."""
        release_all(*self._streams.values(), self._target, self._texture, self._sampler)
