"""Checking a wind, and the fields of its class, against the rules for winds, which the built-in ones keep too."""

import re
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import chain
from math import inf
from types import UnionType
from typing import Any, Union, get_args, get_origin

import numpy as np
from pydantic import ValidationError
from pydantic.fields import FieldInfo

from ..components.arrays import Floats
from ..components.body import Hover
from ..components.field import declared
from ..components.wind import INTERFACE, Grass, WindPrimitive
from ..engine.complaint import words_of
from ..engine.plugins import KIND
from ..systems.overlay.paint import is_color
from ..systems.wind.quarantine import SLOW
from .trial import FailedError, Report, crowd, flight, grass_at, timed, times_of, try_part

MOST_COST = 0.02
"""Greatest duration of a wind for 10,000 receivers, in processor time [s].

At 60 frames a second a frame has 0.0167 s for everything.
"""

MOST_SEED = 2**32 - 1
"""Largest seed of a wind."""

_CROWD = 10_000
_TRIES = 5
_TIMES = (0.0, 1 / 60, 0.5, 1.0, 2.7, 5.0, 9.3, 20.0, 61.7, 600.0, 3600.0, 35999.0)
_RANGES = {
    "priority": (-1000, 1000),
    "weight": (0.0, 1.0),
    "swing": (0.0, 0.5),
    "start": (0.0, 1e6),
    "ease": (0.0, 1e6),
}

_UNIT = re.compile(r"\[[^\[\]]+\]")
_UNIT_WORD = re.compile(r"\b(metres|meters|centimetres|seconds|minutes|degrees|radians|hertz)\b", re.IGNORECASE)
_BOUNDS = {"lower": ("ge", "gt"), "upper": ("le", "lt")}


def check_wind(primitive: WindPrimitive | type[WindPrimitive], /, *, seed: int = 0) -> None:
    """Raise AssertionError with one sentence for each problem of a wind, or of a class's defaults.

    `wind_problems` says what is checked.
    """
    problems = wind_problems(primitive, seed=seed)
    if problems:
        raise AssertionError("\n".join(problems))


def wind_problems(primitive: WindPrimitive | type[WindPrimitive], /, *, seed: int = 0) -> list[str]:
    """Return the problems of a wind, or of a class's defaults, one sentence each.

    Checked are its fields (a docstring, a default, bounds, the unit in brackets), its colour and the body that hovers
    over it. Then its methods are called along its timeline, for receivers in its extent, around it and 10 km away, for
    one alone and for none. Answers have the right types and shapes and finite numbers; weights are within 0 and 1, and
    0 outside the extent; an index is at most 1. They do not depend on the way of asking, and take at most `MOST_COST`
    of processor time for 10,000 receivers; an answer for fewer that takes longer ends the checks. Numpy's
    floating-point errors (division by zero, overflow, invalid values) count as raised. `seed` is the wind's own.
    """
    kind: Any = primitive if isinstance(primitive, type) else type(primitive)
    if not issubclass(kind, WindPrimitive):
        return [f"{kind.__name__} does not derive from WindPrimitive"]
    problems = declaration_problems(kind)
    if kind.interface != INTERFACE:
        problems.append(f"{kind.__name__} is written for interface {kind.interface}; this tallgrass has {INTERFACE}")
    if kind.color is not None and not is_color(kind.color):
        problems.append(f"color is {kind.color!r}, not a tuple of three numbers from 0 to 1")
    wind: Any = primitive
    if isinstance(primitive, type):
        try:
            wind = kind()
        except (Exception, SystemExit) as error:  # noqa: BLE001 - its validators may raise anything
            text = words_of(error) or type(error).__name__
            return [*problems, f"{kind.__name__} cannot be made from its defaults alone: {text}"]
    with np.errstate(divide="raise", over="raise", invalid="raise", under="ignore"):
        return [*problems, *_behaviour(wind, seed)]


def _behaviour(wind: WindPrimitive, seed: int) -> list[str]:
    report = Report(most=MOST_COST)
    try:
        _values(wind, report)
        report.ask("model_dump_json", "which settles ties", wind.model_dump_json)
        times = timeline(wind)
        if report.twice("hover", "at any time", wind.hover, Hover, type(None)) is not None:
            flight(wind, report, times)
        times_of(wind, report)
        first = {time: _answers(wind, report, time, seed) for time in times}
        _answers(wind, report, times[0], MOST_SEED)
        for time in reversed(times):
            answers = _answers(wind, report, time, seed)
            if [each.tobytes() for each in answers] != [each.tobytes() for each in first[time]]:
                kept = f"it keeps something between calls: at {time:g} s it answers differently after other times"
                report.add("time", kept)
        _cost(wind, report, max(times, key=lambda time: sum(len(one) for one in first[time])), seed)
    except FailedError:
        pass
    return list(report.sentences.values())


def timeline(wind: WindPrimitive, /) -> list[float]:
    """Return times at which a wind is tried, from its start to its stop [s]."""
    times = [wind.start + time for time in _TIMES]
    if wind.stop is None:
        return times
    return [time for time in times if time < wind.stop] + [wind.stop - 1e-3 * (wind.stop - wind.start)]


