"""`twin_problems`: differences between a wind's twin and its numpy."""

from collections.abc import Callable

import moderngl
import numpy as np
import pytest

from tallgrass.components.arrays import Floats
from tallgrass.components.wind import Grass, TwinValues, WindPrimitive
from tallgrass.engine.plugins import wind_kinds
from tallgrass.systems.wind.gust import Gust
from tallgrass.systems.wind.twin import Twin, TwinError
from tallgrass.testing import twin_problems

Write = Callable[[str], None]


class Level(WindPrimitive):
    """A wind to the right that grows in time."""

    kind: str = "level"

    def mask(self, place: Floats, /, *, time: float) -> Floats:
        return np.ones(len(place), np.float32)

    def action(self, place: Floats, /, *, time: float, seed: int, grass: Grass) -> Floats:
        return np.full_like(place, [min(0.5, 0.001 * time), 0.0])

    def twin_values(self, *, time: float, seed: int) -> TwinValues:
        return TwinValues({"bend": 0.001 * time})


@pytest.fixture
def write(monkeypatch: pytest.MonkeyPatch) -> Write:
    """Return the function that gives `Level` a twin in memory, whose message is some GLSL."""

    def written(message: str) -> None:
        body = f"vec2 action(vec2 place, Air air) {{ return {message}; }}"
        twin = Twin.of("level.glsl", ["float mask(vec2 place, Air air) { return 1.0; }", body])
        for module in ("tallgrass.systems.wind.card", "tallgrass.testing.twins"):
            monkeypatch.setattr(f"{module}.twin_of", lambda _: twin)

    return written


@pytest.mark.parametrize("kind", ["breeze", "gust", "whirlwind", "blast", "turbulence"])
def test_built_in_winds_and_their_twins_say_the_same(ctx: moderngl.Context, kind: str) -> None:
    assert twin_problems(wind_kinds().find(kind), ctx) == []


def test_a_gust_that_comes_again_is_looked_at_when_it_does(ctx: moderngl.Context) -> None:
    assert twin_problems(Gust(every=[4.0, 9.0], wander=10.0), ctx, seed=3) == []


def test_a_wind_without_a_twin_has_no_problem(ctx: moderngl.Context) -> None:
    assert twin_problems(Level, ctx) == []


def test_a_twin_that_says_the_same_has_none_either(ctx: moderngl.Context, write: Write) -> None:
    write("vec2(min(0.5, air.bend), 0.0)")
    assert twin_problems(Level, ctx) == []


def test_a_twin_that_differs_is_told_of_where_it_does_most(ctx: moderngl.Context, write: Write) -> None:
    write("vec2(min(0.6, air.bend), 0.0)")
    (problem,) = twin_problems(Level, ctx)
    assert problem.startswith("its twin differs from mask and action by 0.1 at (")
    assert problem.endswith(" s), over 0.001")


def test_a_twin_that_cannot_be_used_is_told_of(
    ctx: moderngl.Context, write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    write("vec2(oops)")
    (problem,) = twin_problems(Level, ctx)
    assert "level.glsl:2" in problem
    write("vec2(air.bent)")
    (problem,) = twin_problems(Level, ctx)
    assert problem.startswith("its twin cannot be used: it reads 'bent', which is no field")

    def missing(_: type[WindPrimitive]) -> Twin:
        raise TwinError("there is no file 'level.glsl'")

    monkeypatch.setattr("tallgrass.testing.twins.twin_of", missing)
    assert twin_problems(Level, ctx) == ["its twin cannot be used: there is no file 'level.glsl'"]
