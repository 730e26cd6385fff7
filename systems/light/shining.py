"""The light as it is shown: changes that need a new sky map appear gradually."""

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
    """The sun's direction, and the turbidity of the air: both determine the colours of a clear sky."""

    azimuth: Number
    """[degrees]"""

    elevation: Annotated[float, Field(ge=-90.0, le=90.0)]
    """[degrees]"""

    turbidity: Annotated[float, Field(ge=1.8, le=10.0)]


class Way(Declaration):
    """Progress of the transition from one light to another, as saved states keep it."""

    before: Stand
    after: Stand
    passed: int = Field(ge=0, le=PIECES)
    """Frames since the transition from `before` to `after` began, out of `PIECES`."""

    making: Stand | None
    """Stand whose clear sky is being computed for the transition after this one, if any."""

    made: int = Field(ge=0, lt=PIECES)
    """Number of computed pieces of that sky."""

    viewers: list[str]
    """Names of the viewers drawn since the present frame began."""


class Shining:
    """The light of a prairie. It depends only on the light asked for and on the number of frames since.

    Clouds, strengths and colours change at once. A moved sun takes effect in two steps: for `PIECES` frames the new
    clear sky is computed while the picture stays, then sun, sky and exposure are interpolated over as many frames. If
    the sun moves again meanwhile, another transition follows. Before the first frame, and without `live`, where nobody
    watches the drawing, everything changes at once.
    """

    def __init__(self, light: Light, *, live: bool = True) -> None:
        self._live = live
        self.leaps = 0
        """Number of times that everything has changed at once, shadows too."""
        self._asked, self._since, self._asked_now = light, 0.0, light
        self._viewers: set[str] = set()
        self._daylight: Daylight | None
        self._interpolation_ends: tuple[tuple[Light, Light], Daylight, Daylight] | None
        self._clear_skies: tuple[Doubles, Doubles]
        self._sky_pieces: Iterator[Doubles | None] | None
        self._leap()

    @property
    def daylight(self) -> Daylight:
        """The present light as radiance; a new object whenever it has changed."""
        if self._daylight is None:
            self._daylight = self._daylight_of(self._asked_now)
        return self._daylight

    @property
    def light(self) -> Light:
        """The light asked for, with the sun where its transition has come to."""
        return _with_stand(self._asked_now, self._stand)

    def sun_at(self, time: float, /) -> Sun:
        """Return sun and sky at a time [s]. During a transition the sun stands as in the last frame."""
        light = self.at(time)
        if light != self._asked_now and self._leaps_next:
            shines = daylight(light)
        else:
            shines = self.daylight if light == self._asked_now else self._daylight_of(light)
        (red, green, blue), sky = (shines.sun / LEAF).tolist(), shines.down.tolist()
        return Sun(shines.direction, (red, green, blue), (sky[0], sky[1], sky[2]), LUX * shines.lamplight)

    def resolved_at(self, time: float, /) -> Light:
        """Return the light asked for at a time [s], with azimuth and elevation worked out where there is an hour."""
        light = self.at(time)
        if light.hour is None:
            return light
        azimuth, elevation = sun_at(light)
        return light.model_copy(update={"azimuth": azimuth, "elevation": elevation})

    def at(self, time: float, /) -> Light:
        """Return the light asked for at a time [s], with the hour of that time."""
        asked, passed = self._asked, time - self._since
        if not asked.hours_per_minute or asked.hour is None or not passed:
            return asked
        return asked.model_copy(update={"hour": (asked.hour + asked.hours_per_minute / 60.0 * passed) % 24.0})

    def ask(self, light: Light, /, *, time: float) -> None:
        """Ask for another light from the next frame on; `time` [s] is when it has its `hour`."""
        self._asked, self._since = light, time

    def declare(self, light: Light, /, *, time: float) -> None:
        """Change at once to the light of a scene that was read again; it has its `hour` at time 0."""
        self.resume(light, since=0.0, time=time)

    @property
    def asked(self) -> tuple[Light, float]:
        """The light asked for, and the time at which it has its `hour` [s]."""
        return self._asked, self._since

    @property
    def way(self) -> Way:
        """Progress of the transition."""
        before = self._before if self._passed < PIECES else self._after
        making = None if self._sky_pieces is None else self._next_stand
        return Way(
            before=before, after=self._after, passed=self._passed, making=making, made=self._pieces_done,
            viewers=sorted(self._viewers),
        )  # fmt: skip

    def resume(self, light: Light, /, *, since: float, time: float, way: Way | None = None) -> None:
        """Restore a light asked for at time `since` [s], and its transition; without a `way` it is over."""
        self.ask(light, time=since)
        self._asked_now = self.at(time)
        self._leap()
        if way is None:
            return
        self._viewers = set(way.viewers)
        if self._leaps_next:
            return
        self._before, self._after, self._passed = way.before, way.after, way.passed
        self._clear_skies = clear_air(*way.before[1:]), clear_air(*way.after[1:])
        self._interpolation_ends = self._daylight = None
        if way.making is not None:
            self._begin_sky(way.making)
            for _ in range(way.made):
                self._compute_piece()

    def step(self, viewer: str, /, *, time: float) -> None:
        """Advance to a time [s] for a viewer. A new frame begins when the viewer has been drawn in the present one."""
        is_next, light, leaps = viewer in self._viewers, self.at(time), self._leaps_next
        if light != self._asked_now:
            self._asked_now, self._daylight = light, None
            if leaps:
                self._leap()
        if is_next:
            self._viewers.clear()
            self._advance()
        self._viewers.add(viewer)

    @property
    def _leaps_next(self) -> bool:
        """Whether the next change takes effect at once."""
        return not (self._viewers and self._live)

    def _leap(self) -> None:
        """Change everything to the light asked for at once."""
        self.leaps += 1
        self._sky_pieces, self._pieces_done = None, 0
        self._next_stand = self._before = self._after = _stand_of(self._asked_now)
        self._clear_skies = (clear_air(*self._after[1:]),) * 2
        self._passed = PIECES
        self._interpolation_ends = self._daylight = None

    def _advance(self) -> None:
        """Compute another piece of the next clear sky, and advance the transition by a frame."""
        stand = _stand_of(self._asked_now)
        if self._sky_pieces is None and stand != self._after:
            self._begin_sky(stand)
        if self._passed < PIECES:
            self._passed, self._daylight = self._passed + 1, None
        if self._sky_pieces is not None:
            self._compute_piece()

    def _begin_sky(self, stand: Stand) -> None:
        """Begin to compute the clear sky of a stand."""
        self._next_stand, self._sky_pieces, self._pieces_done = stand, clear_air_in_pieces(*stand[1:]), 0

    def _compute_piece(self) -> None:
        """Compute another piece; after the last, begin the transition."""
        assert self._sky_pieces is not None
        done = next(self._sky_pieces)
        self._pieces_done += 1
        if done is not None:
            self._before, self._after, self._passed = self._after, self._next_stand, 0
            self._clear_skies = self._clear_skies[1], done
            self._sky_pieces, self._pieces_done, self._interpolation_ends = None, 0, None

    @property
    def _stand(self) -> Stand:
        """The sun's interpolated stand."""
        return _interpolated(self._before, self._after, self._passed / PIECES)

    def _daylight_of(self, light: Light) -> Daylight:
        """Return the radiance of a light at the present point of the transition."""
        if self._passed == PIECES:
            return daylight_under(_with_stand(light, self._after), self._clear_skies[1])
        lights = _with_stand(light, self._before), _with_stand(light, self._after)
        if self._interpolation_ends is None or self._interpolation_ends[0] != lights:
            before, after = map(daylight_under, lights, self._clear_skies)
            self._interpolation_ends = lights, before, after
        _, before, after = self._interpolation_ends
        return between(before, after, self._passed / PIECES, to_sun(_with_stand(light, self._stand)))


def _stand_of(light: Light) -> Stand:
    """Return the stand of a light."""
    return Stand(*sun_at(light), light.turbidity)


def _with_stand(light: Light, stand: Stand) -> Light:
    """Return a light with the sun's direction and the turbidity of a stand."""
    return light.model_copy(update={"hour": None, **stand._asdict()})


def _interpolated(before: Stand, after: Stand, part: float) -> Stand:
    """Interpolate two stands, the azimuth on the shorter way round."""
    if part >= 1.0:
        return after
    turn = (after.azimuth - before.azimuth + 180.0) % 360.0 - 180.0
    lift, thicker = after.elevation - before.elevation, after.turbidity - before.turbidity
    return Stand(before.azimuth + part * turn, before.elevation + part * lift, before.turbidity + part * thicker)
