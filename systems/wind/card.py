"""The winds of a frame on the graphics card: the textures that `hear.glsl` reads, and programs that include it."""

import logging
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from math import cos, sin

import moderngl
import numpy as np

from ...components.arrays import Floats, Indices
from ...components.wind import Mixing, WindPrimitive
from ...engine.complaint import said
from ...engine.gl.guest import block_binding
from ...engine.gl.shaders import Line, ShaderError, program
from ...engine.gl.stream import release_all
from ...engine.gl.texture import by_texel
from ..grow.record import Response
from .blow import MARGIN, Blowing, ReceiverArrays, claim, send
from .flutter import flutter_values
from .quarantine import Quarantine
from .sheets import MessageTexture, Sheets
from .twin import (
    ANY,
    LARGEST,
    MOST_NUMBERS,
    NO_TWIN,
    Layout,
    Twin,
    TwinError,
    check_values,
    fit_few_runs,
    fit_runs,
    joined_twins,
    layout_of,
    twin_of,
)

SAMPLERS = ("winds", "wind_sheets", "wind_curves", "wind_messages")
"""Samplers of `hear.glsl`; the maker of a `CardWinds` assigns each a texture unit."""

HEAD, SHARE, SHEET = 16, 8, 12
"""Offsets in a wind's row, as `hear.glsl` reads it: of the numbers of `twin_values`, of its share, of its sheets."""

READY_ROWS, READY_SHEETS, READY_UNTWINNED = 64, 16, 4
"""Capacity after a game has prepared: winds, their tables, and winds without a twin."""

_NOTHING = (0.0,) * (SHEET - 1)
_TRIED = "systems/wind/hear.vert"
"""Shader that a new twin is compiled in, to find whether it can be used."""

log = logging.getLogger("tallgrass")


