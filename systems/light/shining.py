"""The light that shines now: what takes long to make of it comes bit by bit."""

from collections.abc import Iterator
from typing import Annotated, NamedTuple

from pydantic import Field

from ...components.arrays import Doubles
from ...components.declaration import Declaration, Number
from ...components.sun import Sun
from ...engine.declared.light import Light
from .daylight import LEAF, LUX, Daylight, between, daylight, daylight_under
from .sky import PIECES, clear_air, clear_air_in_pieces
from .sun import sun_at, to_sun


class Stand(NamedTuple):
    """Where the sun stands, and in what air: what the colours of clear air follow from."""

    azimuth: Number
    elevation: Annotated[float, Field(ge=-90.0, le=90.0)]
    """Both [degrees]."""

    turbidity: Annotated[float, Field(ge=1.8, le=10.0)]


class Way(Declaration):
    """How far a light has come that is on its way to another, as a state keeps it."""

    before: Stand
    after: Stand
    passed: int = Field(ge=0, le=PIECES)
    """Frames since it left `before` for `after`, of `PIECES`."""

    making: Stand | None
    """What is being made out meanwhile, if anything."""

    made: int = Field(ge=0, lt=PIECES)
    """Pieces of it that are done."""

    viewers: list[str]
    """Who has been drawn since the last frame began."""


