"""The winds of a frame on the graphics card: what `hear.glsl` reads, and the programs that include it."""

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import cos, sin
from typing import Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray

from ...components.wind import Mixing, TwinValues, WindPrimitive
from ...engine.complaint import said
from ...engine.gl.guest import block_binding
from ...engine.gl.shaders import Line, ShaderError, program
from ...engine.gl.stream import release_all
from ..grow.record import Response
from .blow import MARGIN, Blowing, ReceiverArrays, claim, send
from .flutter import flutter_values
from .quarantine import Quarantine
from .sheets import Sheets, Told
from .twin import (
    ANY,
    LARGEST,
    MOST_NUMBERS,
    TOLD,
    Layout,
    Twin,
    TwinError,
    check_values,
    fitted,
    fitted_few,
    joined_twins,
    layout_of,
    twin_of,
)

Rows = NDArray[np.intp]

SAMPLERS = ("winds", "wind_sheets", "wind_curves", "wind_told")
"""What `hear.glsl` reads; whoever makes a `CardWinds` gives each a texture unit."""

HEAD, SHARE, SHEET = 16, 8, 12
"""Numbers in a row before those of `twin_values`, as `hear.glsl` reads them; where the share and the sheets stand."""

READY_ROWS, READY_SHEETS, READY_TOLD = 64, 16, 4
"""Room that a game has that prepares: for winds, for their tables, and for winds without a twin."""

_NOTHING = (0.0,) * (SHEET - 1)
_TRIED = "systems/wind/hear.vert"

log = logging.getLogger("tallgrass")


class Answering(Protocol):
    """What grass of a kind is known by here, as a `Growth` is."""

    @property
    def response(self) -> Response:
        """How it answers a wind over time."""
        ...


