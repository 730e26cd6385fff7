"""`check_wind`: a wind's description of itself, its pose, parts and fields."""

import random
from typing import Annotated, Any

import numpy as np
import pytest
from pydantic import Field

from tallgrass.components.arrays import Floats
from tallgrass.components.body import Hover
from tallgrass.components.declaration import Pair
from tallgrass.components.pose import Pose
from tallgrass.components.wind import Extent, Grass, WindPrimitive
from tallgrass.testing import check_wind, wind_problems


class Even(WindPrimitive):
    """A correct wind, which blows along +x everywhere."""

    kind: str = "even"
    """An even wind."""

    def mask(self, place: Floats, /, *, time: float) -> Any:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Any:
        return np.stack([np.full(len(place), 0.5), np.zeros(len(place))], 1)


def test_a_wind_that_blows_everywhere_has_no_problems() -> None:
    assert wind_problems(Even) == []


class Lost(Even):
    """Its `pose` returns None."""

    def pose(self, *, time: float) -> Any:
        return None


class Endless(Even):
    """Its pose is infinite."""

    def pose(self, *, time: float) -> Any:
        return Pose(x=float("inf"))


class Topped(Even):
    """Its `hover` returns a text."""

    def hover(self) -> Any:
        return "saucer"


class Winged(Even):
    """Its body has an unknown model."""

    def hover(self) -> Any:
        return Hover("dragon")  # type: ignore[arg-type]


class Buried(Even):
    """Its body is below the ground."""

    def hover(self) -> Any:
        return Hover(height=-1.0)


class Wavering(Even):
    """Its body has another height at each call."""

    def hover(self) -> Any:
        return Hover(height=random.uniform(1.0, 9.0))  # noqa: S311 - that is what is wrong with it


class Sudden(Even):
    """Its pose is NaN before time 0."""

    def hover(self) -> Any:
        return Hover()

    def pose(self, *, time: float) -> Any:
        return Pose(x=float(np.sqrt(time)))


class Countless(Even):
    """Its `rates` returns no list."""

    def rates(self) -> Any:
        return None


class Rateless(Even):
    """Its rate is NaN."""

    def rates(self) -> Any:
        return (float("nan"),)


class Evermore(Even):
    """Its `ends` returns a text."""

    def ends(self) -> Any:
        return "never"


class Undated(Even):
    """Its `ends` returns NaN."""

    def ends(self) -> Any:
        return float("nan")


class Painted(Even):
    """Its colour is in bytes."""

    color = (255, 128, 0)


class Boxed(Even):
    """Its extent is a list."""

    def extent(self, *, time: float) -> Any:
        return [-2.0, 2.0, -2.0, 2.0]


class Inverted(Even):
    """Its extent has its left on the right."""

    def extent(self, *, time: float) -> Any:
        return Extent(2.0, -2.0, -2.0, 2.0)


class Single(Even):
    """Its `parts` returns itself instead of a list."""

    def parts(self, *, time: float, seed: int) -> Any:
        return self


class Numbered(Even):
    """Its `parts` returns numbers."""

    def parts(self, *, time: float, seed: int) -> Any:
        return [1, 2]


class Eager(Even):
    """Its parts' priority is out of range."""

    def parts(self, *, time: float, seed: int) -> Any:
        return [self.model_copy(update={"priority": 5000})]


class Later(Even):
    """It is written for another release."""

    interface = 7


class Odd(Even):
    """Its `kind` is no valid name."""

    kind: str = "Odd Kind"
    """An odd kind."""


@pytest.mark.parametrize(
    ("wind", "problem"),
    [
        (Lost, r"pose returned NoneType, not Pose \(at 0 s\)"),
        (Endless, r"pose returned Pose\(x=inf, .*\), which is not all numbers \(at 0 s\)"),
        (Topped, r"hover returned str, not Hover or None \(at any time\)"),
        (Winged, r"hover raised ValueError: a body's model is one of saucer, not 'dragon' \(at any time\)"),
        (Buried, r"hover raised ValueError: a body flies above 0 and up to 1000 m high, not -1\.0 \(at any time\)"),
        (Wavering, r"hover answers differently when it is asked again \(at any time\)"),
        (Sudden, r"pose raised FloatingPointError: .* \(at -0\.3 s, for what hovers over it\)"),
        (Countless, r"rates raised TypeError: .* \(at any time\)"),
        (Rateless, r"rates returned \(nan,\), which is not all finite numbers"),
        (Evermore, r"ends returned 'never', not a time"),
        (Undated, r"ends returned nan, not a time"),
        (Painted, r"color is \(255, 128, 0\), not a tuple of three numbers from 0 to 1"),
        (Boxed, r"extent returned list, not Extent or None \(at 0 s\)"),
        (Inverted, r"extent returned Extent\(.*\), which ends before it begins \(at 0 s\)"),
        (Single, r"parts returned Single, not a sequence of winds"),
        (Numbered, r"parts returned a sequence with int in it, not only winds"),
        (Eager, r"priority is 5000, not a number from -1000 to 1000"),
        (Later, r"Later is written for interface 7; this tallgrass has 1"),
        (Odd, r"kind is 'Odd Kind', not lower-case letters, digits, - and _"),
    ],
)
def test_d5_what_is_wrong_with_what_a_wind_says_of_itself_is_one_sentence(
    wind: type[WindPrimitive], problem: str
) -> None:
    with pytest.raises(AssertionError, match=f"^{problem}$"):
        check_wind(wind)


class Plain(Even):
    """A wind whose fields are declared badly."""

    silent: float = Field(1.0, ge=0.0, le=2.0)

    endless: float = 1.0
    """How long it lasts [s]."""

    priority: int = 7
    """The highest priority at a place counts."""

    half: float | None = Field(None, ge=0.0)
    """How long half of it lasts [s]."""

    spelled: float = Field(1.0, ge=0.0, le=2.0)
    """Width in metres."""

    beyond: float = Field(3.0, ge=0.0, le=2.0)
    """How strong it is."""

    several: Pair = Field(default=[0.0, 0.0])
    """Where it is [m]."""

    inner: Annotated[float, Field(ge=0.0, le=1.0)] | None = None
    """How strong it is within."""

    switched: bool = False
    """Whether it blows."""


def test_d5_fields_that_are_declared_badly_are_named() -> None:
    assert wind_problems(Plain) == [
        "the field 'priority' has no lower and no upper bound: write Field(..., ge=-1000, le=1000)",
        "the field 'silent' has no sentence: write a docstring below it",
        "the field 'endless' has no lower and no upper bound: write Field(..., ge=..., le=...)",
        "the field 'half' has no upper bound: write Field(..., ge=..., le=...)",
        "the field 'spelled' names its unit in words: put it in brackets, like [m], unlike in 'Width in metres.'",
        "the field 'beyond' refuses its own default 3.0: Input should be less than or equal to 2",
    ]


def test_a_class_that_needs_values_is_checked_with_those_of_an_instance() -> None:
    class Needy(Even):
        """A wind with a required field."""

        strength: float = Field(ge=0.0, le=1.0)
        """How strong it is."""

    told = wind_problems(Needy)
    assert told[0] == "the field 'strength' has no default"
    assert told[1] == "Needy cannot be made from its defaults alone: Needy: the key 'strength' is missing"
    assert wind_problems(Needy(strength=0.2)) == told[:1]


def test_what_is_no_wind_is_refused() -> None:
    assert wind_problems(int) == ["int does not derive from WindPrimitive"]  # type: ignore[arg-type]
    assert wind_problems(WindPrimitive)[-1].startswith("WindPrimitive cannot be made from its defaults alone")