class CardWinds:
    """The winds that act, in one GL context.

    Each frame: `write` the winds, `tell` the messages of winds without a twin, get each `program`, and `use` the
    textures. A new kind of wind changes what `program` returns.
    """

    def __init__(self, ctx: moderngl.Context, units: Mapping[str, int], responses: Sequence[Response]) -> None:
        self.ctx = ctx
        self._units = {name: units[name] for name in SAMPLERS}
        self._rows = np.zeros((8, HEAD + MOST_NUMBERS), np.float32)
        """Row of the frame, then a row for each wind."""
        self._sent = b""
        """Rows uploaded last."""
        self._records = self._row_texture()
        self._sheets, self._messages, self._curves = Sheets(ctx), MessageTexture(ctx), curve_texture(ctx, responses)
        self.reasons: dict[type[WindPrimitive], str] = {}
        """Reason why the twin of a class of winds is not used."""
        self._numbers: dict[type[WindPrimitive], int] = {}
        """Index into `_twins` for each class of winds, or `NO_TWIN`."""
        self._twins: list[Twin] = []
        self._layouts: list[Layout] = []
        self._order: list[int] = []
        """Twin of each run of winds in the current programs."""
        self._ready: list[int] = []
        """Order of runs whose program is compiled, as is one for winds in any order; empty before."""
        self._coming: list[int] = []
        """Order of runs whose program is being compiled."""
        self._programs: dict[object, moderngl.Program] = {}
        self._winds: list[Blowing] = []
        self._untwinned: list[int] = []
        """Indices into `_winds` of those without a twin."""
        self._asked: tuple[float, Mixing] = 0.0, "priority"
        """Time [s] and mixing of the last `write`."""

    def regrow(self, responses: Sequence[Response], /) -> None:
        """Use the responses of other grass from now on."""
        self._curves.release()
        self._curves = curve_texture(self.ctx, responses)

    # ---- Winds -----------------------------------------------------------------------------------

    def meet(self, winds: Iterable[WindPrimitive], /) -> None:
        """Include winds that may blow later in the programs, so that these change now and not in a later frame."""
        self._fit(self._twins_of(winds))

    def _twins_of(self, winds: Iterable[WindPrimitive]) -> list[int]:
        """Return the numbers of the winds' twins, the strongest claim first."""
        return [self._twin_of(wind, wind.start, 0) for wind in sorted(winds, key=claim, reverse=True)]

    def expecting(self, winds: Sequence[WindPrimitive], /) -> Iterator[None]:
        """Admit the twins of winds, one new kind at a step, as each compiles a program; then set `orders` for them."""
        for wind in winds:
            if type(wind) not in self._numbers:
                self._twin_of(wind, wind.start, 0)
                yield
        self._coming, _ = fit_few_runs(self._order, self._twins_of(winds))

    def stand_ready(self) -> None:
        """Draw from now on with the programs of `orders`.

        Only a kind that is new to them needs another program: winds in another order than that of their claims share
        one that branches on the twin of each wind.
        """
        self._ready = self._coming

    def make_room(self, winds: Sequence[WindPrimitive], /, *, receivers: int) -> None:
        """Allocate textures for winds of these kinds, and for messages to `receivers` where a kind has no twin."""
        self._reserve(READY_ROWS, 0)
        known = [(wind, self._numbers[type(wind)]) for wind in winds]
        tables = [wind.twin_values(time=0.0, seed=0).sheets for wind, number in known if number != NO_TWIN]
        shapes = [table.shape for each in tables for table in each]
        rows, columns = (max((shape[axis] for shape in shapes), default=1) for axis in (0, 1))
        self._sheets.reserve(rows, columns, READY_SHEETS)
        if any(number == NO_TWIN for _, number in known):
            self._messages.reserve(READY_UNTWINNED, receivers)

    @property
    def runs(self) -> tuple[int, ...]:
        """Key of the programs: the twin of each run of winds, and the number of twins."""
        return *self._order, len(self._twins)

    @property
    def orders(self) -> list[list[int]]:
        """Orders of runs that programs may be needed for once the expected winds blow."""
        return [self._coming, [ANY]]

    @contextmanager
    def ordered(self, order: list[int]) -> Iterator[None]:
        """Return programs of another order of runs within the context."""
        before, self._order = self._order, order
        try:
            yield
        finally:
            self._order = before

    def write(
        self, winds: Sequence[Blowing], /, *, time: float, seed: int, mixing: Mixing, yaw: float = 0.0
    ) -> list[Blowing]:
        """Upload the winds of a frame, the strongest claim first, and return those without a twin.

        `time` [s], `seed`, `mixing` and `yaw` are those of `systems.wind.blow.hear`. Winds without a twin say nothing
        until `tell` has uploaded their messages.
        """
        self._asked = time, mixing
        weighs = mixing == "weight"
        self._winds = [wind for wind in winds if wind.primitive.weight > 0.0] if weighs else list(winds)
        self._reserve(len(self._winds) + 1, 0)
        self._sheets.begin()
        numbers = [self._write(number, wind, time, weighs=weighs) for number, wind in enumerate(self._winds)]
        self._untwinned = [number for number, twin in enumerate(numbers) if twin == NO_TWIN]
        oscillation, table = flutter_values(time=time, seed=seed, yaw=yaw)
        self._put(0, (float(weighs), *_NOTHING), [*oscillation, *self._fit(numbers)], [table])
        self._send()
        return [self._winds[number] for number in self._untwinned]

    def _write(self, number: int, wind: Blowing, time: float, *, weighs: bool) -> int:
        """Write a wind into its row, and return the number of its twin."""
        primitive = wind.primitive
        twin = self._twin_of(primitive, time, wind.seed)
        numbers: Sequence[float] = ()
        sheets: Sequence[Floats] = ()
        if twin != NO_TWIN:
            try:
                values = primitive.twin_values(time=time, seed=wind.seed)
                numbers, sheets = self._layouts[twin].packed(primitive, values), values.sheets
                check_values(self._twins[twin], numbers, sheets)
            except (Exception, SystemExit) as error:  # noqa: BLE001 - a plugin may raise anything
                self._reject(type(primitive), error)
                twin, numbers, sheets = NO_TWIN, (), ()
        after = self._winds[number + 1].primitive.priority if number + 1 < len(self._winds) else None
        ends = not weighs or after != primitive.priority
        share = 0.0 if twin == NO_TWIN else wind.strength * (primitive.weight if weighs else 1.0)
        self._put(number + 1, (*_frame_of(wind), share, primitive.swing, float(ends), float(twin)), numbers, sheets)
        return twin

    def _fit(self, numbers: Sequence[int]) -> list[int]:
        """Fit winds of these twins into the runs of programs, or change their order; return the row after each run."""
        if self._ready:
            order, ends = fit_runs(self._ready, numbers)
            self._order = order if order == self._ready else [ANY]
            return ends if order == self._ready else [len(numbers) + 1]
        self._order, ends = fit_few_runs(self._order, numbers)
        return ends

    def _reserve(self, rows: int, numbers: int) -> None:
        """Make room for this number of rows, and of numbers in each."""
        before = self._rows
        if rows > len(before) or numbers > before.shape[1]:
            self._rows = np.zeros((max(2 * rows, len(before)), -(-max(numbers, before.shape[1]) // 4) * 4), np.float32)
            self._rows[: len(before), : before.shape[1]] = before
            self._records.release()
            self._records = self._row_texture()

    def _put(self, row: int, head: tuple[float, ...], numbers: Sequence[float], sheets: Sequence[Floats]) -> None:
        """Write a row: the head, the layers of the sheets, and the numbers."""
        layers = self._sheets.layers(sheets) if sheets else []
        record = *head, *layers, *[0] * (4 - len(layers)), *numbers
        self._reserve(0, len(record))
        self._rows[row, : len(record)] = record

    def _send(self) -> None:
        """Upload the rows, if they have changed."""
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
        numbers: Callable[[], Indices] | None = None,
    ) -> None:
        """Compute and upload the messages of winds without a twin; where all winds have one, `receivers` is not called.

        `numbers` returns the receivers' numbers in `hear.glsl`, shape (n,); without it they count from 0. A wind that
        fails has no effect in this frame.
        """
        if not self._untwinned:
            return
        arrays, (time, mixing) = receivers(), self._asked
        number = np.arange(len(arrays.place)) if numbers is None else numbers()
        self._messages.reserve(len(self._untwinned), int(number.max(initial=0)) + 1)
        no_rows, unclaimed = np.zeros(0, np.intp), np.ones(len(arrays.place), np.float32)
        for count, row in enumerate(self._untwinned):
            sent = send(self._winds[row], arrays, unclaimed, quarantine, time, mixing)
            if sent is None:
                self._messages.write(count, no_rows, np.zeros((0, 2), np.float32), np.zeros(0, np.float32))
            else:
                self._messages.write(count, number[sent.rows], sent.message, sent.weight)
            self._rows[row + 1, SHARE], self._rows[row + 1, SHEET] = 1.0, count * self._messages.block
        for row, wind in enumerate(self._winds, 1):
            if wind.source in quarantine.reasons:  # messages of a wind that failed later are no messages
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
        """Return the program of two shader files with the twins of the current runs; compiled programs are kept.

        Its samplers, and the frame block if it has one, are bound to their units. Raises `ShaderError` as
        `engine.gl.shaders.program` does.
        """
        order = tuple(self._order)
        twin_count = len(self._twins) if ANY in order else 0
        key = vertex, fragment, tuple((defines or {}).items()), varyings, order, twin_count
        if key not in self._programs:
            twins = joined_twins(self._twins, order, self._layouts)
            self._programs[key] = self._compiled(vertex, fragment, defines, varyings, twins)
        return self._programs[key]

    def _compiled(
        self,
        vertex: str,
        fragment: str | None,
        defines: Mapping[str, str | int] | None,
        varyings: tuple[str, ...],
        twins: Mapping[str, Sequence[Line]],
    ) -> moderngl.Program:
        """Compile a program, and bind its samplers and the frame block."""
        made = program(self.ctx, vertex, fragment, defines=defines, varyings=varyings, made=twins)
        for name, unit in self._units.items():
            if name in made:
                made[name] = unit
        if "Frame" in made:
            made["Frame"].binding = block_binding(self.ctx)  # type: ignore[union-attr]
        return made

    def use(self) -> None:
        """Bind the winds' textures."""
        self._records.use(self._units["winds"])
        self._curves.use(self._units["wind_curves"])
        self._messages.texture.use(self._units["wind_messages"])
        self._sheets.texture.use(self._units["wind_sheets"])

    # ---- Twins -----------------------------------------------------------------------------------

    def _twin_of(self, wind: WindPrimitive, time: float, seed: int) -> int:
        """Return the number of the twin of a wind's class, `NO_TWIN` where numpy computes its messages.

        The first wind of a class determines the layout of the record, at a time [s] and with a seed.
        """
        kind = type(wind)
        if kind not in self._numbers:
            self._numbers[kind] = NO_TWIN
            try:
                twin = twin_of(kind)
                self._numbers[kind] = NO_TWIN if twin is None else self._admit(twin, wind, time, seed)
            except (Exception, SystemExit) as error:  # noqa: BLE001 - a plugin may raise anything
                self._reject(kind, error)
        return self._numbers[kind]

    def _admit(self, twin: Twin, wind: WindPrimitive, time: float, seed: int) -> int:
        """Return the number of a twin, a new one after a trial; raises ShaderError if it does not compile."""
        if twin not in self._twins:
            layout = layout_of(twin, wind, wind.twin_values(time=time, seed=seed))
            twins, layouts = [*self._twins, twin], [*self._layouts, layout]
            self._compiled(_TRIED, None, None, ("message",), joined_twins(twins, range(len(twins)), layouts)).release()
            self._twins, self._layouts = twins, layouts
        return self._twins.index(twin)

    def _reject(self, kind: type[WindPrimitive], error: Exception | SystemExit) -> None:
        """Use numpy instead of a twin from now on, and log the reason."""
        self._numbers[kind] = NO_TWIN
        log.debug("%s", kind.__name__, exc_info=error)
        reason = str(error) if isinstance(error, TwinError | ShaderError) else said(error)
        why = " ".join(reason.split())
        self.reasons[kind] = why
        log.warning("the twin of %s.%s cannot be used: %s; numpy does without it", kind.__module__, kind.__name__, why)

    def _row_texture(self) -> moderngl.Texture:
        """Return a new texture for the rows; nothing is in it yet."""
        self._sent = b""
        return by_texel(self.ctx.texture((self._rows.shape[1] // 4, len(self._rows)), 4, dtype="f4"))

    def release(self) -> None:
        """Release all textures and programs."""
        release_all(self._records, self._sheets, self._messages, self._curves, *self._programs.values())


def curve_texture(ctx: moderngl.Context, responses: Sequence[Response], /) -> moderngl.Texture:
    """Return the responses of kinds of grass, a row each: index after a wind starts, after it stops, and step [s]."""
    texels = np.zeros((len(responses), len(responses[0].rise), 3), np.float32)
    for row, response in zip(texels, responses, strict=True):
        row[:, 0], row[:, 1], row[:, 2] = response.rise, response.fall, response.step
    return by_texel(ctx.texture((texels.shape[1], len(texels)), 3, texels, dtype="f4"))


def _frame_of(wind: Blowing) -> tuple[float, ...]:
    """Return a wind's place, cosine and sine of its yaw, and its extent with a margin, outside of which masks are 0."""
    pose, held = wind.pose, wind.extent
    turned = pose.x, pose.z, cos(pose.yaw), sin(pose.yaw)
    if held is None:
        return *turned, -LARGEST, LARGEST, -LARGEST, LARGEST
    low, high = max(held.left, -LARGEST) - MARGIN, min(held.right, LARGEST) + MARGIN
    return *turned, low, high, max(held.ahead, -LARGEST) - MARGIN, min(held.behind, LARGEST) + MARGIN