class CardWinds:
    """The winds that act, as one GL context holds them.

    Each frame: `write` the winds, `tell` receivers what those without a twin say, take each `program`, and `use` it.
    A program that was asked for before is another one after a new kind of wind has come.
    """

    def __init__(self, ctx: moderngl.Context, units: Mapping[str, int], growths: Sequence[Answering]) -> None:
        self.ctx = ctx
        self._units = {name: units[name] for name in SAMPLERS}
        self._rows = np.zeros((8, HEAD + MOST_NUMBERS), np.float32)
        self._sent = b""
        self._records = self._room()
        self._sheets, self._told, self._curves = Sheets(ctx), Told(ctx), curve_texture(ctx, growths)
        self.reasons: dict[type[WindPrimitive], str] = {}
        """Why the twin of a class of winds is left out."""
        self._numbers: dict[type[WindPrimitive], int] = {}
        self._twins: list[Twin] = []
        self._layouts: list[Layout] = []
        self._order: list[int] = []
        self._ready: list[int] = []
        """The order of runs whose program is there, and beside it one for winds in any order; empty before."""
        self._coming: list[int] = []
        """The order of runs whose program is to be there."""
        self._programs: dict[object, moderngl.Program] = {}
        self._winds: list[Blowing] = []
        self._untwinned: list[int] = []
        self._asked: tuple[float, Mixing] = 0.0, "priority"

    def regrow(self, growths: Sequence[Answering], /) -> None:
        """Ask from now on how other grass answers."""
        self._curves.release()
        self._curves = curve_texture(self.ctx, growths)

    # ---- Winds -----------------------------------------------------------------------------------

    def meet(self, winds: Iterable[WindPrimitive], /) -> None:
        """Make room for winds that may blow later, so that programs change now and not when they do."""
        self._runs(self._met(winds))

    def _met(self, winds: Iterable[WindPrimitive]) -> list[int]:
        """Return the twins of winds, the strongest claim first."""
        return [self._number_of(wind, wind.start, 0) for wind in sorted(winds, key=claim, reverse=True)]

    def expecting(self, winds: Sequence[WindPrimitive], /) -> Iterator[None]:
        """Meet winds of these kinds, a new one at a time, as each takes a program; then `orders` has one for them."""
        for wind in winds:
            if type(wind) not in self._numbers:
                self._number_of(wind, wind.start, 0)
                yield
        self._coming, _ = fitted_few(self._order, self._met(winds))

    def stand_ready(self) -> None:
        """Draw from now on with the programs for those that are expected.

        A program is another one only for a kind that was never met: winds that come in another order than their claims
        share one that asks each wind what it is.
        """
        self._ready = self._coming

    def make_room(self, winds: Sequence[WindPrimitive], /, *, receivers: int) -> None:
        """Make room for winds of these kinds, `receivers` of which are told something where a kind has no twin."""
        self._reserve(READY_ROWS, 0)
        known = [(wind, self._numbers[type(wind)]) for wind in winds]
        tables = [wind.twin_values(time=0.0, seed=0).sheets for wind, number in known if number != TOLD]
        shapes = [table.shape for each in tables for table in each]
        rows, columns = (max((shape[axis] for shape in shapes), default=1) for axis in (0, 1))
        self._sheets.reserve(rows, columns, READY_SHEETS)
        if any(number == TOLD for _, number in known):
            self._told.reserve(READY_TOLD, receivers)

    @property
    def runs(self) -> tuple[int, ...]:
        """What programs are made for: of which twin each run of winds is, and how many twins there are."""
        return *self._order, len(self._twins)

    @property
    def orders(self) -> list[list[int]]:
        """Each order of runs that a program may be asked for once winds that are expected blow."""
        return [self._coming, [ANY]]

    @contextmanager
    def ordered(self, order: list[int]) -> Iterator[None]:
        """Let programs be those of another order of runs meanwhile."""
        before, self._order = self._order, order
        try:
            yield
        finally:
            self._order = before

    def write(
        self, winds: Sequence[Blowing], /, *, time: float, seed: int, mixing: Mixing, yaw: float = 0.0
    ) -> list[Blowing]:
        """Send the winds of a frame, the strongest claim first, and return those that have no twin.

        `time` [s], `seed`, `mixing` and `yaw` are those of `systems.wind.blow.hear`. Winds without a twin say nothing
        until `tell` has asked them.
        """
        self._asked = time, mixing
        weighs = mixing == "weight"
        self._winds = [wind for wind in winds if wind.primitive.weight > 0.0] if weighs else list(winds)
        self._reserve(len(self._winds) + 1, 0)
        self._sheets.begin()
        numbers = [self._write(number, wind, time, weighs=weighs) for number, wind in enumerate(self._winds)]
        self._untwinned = [number for number, twin in enumerate(numbers) if twin == TOLD]
        frame = flutter_values(time=time, seed=seed, yaw=yaw)
        self._put(0, (float(weighs), *_NOTHING), TwinValues([*frame.numbers, *self._runs(numbers)], frame.sheets))
        self._send()
        return [self._winds[number] for number in self._untwinned]

    def _write(self, number: int, wind: Blowing, time: float, *, weighs: bool) -> int:
        """Write a wind into its row, and return the number of its twin."""
        primitive = wind.primitive
        twin, values = self._number_of(primitive, time, wind.seed), TwinValues()
        if twin != TOLD:
            try:
                values = self._layouts[twin].packed(primitive, primitive.twin_values(time=time, seed=wind.seed))
                check_values(self._twins[twin], values)
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self._do_without(type(primitive), error)
                twin, values = TOLD, TwinValues()
        after = self._winds[number + 1].primitive.priority if number + 1 < len(self._winds) else None
        ends = not weighs or after != primitive.priority
        share = 0.0 if twin == TOLD else wind.strength * (primitive.weight if weighs else 1.0)
        self._put(number + 1, (*_frame_of(wind), share, primitive.swing, float(ends), float(twin)), values)
        return twin

    def _runs(self, numbers: Sequence[int]) -> list[int]:
        """Return in which row each run of a program ends, with room in programs for all that are needed."""
        if self._ready:
            found, ends = fitted(self._ready, numbers)
            self._order = found if found == self._ready else [ANY]
            return ends if found == self._ready else [len(numbers) + 1]
        self._order, ends = fitted_few(self._order, numbers)
        return ends

    def _reserve(self, rows: int, numbers: int) -> None:
        """Make room for so many rows with so many numbers in each."""
        before = self._rows
        if rows > len(before) or numbers > before.shape[1]:
            self._rows = np.zeros((max(2 * rows, len(before)), -(-max(numbers, before.shape[1]) // 4) * 4), np.float32)
            self._rows[: len(before), : before.shape[1]] = before
            self._records.release()
            self._records = self._room()

    def _put(self, row: int, head: tuple[float, ...], values: TwinValues) -> None:
        layers = self._sheets.layers(values.sheets) if values.sheets else []
        record = *head, *layers, *[0] * (4 - len(layers)), *values.numbers
        self._reserve(0, len(record))
        self._rows[row, : len(record)] = record

    def _send(self) -> None:
        used = self._rows[: len(self._winds) + 1]
        packed = used.tobytes()
        if packed != self._sent:
            self._records.write(packed, viewport=(0, 0, self._records.width, len(used)))
            self._sent = packed

    def tell(
        self,
        receivers: Callable[[], ReceiverArrays],
        quarantine: Quarantine,
        /,
        *,
        numbers: Callable[[], Rows] | None = None,
    ) -> None:
        """Ask the winds without a twin what they tell receivers; where all have one, nothing is asked for.

        `numbers` (n,) are the receivers' in `hear.glsl`; without it they count from 0. A wind that fails says nothing
        in this frame.
        """
        if not self._untwinned:
            return
        heard, (time, mixing) = receivers(), self._asked
        number = np.arange(len(heard.place)) if numbers is None else numbers()
        self._told.reserve(len(self._untwinned), int(number.max(initial=0)) + 1)
        nobody, everybody = np.zeros(0, np.intp), np.ones(len(heard.place), np.float32)
        for count, row in enumerate(self._untwinned):
            sent = send(self._winds[row], heard, everybody, quarantine, time, mixing)
            if sent is None:
                self._told.write(count, nobody, np.zeros((0, 2), np.float32), np.zeros(0, np.float32))
            else:
                self._told.write(count, number[sent.rows], sent.message, sent.weight)
            self._rows[row + 1, SHARE], self._rows[row + 1, SHEET] = 1.0, count * self._told.block
        for row, wind in enumerate(self._winds, 1):
            if wind.source in quarantine.reasons:  # what it sent before it failed is no message
                self._rows[row, SHARE] = 0.0
        self._send()

    # ---- Programs --------------------------------------------------------------------------------

    def program(
        self,
        vertex: str,
        fragment: str | None,
        *,
        defines: Mapping[str, str | int] | None = None,
        varyings: tuple[str, ...] = (),
    ) -> moderngl.Program:
        """Return the program of two shader files with the twins that there are; it is kept until there is another.

        It knows where the textures are, and the frame's block if it has one. Raises `ShaderError` as
        `engine.gl.shaders.program` does.
        """
        order = tuple(self._order)
        among = len(self._twins) if ANY in order else 0
        key = vertex, fragment, tuple((defines or {}).items()), varyings, order, among
        if key not in self._programs:
            twins = joined_twins(self._twins, order, self._layouts)
            self._programs[key] = self._made(vertex, fragment, defines, varyings, twins)
        return self._programs[key]

    def _made(
        self,
        vertex: str,
        fragment: str | None,
        defines: Mapping[str, str | int] | None,
        varyings: tuple[str, ...],
        twins: Mapping[str, Sequence[Line]],
    ) -> moderngl.Program:
        made = program(self.ctx, vertex, fragment, defines=defines, varyings=varyings, made=twins)
        for name, unit in self._units.items():
            if name in made:
                made[name] = unit
        if "Frame" in made:
            made["Frame"].binding = block_binding(self.ctx)  # type: ignore[union-attr]
        return made

    def use(self) -> None:
        """Bind what programs read of the winds."""
        self._records.use(self._units["winds"])
        self._curves.use(self._units["wind_curves"])
        self._told.texture.use(self._units["wind_told"])
        self._sheets.texture.use(self._units["wind_sheets"])

    # ---- Twins -----------------------------------------------------------------------------------

    def _number_of(self, wind: WindPrimitive, time: float, seed: int) -> int:
        """Return which of the twins is that of a wind's class, `TOLD` where numpy does without one.

        Of the first of a class it is asked how its record lies, at a time [s] and with a seed.
        """
        kind = type(wind)
        if kind not in self._numbers:
            self._numbers[kind] = TOLD
            try:
                twin = twin_of(kind)
                self._numbers[kind] = TOLD if twin is None else self._admit(twin, wind, time, seed)
            except Exception as error:  # noqa: BLE001 - a plugin may raise anything
                self._do_without(kind, error)
        return self._numbers[kind]

    def _admit(self, twin: Twin, wind: WindPrimitive, time: float, seed: int) -> int:
        """Return the number of a twin among the others; raises ShaderError where it does not go with them."""
        if twin not in self._twins:
            layout = layout_of(twin, wind, wind.twin_values(time=time, seed=seed))
            twins, layouts = [*self._twins, twin], [*self._layouts, layout]
            self._made(_TRIED, None, None, ("message",), joined_twins(twins, range(len(twins)), layouts)).release()
            self._twins, self._layouts = twins, layouts
        return self._twins.index(twin)

    def _do_without(self, kind: type[WindPrimitive], error: Exception) -> None:
        """Leave a twin out from now on, and say so."""
        self._numbers[kind] = TOLD
        log.debug("%s", kind.__name__, exc_info=error)
        told = str(error) if isinstance(error, TwinError | ShaderError) else said(error)
        why = " ".join(told.split())
        self.reasons[kind] = why
        log.warning("the twin of %s.%s cannot be used: %s; numpy does without it", kind.__module__, kind.__name__, why)

    def _room(self) -> moderngl.Texture:
        self._sent = b""
        texture = self.ctx.texture((self._rows.shape[1] // 4, len(self._rows)), 4, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def release(self) -> None:
        """Give everything back to the context."""
        release_all(self._records, self._sheets, self._told, self._curves, *self._programs.values())


def curve_texture(ctx: moderngl.Context, growths: Sequence[Answering], /) -> moderngl.Texture:
    """Return how kinds of grass answer a wind: a row each, the index after it starts and stops, and the step [s]."""
    texels = np.zeros((len(growths), len(growths[0].response.rise), 3), np.float32)
    for row, growth in zip(texels, growths, strict=True):
        response = growth.response
        row[:, 0], row[:, 1], row[:, 2] = response.rise, response.fall, response.step
    texture = ctx.texture((texels.shape[1], len(texels)), 3, texels, dtype="f4")
    texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
    return texture


def _frame_of(wind: Blowing) -> tuple[float, ...]:
    """Return where a wind is, how it is turned, and the rectangle it holds, as masks are left out beyond it."""
    pose, held = wind.pose, wind.extent
    turned = pose.x, pose.z, cos(pose.yaw), sin(pose.yaw)
    if held is None:
        return *turned, -LARGEST, LARGEST, -LARGEST, LARGEST
    low, high = max(held.left, -LARGEST) - MARGIN, min(held.right, LARGEST) + MARGIN
    return *turned, low, high, max(held.ahead, -LARGEST) - MARGIN, min(held.behind, LARGEST) + MARGIN
