"""Wind primitives: what every kind of wind is, the built-in ones and a stranger's alike."""

from abc import abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import inf
from reprlib import repr as shortened
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self, cast

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, Field, PrivateAttr, ValidationError, model_validator

from .arrays import Floats
from .body import Hover
from .course import Course
from .declaration import Declaration, DeclarationError
from .pose import HERE, Pose
from .presser import Presser
from .words import told

INTERFACE = 1
"""Version of what winds and tallgrass ask of each other; it changes when winds written for it would break."""

LATEST = 1e8
"""Latest that a wind may begin or end [s]: three years on, as a game that runs on may set one off at any time."""

Mixing = Literal["priority", "weight"]
"""How winds meet at a place: the highest priority cancels the others, or they are mixed by weight."""


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


@dataclass(frozen=True, slots=True, eq=False)
class Grass:
    """How the grass at some receivers answers the wind over time (paper, section 3.3, figure 8).

    What a wind does with it is its own affair: that is how one wind bends different kinds differently.
    """

    kind: NDArray[np.intp]
    """Row of the curves for each receiver, shape (n,)."""

    step: Floats
    """Time between a curve's samples [s], shape (kinds,)."""

    rise: Floats
    """Index after a constant wind starts, as a part of its final index, shape (kinds, samples)."""

    fall: Floats
    """Index after it stops, shape (kinds, samples)."""

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


@dataclass(frozen=True, slots=True, eq=False)
class TwinValues:
    """What a wind's twin on the graphics card reads at one instant, in single precision, beside the wind's fields."""

    numbers: Mapping[str, float | Sequence[float]] | Sequence[float] = ()
    """What its record has by these names, a number or two to four; phases are best reduced to one turn here.

    A twin may read 64 numbers at most. Without names they are what `value(wind, 0)` and so on are.
    """

    sheets: Sequence[Floats] = ()
    """What `sheet(wind, 0, at)` and so on read, four at most: shape (rows, columns, 1 to 4).

    One that is the same array as before counts as unchanged and is not sent again.
    """


if TYPE_CHECKING:  # what makes instances must not hide their fields from type checkers
    from pydantic._internal._model_construction import ModelMetaclass as _Making
else:

    class _Making(type(BaseModel)):
        """Lets a class say in a plain sentence what is wrong with the values that a program makes an instance of."""

        def __call__(cls, *args: Any, **values: Any) -> Any:
            try:
                return super().__call__(*args, **values)
            except ValidationError as error:
                raise ValueError(f"{cls.__name__}: {told(error, cls, cls.__name__)}") from None


