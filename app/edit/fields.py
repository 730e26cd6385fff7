"""The keys of scenes as the panel shows them, derived from the models that read scenes."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache
from math import isfinite
from types import NoneType
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from ...components.colour import LONG
from ...components.field import Field, declared, inside
from .values import NOTHING, yaml_text

Form = Literal[
    "number", "whole", "switch", "choice", "color", "text", "numbers", "part", "parts", "named", "fixed", "yaml"
]
"""The form of a key's value: a single value, numbers, a part of the scene, several parts, or any YAML."""

UNIT = re.compile(r"\s*\[([A-Za-z/²%]+)\]")
"""The unit in a key's sentence."""

PULLED, TYPED = 3, 7
"""Significant digits of a number from a slider, and of a typed one."""

EVERYWHERE = 1e6
"""Bound from which on a range is not worth showing."""


@dataclass(frozen=True, slots=True)
class Key:
    """One key: its form, its limits and its description."""

    name: str

    form: Form

    sentence: str
    """Description, without its unit."""

    unit: str = ""

    default: Any = NOTHING
    """Default value; NOTHING where a file must give one."""

    optional: bool = False
    """Whether its value may be null."""

    low: float | None = None
    """Least number."""

    high: float | None = None
    """Largest number."""

    above: bool = False
    """Whether its number must exceed `low`."""

    below: bool = False
    """Whether its number must be less than `high`."""

    choices: tuple[str, ...] = ()
    """Texts to choose from."""

    count: int = 1
    """Number of numbers that it takes."""

    most: int | None = None
    """Most parts of a list or entries of a mapping."""

    model: type[BaseModel] | None = None
    """Model of a part, or of each of several parts; of a choice, the model of its alternative part."""


@cache
def keys_of(model: type[BaseModel], /) -> tuple[Key, ...]:
    """Return every key of a model, in its order."""
    return tuple(_key(name, info) for name, info in model.model_fields.items())


def item_key(key: Key, name: str, model: type[BaseModel] | None = None, /) -> Key:
    """Return the key, called `name`, of one of several parts; `model` is the part's, by default the common one."""
    return replace(key, name=name, form="part", default=NOTHING, optional=False, model=model or key.model)


def _key(name: str, info: FieldInfo) -> Key:
    field = declared(name, info)
    sentence = " ".join((info.description or "").split())
    unit = UNIT.search(sentence)
    default = NOTHING if info.is_required() else info.get_default(call_default_factory=True)
    attributes, optional = _form(field), NoneType in get_args(info.annotation)
    if attributes["form"] == "fixed" and optional:
        attributes["form"] = "choice"
    return Key(
        name=name,
        sentence=UNIT.sub("", sentence),
        unit=unit[1] if unit else "",
        default=NOTHING if default is PydanticUndefined else default,
        optional=optional,
        **attributes,
    )


_PLAIN: dict[Any, Form] = {bool: "switch", int: "whole", float: "number", str: "text"}


def _form(field: Field) -> dict[str, Any]:
    """Return the form of a field, and the attributes of `Key` that go with the form."""
    origin, limits = get_origin(field.annotation), field.limits
    choices = tuple(_literals(field.annotation))
    if LONG in limits.get("pattern", ""):
        return {"form": "color"}
    if field.annotation in _PLAIN:
        return {"form": _PLAIN[field.annotation], **_bounds(limits)}
    if origin is list:
        return _of_list(field, limits)
    if choices:
        return _of_choices(field, choices)
    form: Form = "named" if origin is dict else "part" if field.model else "yaml"
    return {"form": form, "model": field.model, "most": limits.get("max_length")}


def _of_choices(field: Field, choices: tuple[Any, ...]) -> dict[str, Any]:
    texts = tuple(choice for choice in choices if isinstance(choice, str))
    alone = field.model is None and len(choices) == 1
    return {"form": "fixed" if alone or not texts else "choice", "choices": texts, "model": field.model}


