"""The light that shines now: what takes long to make of it comes bit by bit."""

from collections.abc import Iterator

from ...components.arrays import Doubles
from ...components.sun import Sun
from ...engine.declared.light import Light
from .daylight import LEAF, LUX, Daylight, daylight_under
from .sky import PIECES, clear_air, clear_air_in_pieces
from .sun import sun_at


class Shining:
    """The light of a prairie. What it is depends on what is asked for and on the frames since, and on nothing else.

    Sun, clouds, exposure and ground are at once as they are asked for. The colours of clear air take `PIECES` frames to
    be made out, and as many again to pass into what they were; if the sun moves on meanwhile, they follow. Before the
    first frame, and where nobody watches while it is drawn, so that it is not `live`, they come at once.
    """

    def __init__(self, light: Light, *, live: bool = True) -> None:
        self._live = live
        self.light = light
        """What shines by now, but for the colours of clear air."""
        self.leaps = 0
        """How often all of it has come at once, shadows too."""
        self._asked, self._since = light, 0.0
        self._viewers: set[str] = set()
        self._shown: Daylight | None
        self._clear: Doubles
        self._making: Iterator[Doubles | None] | None
        self._leap()

    @property
    def daylight(self) -> Daylight:
        """What it comes to: another object whenever it is another light."""
        if self._shown is None:
            self._shown = daylight_under(self.light, self._clear)
        return self._shown

    def sun_at(self, time: float, /) -> Sun:
        """Return what shines at a time [s]; the sky's colours are those of the last frame."""
        light = self.at(time)
        shines = self.daylight if light == self.light else daylight_under(light, self._clear)
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

    def resume(self, light: Light, /, *, since: float, time: float) -> None:
        """Let the light be what was asked for at another instant, all of it at once."""
        self.ask(light, time=since)
        self.light = self.at(time)
        self._leap()

    def step(self, viewer: str, /, *, time: float) -> None:
        """Come to a time [s] for a viewer: it is the next frame if that viewer has been drawn since the last one."""
        is_first, is_next = not self._viewers, viewer in self._viewers
        light = self.at(time)
        if light != self.light:
            self.light, self._shown = light, None
            if is_first or not self._live:
                self._leap()
        if is_next:
            self._viewers.clear()
            self._go_on()
        self._viewers.add(viewer)

    def _leap(self) -> None:
        """Let all of it be as it is asked for."""
        self.leaps += 1
        self._shown = self._making = None
        self._told = self._made = _air(self.light)
        self._clear = self._before = self._after = clear_air(*self._made)
        self._passed = PIECES

    def _go_on(self) -> None:
        """Make out another piece of clear air, and let what is shown pass on to what was made out."""
        if self._making is None and _air(self.light) != self._made:
            self._told = _air(self.light)
            self._making = clear_air_in_pieces(*self._told)
        if self._passed < PIECES:
            self._passed += 1
            part = self._passed / PIECES
            self._clear, self._shown = self._before * (1.0 - part) + self._after * part, None
        done = None if self._making is None else next(self._making)
        if done is not None:
            self._before, self._after, self._passed = self._clear, done, 0
            self._made, self._making = self._told, None


def _air(light: Light) -> tuple[float, float]:
    """Return what the colours of clear air follow from: the sun's elevation [degrees] and the turbidity."""
    return sun_at(light)[1], light.turbidity
