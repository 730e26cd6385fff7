"""Wind primitives: the base class of all winds, built-in ones and those of plugins alike."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from reprlib import repr as shortened
from typing import ClassVar, Literal, Self, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, PrivateAttr, model_validator

from .arrays import Floats
from .body import Hover
from .course import Course
from .declaration import Declaration, DeclarationError
from .immutable import immutable
from .pose import HERE, Pose
from .presser import Presser
from .words import Plain

INTERFACE = 1
"""Version of the interface between winds and tallgrass; it changes when winds written for it would break."""

LATEST = 1e8
"""Latest start or end of a wind [s]: three years, as a game that runs on may start one at any time."""

Mixing = Literal["priority", "weight"]
"""Rule for winds that meet at a place: the highest priority cancels the others, or they are mixed by weight."""


@immutable
@dataclass(frozen=True, slots=True)
class Extent:
    """A rectangle in a wind's own frame, outside of which its mask is 0."""

    left: float
    """Least x [m]."""

    right: float
    """Largest x [m]."""

    ahead: float
    """Least z [m]."""

    behind: float
    """Largest z [m]."""


@immutable
@dataclass(frozen=True, slots=True, eq=False)
class Grass:
    """The response of the grass at some receivers to wind over time (paper, section 3.3, figure 8).

    A wind may use it to bend different kinds differently.
    """

    kind: NDArray[np.intp]
    """Row of the curves for each receiver, shape (n,)."""

    step: Floats
    """Time between a curve's samples [s], shape (kinds,)."""

    rise: Floats
    """Posture index after a constant wind starts, as a fraction of the final index, shape (kinds, samples)."""

    fall: Floats
    """Posture index after a constant wind stops, as a fraction of the index before, shape (kinds, samples)."""

    def after_start(self, elapsed: Floats, /) -> Floats:
        """Return the index `elapsed` [s] (n,) after a constant wind started: 0 before, past 1 and back to 1, (n,)."""
        return self._read(self.rise, elapsed)

    def after_stop(self, elapsed: Floats, /) -> Floats:
        """Return the index `elapsed` [s] (n,) after a constant wind stopped: 1 before, past 0 and back to 0, (n,)."""
        return self._read(self.fall, elapsed)

    def at(self, rows: NDArray[np.intp], /) -> "Grass":
        """Return the grass at the receivers of these numbers, shape (m,)."""
        return Grass(self.kind[rows], self.step, self.rise, self.fall)

    def _read(self, curves: Floats, elapsed: Floats) -> Floats:
        samples = curves.shape[1]
        at = np.clip(elapsed / self.step[self.kind], 0.0, samples - 1.001).astype(np.float32)
        low = at.astype(np.intp)
        flat = curves.reshape(-1)
        before, after = flat[self.kind * samples + low], flat[self.kind * samples + low + 1]
        return np.asarray(before + (after - before) * (at - low.astype(np.float32)), np.float32)


@immutable
@dataclass(frozen=True, slots=True, eq=False)
class TwinValues:
    """Values for a wind's twin on the graphics card at one time, in addition to the wind's fields; single precision."""

    numbers: Mapping[str, float | Sequence[float]] = field(default_factory=dict)
    """Fields of the twin's record by name, each one to four numbers; phases are best reduced to one turn here.

    A twin may read 64 numbers at most.
    """

    sheets: Sequence[Floats] = ()
    """Tables that the twin reads by `sheet(wind, 0, at)` and so on, four at most: shape (rows, columns, 1 to 4).

    The same array as before counts as unchanged and is not uploaded again.
    """