class Shining:
    """The light of a prairie. What it is depends on what is asked for and on the frames since, and on nothing else.

    Clouds, strengths and colours are at once as they are asked for. The sun waits for its air: while the colours of
    clear air are made out, for `PIECES` frames, all stays; as many frames long, sun, sky and exposure pass on to it
    together. If the sun moves on meanwhile, they follow. Before the first frame, and where nobody watches while it is
    drawn, so that it is not `live`, all comes at once.
    """

    def __init__(self, light: Light, *, live: bool = True) -> None:
        self._live = live
        self.leaps = 0
        """How often all of it has come at once, shadows too."""
        self._asked, self._since, self._due = light, 0.0, light
        self._viewers: set[str] = set()
        self._shown: Daylight | None
        self._ends: tuple[tuple[Light, Light], Daylight, Daylight] | None
        self._airs: tuple[Doubles, Doubles]
        self._making: Iterator[Doubles | None] | None
        self._leap()

    @property
    def daylight(self) -> Daylight:
        """What it comes to: another object whenever it is another light."""
        if self._shown is None:
            self._shown = self._under(self._due)
        return self._shown

    @property
    def light(self) -> Light:
        """What shines by now: what is asked for, with the sun where it has come to."""
        return _on(self._due, self._stand)

    def sun_at(self, time: float, /) -> Sun:
        """Return what shines at a time [s]: where the sun is on its way, it stands as in the last frame."""
        light = self.at(time)
        if light != self._due and self._leaps_next:
            shines = daylight(light)
        else:
            shines = self.daylight if light == self._due else self._under(light)
        (red, green, blue), sky = (shines.sun / LEAF).tolist(), shines.down.tolist()
        return Sun(shines.direction, (red, green, blue), (sky[0], sky[1], sky[2]), LUX * shines.lamplight)

    def told_at(self, time: float, /) -> Light:
        """Return what is asked for at a time [s], with the sun where it stands, also where it follows from an hour."""
        light = self.at(time)
        if light.hour is None:
            return light
        azimuth, elevation = sun_at(light)
        return light.model_copy(update={"azimuth": azimuth, "elevation": elevation})

    def at(self, time: float, /) -> Light:
        """Return what is asked for at a time [s]."""
        asked, passed = self._asked, time - self._since
        if not asked.hours_per_minute or asked.hour is None or not passed:
            return asked
        return asked.model_copy(update={"hour": (asked.hour + asked.hours_per_minute / 60.0 * passed) % 24.0})

    def ask(self, light: Light, /, *, time: float) -> None:
        """Let the light be another from the next frame on; its `hour` is that of `time` [s]."""
        self._asked, self._since = light, time

    def declare(self, light: Light, /, *, time: float) -> None:
        """Let the light be what a scene says that was read again, all of it at once; its `hour` is that of time 0."""
        self.resume(light, since=0.0, time=time)

    @property
    def asked(self) -> tuple[Light, float]:
        """What is asked for, and the instant that its hour is that of [s]."""
        return self._asked, self._since

    @property
    def way(self) -> Way:
        """How far it has come."""
        before = self._before if self._passed < PIECES else self._after
        making = None if self._making is None else self._told
        return Way(
            before=before, after=self._after, passed=self._passed, making=making, made=self._made,
            viewers=sorted(self._viewers),
        )  # fmt: skip

    def resume(self, light: Light, /, *, since: float, time: float, way: Way | None = None) -> None:
        """Let the light be what was asked for at another instant, as far as it has come; without a `way` all of it."""
        self.ask(light, time=since)
        self._due = self.at(time)
        self._leap()
        if way is None:
            return
        self._viewers = set(way.viewers)
        if self._leaps_next:
            return
        self._before, self._after, self._passed = way.before, way.after, way.passed
        self._airs = clear_air(*way.before[1:]), clear_air(*way.after[1:])
        self._ends = self._shown = None
        if way.making is not None:
            self._make(way.making)
            for _ in range(way.made):
                self._make_on()

    def step(self, viewer: str, /, *, time: float) -> None:
        """Come to a time [s] for a viewer: it is the next frame if that viewer has been drawn since the last one."""
        is_next, light, leaps = viewer in self._viewers, self.at(time), self._leaps_next
        if light != self._due:
            self._due, self._shown = light, None
            if leaps:
                self._leap()
        if is_next:
            self._viewers.clear()
            self._go_on()
        self._viewers.add(viewer)

    @property
    def _leaps_next(self) -> bool:
        return not (self._viewers and self._live)

    def _leap(self) -> None:
        """Let all of it be as it is asked for."""
        self.leaps += 1
        self._making, self._made = None, 0
        self._told = self._before = self._after = _stand(self._due)
        self._airs = (clear_air(*self._after[1:]),) * 2
        self._passed = PIECES
        self._ends = self._shown = None

    def _go_on(self) -> None:
        """Make out another piece of clear air, and let what is shown pass on to what was made out."""
        due = _stand(self._due)
        if self._making is None and due != self._after:
            self._make(due)
        if self._passed < PIECES:
            self._passed, self._shown = self._passed + 1, None
        if self._making is not None:
            self._make_on()

    def _make(self, due: Stand) -> None:
        self._told, self._making, self._made = due, clear_air_in_pieces(*due[1:]), 0

    def _make_on(self) -> None:
        assert self._making is not None
        done = next(self._making)
        self._made += 1
        if done is not None:
            self._before, self._after, self._passed = self._after, self._told, 0
            self._airs = self._airs[1], done
            self._making, self._made, self._ends = None, 0, None

    @property
    def _stand(self) -> Stand:
        """Where the sun has come to."""
        return _between(self._before, self._after, self._passed / PIECES)

    def _under(self, light: Light) -> Daylight:
        """Return what a light comes to with the sun where it is."""
        if self._passed == PIECES:
            return daylight_under(_on(light, self._after), self._airs[1])
        lights = _on(light, self._before), _on(light, self._after)
        if self._ends is None or self._ends[0] != lights:
            before, after = map(daylight_under, lights, self._airs)
            self._ends = lights, before, after
        _, before, after = self._ends
        return between(before, after, self._passed / PIECES, to_sun(_on(light, self._stand)))


def _stand(light: Light) -> Stand:
    return Stand(*sun_at(light), light.turbidity)


def _on(light: Light, stand: Stand) -> Light:
    """Return a light with the sun, and the haze before it, elsewhere."""
    return light.model_copy(update={"hour": None, **stand._asdict()})


def _between(before: Stand, after: Stand, part: float) -> Stand:
    """Return what lies a part of the way from one to another, on the shorter way round."""
    if part >= 1.0:
        return after
    turn = (after.azimuth - before.azimuth + 180.0) % 360.0 - 180.0
    lift, thicker = after.elevation - before.elevation, after.turbidity - before.turbidity
    return Stand(before.azimuth + part * turn, before.elevation + part * lift, before.turbidity + part * thicker)