class WindPrimitive(Declaration, metaclass=_Making):
    """A wind as an object on the prairie (paper, section 3.3): a mask on the ground and an action inside it.

    A primitive keeps nothing between calls: all its methods are pure functions of places and a time, so that any
    machine computes the same wind at any time, in any order, for any part of the receivers.
    """

    interface: ClassVar[int] = INTERFACE
    """Version of this interface that the class is written for."""

    twin: ClassVar[str | None] = None
    """A GLSL file beside the class's module that computes `mask` and `action` too; without one, numpy alone does.

    It holds for derived classes as long as they leave both methods as they are.
    """

    color: ClassVar[tuple[float, float, float] | None] = None
    """What the overlay shows the kind in: a display colour, each in [0, 1]; without it, a hue from the kind's name."""

    kind: str = Field(min_length=1)
    """Name of the primitive, as its plugin registers it."""

    priority: int = Field(default=0, ge=-1000, le=1000)
    """The highest priority at a place cancels the others (paper, section 3.3)."""

    weight: float = Field(default=1.0, ge=0.0, le=1.0)
    """How much it counts where the scene mixes winds by weight; 1 covers winds of lower priority."""

    start: float = Field(default=0.0, ge=0.0, le=LATEST)
    """When it begins [s]."""

    stop: float | None = Field(default=None, ge=0.0, le=LATEST)
    """When it ends [s]; without it, never."""

    ease: float = Field(default=0.0, ge=0.0, le=60.0)
    """Time to set in and to die down [s]; a wind that starts at 0 is there from the beginning."""

    swing: float = Field(default=0.12, ge=0.0, le=0.5)
    """Largest posture index of a blade's own small oscillations in it, of random direction."""

    _run: tuple[Course, "WindPrimitive"] | None = PrivateAttr(None)
    """How its phases have run, and the same wind before, where a game has changed their rates; from `on_course`."""

    @model_validator(mode="after")
    def _stop_after_start(self) -> Self:
        if self.stop is not None and self.stop <= self.start:
            raise DeclarationError(f"stop must be later than start, which is {self.start:g} s", "stop")
        return self

    def rates(self) -> Sequence[float]:
        """Return how fast its phases run [1/s]: all that would be such a rate times the time.

        What travels, turns or beats has a phase, and reads it from `phases`: so it goes on from where it is when a game
        changes the speed. A wind has as many phases at any time.
        """
        return ()

    def phases(self, *, time: float, since: float = 0.0) -> tuple[float, ...]:
        """Return how far each of its phases has come from `since` to `time` [s]: its rate, integrated.

        That is the rate times the time as long as nobody changes it; of a wind that a game has changed on its entity,
        each rate counts for as long as it held.
        """
        if self.course is not None:
            return self.course.phases(time, since=since)
        return tuple(rate * (time - since) for rate in self.rates())

    @property
    def course(self) -> Course | None:
        """How its phases have run where a game has changed how fast they do; None for most winds."""
        run = self._ran
        return run and run[0]

    @property
    def first(self) -> Self:
        """The same wind as it was before a game first changed how fast its phases run; for most winds itself."""
        run = self._ran
        return cast(Self, run[1]) if run else self

    @property
    def _ran(self) -> tuple[Course, "WindPrimitive"] | None:
        """What `_run` is: pydantic looks for a private attribute ten times as long, and phases are asked for often."""
        private = self.__pydantic_private__
        return private["_run"] if private else None

    def ends(self) -> float:
        """Return when it is over for good [s]; `inf` is never. A wind that is over costs nothing."""
        return inf if self.stop is None else self.stop

    def parts(self, *, time: float, seed: int) -> Sequence["WindPrimitive"]:  # noqa: ARG002 - for those that repeat
        """Return the winds it is made of at `time` [s]: itself, unless it says otherwise.

        What is random about that comes from `seed`, which is the wind's own.
        """
        return (self,)

    def pose(self, *, time: float) -> Pose:  # noqa: ARG002 - for those that move
        """Return where its own frame is at `time` [s]; without more, it is the world's.

        `mask` and `action` are asked in this frame.
        """
        return HERE

    def hover(self) -> Hover | None:
        """Return the thing that hovers over it and that it comes from, as a jet from a saucer; None is nothing.

        The thing flies along `pose` and leans as its flight asks for, and the wind's frame is where its jet then meets
        the ground. Where the wind's entity has a `Pose`, the frame is there, and the thing flies over it.
        """
        return None

    def extent(self, *, time: float) -> Extent | None:  # noqa: ARG002 - for those that end somewhere
        """Return the rectangle of its frame outside of which its mask is 0 at `time` [s]; None is everywhere.

        Only patches that the rectangle meets cost anything.
        """
        return None

    @abstractmethod
    def mask(self, place: Floats, /, *, time: float) -> Floats:
        """Return where it acts: weights in [0, 1], shape (n,), for positions (x, z) in its frame [m], shape (n, 2).

        Where winds go by priority, it acts wherever the weight is above 0.
        """

    @abstractmethod
    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        """Return the messages to receivers at positions (x, z) in its frame [m], both of shape (n, 2).

        A message is a vector of the frame along the bending direction whose norm is the posture index, in [0, 1], that
        it bends grass of stiffness 1 to: a wind says how strong it is, and each kind gives way as it can.
        `seed` is the wind's own; `grass` tells how the grass there answers.
        """

    def twin_values(self, *, time: float, seed: int) -> TwinValues:  # noqa: ARG002 - for those that have a twin
        """Return what the twin reads at `time` [s]; `seed` is the wind's own, as for `action`."""
        return TwinValues()


def on_course(wind: WindPrimitive, before: WindPrimitive, /, *, time: float) -> WindPrimitive:
    """Return a wind in place of one `before` it, of the same class, whose phases it takes over at `time` [s].

    It is itself where the rates are the same as ever.
    """
    rates, held, course = tuple(wind.rates()), tuple(before.rates()), before.course
    if course is None and rates == held:
        return wind
    course = course or Course.of(held)
    run = course if rates == course.rates[-1] else course.changed(rates, time=time)
    return with_course(wind, run, before.first)


def with_course(wind: WindPrimitive, course: Course, first: WindPrimitive, /) -> WindPrimitive:
    """Return a wind whose phases have run on a course, which was `first` before a game first changed their rates."""
    made = wind.model_copy()
    made._run = course, first  # noqa: SLF001
    return made


@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class WindSource:
    """The component of a wind entity; the primitive is a field, so that any plugin's type is found."""

    primitive: WindPrimitive
    """The primitive itself."""

    name: str
    """How messages call it: its kind and its place in the scene."""

    def __post_init__(self) -> None:
        """Raise TypeError for what is no wind and what is no name."""
        must_be_wind(self.primitive, "a WindSource carries")
        must_be_name(self.name)


def must_be_wind(thing: object, due: str, /) -> None:
    """Raise TypeError for what is no wind; `due` begins the sentence: who takes one."""
    if isinstance(thing, Presser):
        raise TypeError(f"{due} a wind, and a Presser goes with a Pose: esper.create_entity(presser, Pose(x, z))")
    if not isinstance(thing, WindPrimitive):
        said = "its name " if isinstance(thing, str) else "the class " if isinstance(thing, type) else ""
        what = thing.__name__ if isinstance(thing, type) else shortened(thing)
        raise TypeError(f"{due} a wind such as Gust(), not {said}{what}")


def must_be_name(thing: object, /) -> None:
    """Raise TypeError for what is no name of a wind."""
    if not isinstance(thing, str):
        raise TypeError(f"a wind is called by a text such as 'north', not by {shortened(thing)}")