class WindPrimitive(Declaration, metaclass=Plain):
    """A wind as an object on the prairie (paper, section 3.3): a mask on the ground and an action inside it.

    A primitive has no state: all its methods are pure functions of places and a time, so that any machine computes the
    same wind at any time, in any order, for any subset of the receivers.
    """

    interface: ClassVar[int] = INTERFACE
    """Version of this interface that the class is written for."""

    twin: ClassVar[str | None] = None
    """Name of a GLSL file next to the class's module that computes `mask` and `action` too; without one, numpy does.

    It is also used by derived classes that override neither method.
    """

    color: ClassVar[tuple[float, float, float] | None] = None
    """Display colour of the kind in the overlay, each channel in [0, 1]; without it, a hue from the kind's name."""

    kind: str = Field(min_length=1)
    """Name of the primitive, as its plugin registers it."""

    priority: int = Field(default=0, ge=-1000, le=1000)
    """The highest priority at a place cancels the others (paper, section 3.3)."""

    weight: float = Field(default=1.0, ge=0.0, le=1.0)
    """Weight where the scene mixes winds by weight; 1 covers winds of lower priority."""

    start: float = Field(default=0.0, ge=0.0, le=LATEST)
    """Time at which it begins [s]."""

    stop: float | None = Field(default=None, ge=0.0, le=LATEST)
    """Time at which it ends [s]; without it, never."""

    ease: float = Field(default=0.0, ge=0.0, le=60.0)
    """Time to set in and to die down [s]; a wind that starts at 0 is there from the beginning."""

    swing: float = Field(default=0.12, ge=0.0, le=0.5)
    """Largest posture index of a blade's own small oscillations in it, of random direction."""

    _run: tuple[Course, "WindPrimitive"] | None = PrivateAttr(None)
    """Course of its phases, and the wind before a game first changed their rates; set by `on_course`."""

    @model_validator(mode="after")
    def _stop_after_start(self) -> Self:
        if self.stop is not None and self.stop <= self.start:
            raise DeclarationError(f"stop must be later than start, which is {self.start:g} s", "stop")
        return self

    @model_validator(mode="after")
    def _says_its_kind(self) -> Self:
        self.__pydantic_fields_set__.add("kind")  # a file has to say it, so `exclude_unset` keeps it
        return self

    def rates(self) -> Sequence[float]:
        """Return the rates of its phases [1/s], for all that would be a rate times the time.

        A wind that travels, turns or beats has a phase for it, and reads it from `phases`, so that it stays continuous
        when a game changes the speed. The number of phases is the same at any time.
        """
        return ()

    def phases(self, *, time: float, since: float = 0.0) -> tuple[float, ...]:
        """Return the advance of each of its phases from `since` to `time` [s]: the integral of its rate.

        That is the rate times the time, unless a game has changed the rate of the wind on its entity.
        """
        if self.course is not None:
            return self.course.phases(time, since=since)
        return tuple(rate * (time - since) for rate in self.rates())

    @property
    def course(self) -> Course | None:
        """Course of its phases where a game has changed their rates; None for most winds."""
        run = self._ran
        return run and run[0]

    @property
    def first(self) -> Self:
        """The wind as it was before a game first changed the rates of its phases; for most winds itself."""
        run = self._ran
        return cast(Self, run[1]) if run else self

    @property
    def _ran(self) -> tuple[Course, "WindPrimitive"] | None:
        """Value of `_run`, ten times as fast as pydantic's access to a private attribute: phases are read often."""
        private = self.__pydantic_private__
        return private["_run"] if private else None

    def ends(self) -> float:
        """Return the time from which it is over for good [s]; `inf` is never. A wind that is over costs nothing."""
        return inf if self.stop is None else self.stop

    def parts(self, *, time: float, seed: int) -> Sequence["WindPrimitive"]:
        """Return the winds of which it consists at `time` [s]; by default itself alone.

        Randomness comes from `seed`, which is the wind's own.
        """
        return (self,)

    def pose(self, *, time: float) -> Pose:
        """Return the pose of its own frame at `time` [s]; by default, the world's.

        `mask` and `action` get places in this frame.
        """
        return HERE

    def hover(self) -> Hover | None:
        """Return the body that hovers over it and from which it comes, as a jet from a saucer; None for no body.

        The body flies along `pose` and leans into its turns, and the wind's frame is where its jet then meets the
        ground. If the wind's entity has a `Pose`, the frame is there, and the body flies over it.
        """
        return None

    def extent(self, *, time: float) -> Extent | None:
        """Return the rectangle of its frame outside of which its mask is 0 at `time` [s]; None for no limit.

        Only patches that overlap the rectangle cost anything.
        """
        return None

    @abstractmethod
    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return its weights in [0, 1], shape (n,), at positions (x, z) in its frame [m], shape (n, 2).

        If winds are mixed by priority, it acts wherever the weight is above 0.
        """

    @abstractmethod
    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return the messages to receivers at positions (x, z) in its frame [m], both of shape (n, 2).

        A message is a vector of the frame along the bending direction. Its norm, in [0, 1], is the posture index of
        grass of stiffness 1; other kinds bend more or less. `seed` is the wind's own; `grass` has the response of the
        grass there.
        """

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        """Return the values that the twin reads at `time` [s]; `seed` is the wind's own, as for `action`."""
        return TwinValues()


def on_course(wind: WindPrimitive, before: WindPrimitive, /, *, time: float) -> WindPrimitive:
    """Return a wind that replaces one of the same class and continues its phases from `time` [s] on.

    If the rates never changed, it is the wind itself.
    """
    rates, held, course = tuple(wind.rates()), tuple(before.rates()), before.course
    if course is None and rates == held:
        return wind
    course = course or Course.of(held)
    run = course if rates == course.rates[-1] else course.changed(rates, time=time)
    return with_course(wind, run, before.first)


def with_course(wind: WindPrimitive, course: Course, first: WindPrimitive, /) -> WindPrimitive:
    """Return a wind with a course of its phases; `first` is the wind before a game first changed their rates."""
    made = wind.model_copy()
    made._run = course, first  # noqa: SLF001
    return made


@immutable
@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class WindSource:
    """The component of a wind entity; the primitive is a field, so that any plugin's type is found."""

    primitive: WindPrimitive
    """The primitive itself."""

    name: str
    """Its name in messages: its kind and its place in the scene."""

    def __post_init__(self) -> None:
        """Raise TypeError for anything but a wind and a text."""
        must_be_wind(self.primitive, "a WindSource carries")
        must_be_name(self.name)


def must_be_wind(thing: object, due: str, /) -> None:
    """Raise TypeError for anything but a wind; `due` begins the message."""
    if isinstance(thing, Presser):
        raise TypeError(f"{due} a wind, and a Presser goes with a Pose: esper.create_entity(presser, Pose(x, z))")
    if not isinstance(thing, WindPrimitive):
        said = "its name " if isinstance(thing, str) else "the class " if isinstance(thing, type) else ""
        what = thing.__name__ if isinstance(thing, type) else shortened(thing)
        raise TypeError(f"{due} a wind such as Gust(), not {said}{what}")


def must_be_name(thing: object, /) -> None:
    """Raise TypeError for a wind's name that is no text, ValueError for one that no saved game can hold."""
    if not isinstance(thing, str):
        raise TypeError(f"a wind's name is a text such as 'north', not {shortened(thing)}")
    if not thing.isascii() and thing != thing.encode(errors="replace").decode():
        raise ValueError(f"a wind's name is Unicode, not {shortened(thing)}")