def _values(wind: WindPrimitive, report: Report) -> None:
    if not isinstance(wind.kind, str) or not KIND.fullmatch(wind.kind):
        report.add("kind", f"kind is {wind.kind!r}, not lower-case letters, digits, - and _")
    for name, (least, most) in _RANGES.items():
        value = getattr(wind, name)
        if not isinstance(value, int if name == "priority" else int | float) or not least <= value <= most:
            raise report.fail(name, f"{name} is {value!r}, not a number from {least:g} to {most:g}")


def _parts(wind: WindPrimitive, report: Report, time: float, seed: int) -> list[WindPrimitive]:
    parts = report.ask("parts", f"at {time:g} s", lambda: wind.parts(time=time, seed=seed))
    if not isinstance(parts, Sequence):
        raise report.fail("parts", f"parts returned {type(parts).__name__}, not a sequence of winds")
    for part in parts:
        if not isinstance(part, WindPrimitive):
            raise report.fail("parts", f"parts returned a sequence with {type(part).__name__} in it, not only winds")
        _values(part, report)
    return list(parts)


def _answers(wind: WindPrimitive, report: Report, time: float, seed: int) -> list[Floats]:
    parts = _parts(wind, report, time, seed)
    if _parts(wind, report, time, seed) != parts:
        report.add("parts again", f"parts answers differently when it is asked again (at {time:g} s)")
    return [answer for part in parts for answer in try_part(part, report, time=time, seed=seed)]


def _cost(wind: WindPrimitive, report: Report, time: float, seed: int) -> None:
    took = inf
    for _ in range(_TRIES):
        took = min(took, _seconds(wind, time, seed))
        if not MOST_COST < took < SLOW:  # it is quick enough, or so slow that another try does not help
            break
    if took > MOST_COST:
        cost = f"{1000.0 * took:.0f} ms of processor time for 10,000 receivers (at {time:g} s)"
        report.add("cost", f"it takes {cost}, over {1000.0 * MOST_COST:.0f} ms")


def _seconds(wind: WindPrimitive, time: float, seed: int) -> float:
    """Return the duration of all parts together for 10,000 receivers, in processor time [s]."""
    parts = wind.parts(time=time, seed=seed)
    places = [crowd(part.extent(time=time), _CROWD // max(1, len(parts))) for part in parts]
    grass = [grass_at(place) for place in places]
    return timed(partial(_ask_all, wind, places, grass, time, seed))[1]


def _ask_all(wind: WindPrimitive, places: list[Floats], grass: list[Grass], time: float, seed: int) -> None:
    for part, place, here in zip(wind.parts(time=time, seed=seed), places, grass, strict=True):
        part.pose(time=time)
        part.extent(time=time)
        held = np.flatnonzero(part.mask(place, time=time) > 0.0)
        part.action(place[held], time=time, seed=seed, grass=here.at(held))


def declaration_problems(primitive: type[WindPrimitive], /) -> list[str]:
    """Return the problems of the fields of a class of winds, one sentence each."""
    return [
        f"the field '{name}' {problem}"
        for name, info in primitive.model_fields.items()
        for problem in _of_field(primitive, name, info)
    ]


def _of_field(primitive: type[WindPrimitive], name: str, info: FieldInfo) -> Iterator[str]:
    sentence = (info.description or "").strip()
    if not sentence:
        yield "has no sentence: write a docstring below it"
    elif _UNIT_WORD.search(sentence) and not _UNIT.search(sentence):
        yield f"names its unit in words: put it in brackets, like [m], unlike in '{sentence}'"
    if _is_number(declared(name, info).annotation):
        limits = declared(name, info).limits
        missing = [end for end, names in _BOUNDS.items() if limits.keys().isdisjoint(names)]
        if missing:
            yield f"has no {' and no '.join(missing)} bound: write Field(..., {_bounds_before(primitive, name)})"
    if info.is_required():
        yield "has no default"
    else:
        yield from _of_default(primitive, name, info)


def _bounds_before(primitive: type[WindPrimitive], name: str) -> str:
    """Return the bounds that a base gives a field which a class declares again, as they are written."""
    for base in primitive.__mro__[1:]:
        info = base.model_fields.get(name) if issubclass(base, WindPrimitive) else None
        limits = declared(name, info).limits if info is not None else {}
        if found := ", ".join(f"{end}={limits[end]:g}" for end in chain(*_BOUNDS.values()) if end in limits):
            return found
    return "ge=..., le=..."


def _is_number(annotation: Any) -> bool:
    """Return whether a value may be a number itself, as in `int | float`, and not only a list of numbers."""
    is_union = get_origin(annotation) in (Union, UnionType)
    return annotation in (int, float) or (is_union and any(map(_is_number, get_args(annotation))))


def _of_default(primitive: type[WindPrimitive], name: str, info: FieldInfo) -> Iterator[str]:
    default = info.get_default(call_default_factory=True, validated_data={})
    try:
        primitive.model_validate({name: default})
    except ValidationError as error:
        for one in error.errors():
            if one["loc"][:1] == (name,):
                yield f"refuses its own default {default!r}: {one['msg']}"
    except Exception:  # noqa: BLE001 - other errors of its validators are reported for the class, not for each field
        return
