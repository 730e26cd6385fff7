"""Winds as a state has them: made from an entity, and made into a wind again."""

import json
from typing import Any

from pydantic import ValidationError

from ..components.pose import Pose
from ..components.wind import WindPrimitive, WindSource, with_course
from ..components.words import errors_in_words
from ..engine.declared.scene import Reading
from ..engine.handed import is_somewhere
from ..engine.plugins import wind_kinds
from ..engine.stored import refuse
from .saved import SavedWind


def saved_wind(
    entity: int, source: WindSource, pose: Pose | None = None, run: WindPrimitive | None = None, /
) -> SavedWind | None:
    """Return a wind as it is saved, None at a pose that is not finite; `run` has the course of its phases, if any.

    Raises ValueError for a wind whose class is not registered.
    """
    if pose is not None and not is_somewhere(pose):
        return None
    wind = source.primitive
    try:
        known, values = wind_kinds().find(wind.kind), json.loads(wind.model_dump_json())
    except (Exception, SystemExit) as error:  # a stranger's wind may raise anything
        raise ValueError(f"the wind '{source.name}' cannot be saved: {error}") from error
    if known is not type(wind):
        raise ValueError(f"the wind '{source.name}' cannot be saved: another class is registered as '{wind.kind}'")
    course, first = (None, None) if run is None else (run.course, run.first)
    return SavedWind(
        entity=entity, kind=wind.kind, name=source.name, values=values, pose=pose, course=course,
        first=None if first is None else json.loads(first.model_dump_json()),
    )  # fmt: skip


def wind_of(kind: str, values: dict[str, Any], reading: Reading, /) -> WindPrimitive:
    """Return the wind of a kind with these values; raises ValueError for values that do not fit."""
    try:
        known = reading["wind"](kind)
        return known.model_validate_json(json.dumps(values), context=reading)
    except (Exception, SystemExit) as error:  # a stranger's wind may raise anything
        said = errors_in_words(error, known, kind) if isinstance(error, ValidationError) else error
        raise ValueError(f"a wind of this state, a {kind}, cannot be made: {said}") from error


def _count_rates(wind: WindPrimitive) -> int:
    try:
        return len(wind.rates())
    except (Exception, SystemExit) as error:  # a stranger's wind may raise anything
        raise ValueError(f"a wind of this state, a {wind.kind}, cannot tell its rates: {error}") from error


def wind_on_course(wind: SavedWind, reading: Reading, /) -> WindPrimitive:
    """Return a wind with the course of its phases; raises ValueError for an impossible course."""
    made, course = wind_of(wind.kind, wind.values, reading), wind.course
    assert course is not None
    widths = {len(each) for each in (*course.rates, *course.offsets)}
    if not len(course.rates) == len(course.offsets) == len(course.times) + 1 or widths != {_count_rates(made)}:
        refuse("the phases of a wind have a wrong number of rates or offsets")
    return with_course(made, course, wind_of(wind.kind, wind.first or {}, reading))