def _of_list(field: Field, limits: dict[str, Any]) -> dict[str, Any]:
    item = inside(field, field.name)
    least, most = limits.get("min_length"), limits.get("max_length")
    if item.annotation in (int, float) and least is not None and least == most:
        return {"form": "numbers", "count": least, **_bounds(item.limits)}
    if field.model is not None:
        return {"form": "parts", "model": field.model, "most": most}
    return {"form": "yaml"}


def _bounds(limits: dict[str, Any]) -> dict[str, Any]:
    found = {"above": "gt" in limits, "below": "lt" in limits}
    return found | {"low": limits.get("gt", limits.get("ge")), "high": limits.get("lt", limits.get("le"))}


def _literals(annotation: Any) -> Iterator[Any]:
    """Yield the values of the literals in an annotation, without the parts' own."""
    if get_origin(annotation) is Literal:
        yield from get_args(annotation)
    elif get_origin(annotation) is Annotated:
        yield from _literals(get_args(annotation)[0])
    elif not isinstance(annotation, type):
        for inner in get_args(annotation):
            yield from _literals(inner)


_FIRST: dict[Form, Any] = {"switch": False, "color": "#808080"}


def first_value(key: Key, /) -> Any:
    """Return an initial value for a key without one; for a part, an accepted one if possible."""
    if key.form in ("number", "whole"):
        return _middle(key)
    if key.form == "numbers":
        return [_middle(replace(key, form="number"))] * key.count
    if key.form == "part" and key.model is not None:
        return first_part(key.model)
    if key.form == "parts":
        return [first_value(item_key(key, "0"))]
    return key.choices[0] if key.choices else _FIRST.get(key.form, "")


def first_part(model: type[BaseModel], /, **given: Any) -> dict[str, Any]:
    """Return values that a model accepts: the given ones, the required ones, and if needed an optional one."""
    needed = given | {
        key.name: first_value(key) for key in keys_of(model) if key.default is NOTHING and key.name not in given
    }
    tries = [needed, *(needed | {key.name: first_value(key)} for key in keys_of(model) if key.optional)]
    return next((values for values in tries if _accepts(model, values)), needed)


def _accepts(model: type[BaseModel], values: dict[str, Any]) -> bool:
    try:
        model.model_validate(values)
    except ValidationError:
        return False
    return True


def _middle(key: Key) -> float:
    """Return a number within bounds: 0 or 1 where they allow it, or else one near the lower of them."""
    low, high = key.low if key.low is not None else 0.0, key.high if key.high is not None else 1.0
    found = next((number for number in (1.0, 0.0) if low < number < high), low + 0.1 * (high - low))
    return round(found) if key.form == "whole" else float(f"{found:.3g}")


def tidied(key: Key, number: float, /, *, pulled: bool) -> float:
    """Return a field's number rounded for the file: to fewer digits if it was pulled than if it was typed.

    A number pulled to an exclusive bound is moved a little beyond the bound. NaN and infinity stay, to be refused.
    """
    if not isfinite(number):
        return number
    if key.form == "whole":
        return round(number)
    if not pulled:
        return _shortened(number, TYPED)
    short = _shortened(number, PULLED) if abs(number) < 10.0**PULLED else round(number)
    if key.above and key.low is not None and short <= key.low:
        return _shortened(key.low + 0.05 * max(abs(key.low), 0.01), PULLED)
    return short


def _shortened(number: float, digits: int) -> float:
    short = float(f"{number:.{digits}g}")
    return int(short) if short.is_integer() else short


def tooltip(key: Key, /) -> str:
    """Return the tooltip of a key: its description, range and default."""
    facts = [key.sentence]
    if key.low is not None and key.high is not None and key.high < EVERYWHERE:
        facts.append(f"{key.low:.12g} to {key.high:.12g}{' ' + key.unit if key.unit else ''}")
    elif key.unit:
        facts.append(f"in {key.unit}")
    if key.default not in (NOTHING, None, []) and not isinstance(key.default, BaseModel):
        facts.append(f"default: {yaml_text(key.default)}")
    return "\n".join(facts)
