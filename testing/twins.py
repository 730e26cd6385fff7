"""Comparing a wind's twin on the graphics card with its numpy."""

from collections.abc import Sequence
from typing import Any

import moderngl
import numpy as np

from ..components.arrays import Floats
from ..components.pose import HERE
from ..components.wind import Grass, Mixing, WindPrimitive, WindSource
from ..engine.gl.stream import release_all
from ..engine.gl.units import FIRST_UNIT
from ..systems.grow.record import Response
from ..systems.wind.blow import Blowing, ReceiverArrays, hear, lone_receivers
from ..systems.wind.card import SAMPLERS, CardWinds
from ..systems.wind.quarantine import Quarantine
from ..systems.wind.twin import TwinError, twin_of
from .trial import crowd, grass_at
from .winds import timeline

CLOSE_TWIN = 1e-3
"""Greatest difference of a twin's message from numpy's."""

_CROWD = 2000


def twin_problems(
    primitive: WindPrimitive | type[WindPrimitive], ctx: moderngl.Context, /, *, seed: int = 0
) -> list[str]:
    """Return the problems of the twin of a wind, or of a class's defaults, one sentence each.

    The twin is compiled, and its messages are compared with `mask` and `action` at times along the wind's timeline, at
    random places of the extent, by both mixings. A wind without a twin has no problem. A framebuffer must be bound in
    `ctx`. `seed` is the wind's own.
    """
    made: Any = primitive
    wind: WindPrimitive = made() if isinstance(primitive, type) else made
    try:
        if twin_of(type(wind)) is None:
            return []
    except TwinError as error:
        return [f"its twin cannot be used: {error}"]
    ear = CardEar(ctx, grass_at(np.zeros((1, 2), np.float32)))
    try:
        return _differences(ear, wind, seed)
    finally:
        ear.release()


def _differences(ear: "CardEar", wind: WindPrimitive, seed: int) -> list[str]:
    source, worst = WindSource(wind, wind.kind), (CLOSE_TWIN, "")
    for time in timeline(wind):
        for part in wind.parts(time=time, seed=seed):
            extent = part.extent(time=time)
            place = crowd(extent, _CROWD)
            receivers, now = lone_receivers(place, grass_at(place)), [Blowing(source, part, HERE, extent, seed, 1.0)]
            for mixing in ("priority", "weight"):
                due = hear(now, receivers, Quarantine(), time=time, seed=seed, mixing=mixing)
                found = ear.hear(now, receivers, Quarantine(), time=time, seed=seed, mixing=mixing)
                if ear.card.reasons:
                    return [f"its twin cannot be used: {why}" for why in ear.card.reasons.values()]
                apart = np.abs(found - due).max(axis=1)
                (x, z), most = place[apart.argmax()].tolist(), float(apart.max())
                worst = max(worst, (most, f"by {most:.2g} at ({x:g}, {z:g}) (at {time:g} s)"))
    return [f"its twin differs from mask and action {worst[1]}, over {CLOSE_TWIN:g}"] if worst[1] else []


class CardEar:
    """Receivers at any places that hear winds on the graphics card; a framebuffer must be bound in its context."""

    def __init__(self, ctx: moderngl.Context, grass: Grass) -> None:
        units = {name: unit for unit, name in enumerate(SAMPLERS, FIRST_UNIT)}
        curves = zip(grass.step.tolist(), grass.rise, grass.fall, strict=True)
        self.ctx = ctx
        self.card = CardWinds(ctx, units, [Response(*curve) for curve in curves])

    def hear(
        self,
        winds: Sequence[Blowing],
        receivers: ReceiverArrays,
        quarantine: Quarantine,
        /,
        *,
        time: float,
        seed: int,
        mixing: Mixing,
    ) -> Floats:
        """Return the mixed message of each receiver, shape (n, 2), as `systems.wind.blow.hear` does."""
        self.card.write(winds, time=time, seed=seed, mixing=mixing)
        self.card.tell(lambda: receivers, quarantine)
        count = len(receivers.place)
        still = np.arange(count) >= count - receivers.still
        each = [*receivers.place.T, receivers.grass.kind, still, np.arange(count)]
        made = self.card.program("systems/wind/hear.vert", None, varyings=("message",))
        self.card.use()
        names = {"place": "2f", "grass": "1f", "still": "1f", "receiver": "1f"}
        form = " ".join(part if name in made else f"{4 * int(part[0])}x" for name, part in names.items())
        source = self.ctx.buffer(np.stack(each, axis=1).astype(np.float32))
        result = self.ctx.buffer(reserve=8 * count)
        read = [name for name in names if name in made]  # empty where nothing blows
        array = self.ctx.vertex_array(made, [(source, form, *read)] if read else [])
        array.transform(result, moderngl.POINTS, vertices=count)
        message = np.frombuffer(result.read(), np.float32).reshape(count, 2)
        release_all(array, source, result)
        return message

    def release(self) -> None:
        """Delete its GL objects."""
        self.card.release()
