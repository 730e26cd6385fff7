"""Pydantic's errors in plain sentences."""

import re
from collections.abc import Callable, Iterable
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from .colour import LONG, nearest
from .field import Field, declared, inside

_WANTED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "int_from_float": "a whole number",
    "string_type": "text",
    "bool_type": "true or false",
    "list_type": "a list",
    "dict_type": "a mapping of keys",
    "model_type": "a mapping of keys",
    "finite_number": "a finite number",
}
_COLOUR = "a colour such as '#2f4019' or 'orange'"
_UNIT = re.compile(r"\[([a-z/]{1,12})\]")
_DECIMAL_COMMA = re.compile(r"[-+]?\d+,\d+")
_TIGHT = re.compile(r"([a-z_]+):\S")
_WITH_UNIT = re.compile(r"([-+]?[\d.]+)\s*[a-zA-Z°%/]+")


def sentence(error: ErrorDetails, field: Field, /) -> str:
    """Return an error as one sentence in words of the scene file."""
    kind, value = error["type"], error["input"]
    if kind in _WANTED:
        wanted = _COLOUR if _is_colour(field) else _list(field) if kind == "list_type" else _WANTED[kind]
        return f"{field.name} must be {wanted}, found {in_words(value)}{_hint(kind, value, field)}"
    say = _SENTENCES.get(kind)
    return say(error, field) if say else f"{field.name}: {error['msg']}"


def errors_in_words(error: ValidationError, model: type[BaseModel], name: str, /) -> str:
    """Return the errors of a model that is called `name`, a sentence each."""
    return "; ".join(sentence(each, _field_of(each, model, name)) for each in error.errors(include_url=False))


if TYPE_CHECKING:  # a metaclass with `__call__` would hide the fields from type checkers
    from pydantic._internal._model_construction import ModelMetaclass

    Plain = ModelMetaclass
else:

    class Plain(type(BaseModel)):
        """Turns a class's validation errors into a ValueError with a plain sentence."""

        def __call__(cls, *args: Any, **values: Any) -> Any:
            """Return an object of the class."""
            if args and cls.__init__ is BaseModel.__init__:
                raise TypeError(f"a {cls.__name__} takes its values by name, such as {[*cls.model_fields][-1]}=...")
            try:
                return super().__call__(*args, **values)
            except ValidationError as error:
                raise ValueError(f"{cls.__name__}: {errors_in_words(error, cls, cls.__name__)}") from None


def _field_of(error: ErrorDetails, model: type[BaseModel], name: str) -> Field:
    key, *steps = error["loc"] or ("",)
    if key not in model.model_fields:
        return Field(name, model=model)
    field = declared(str(key), model.model_fields[str(key)])
    for step in steps:
        field = inside(field, f"item {step + 1} of {field.name}") if isinstance(step, int) else field
    return field


def guess(word: str, known: Iterable[str], /, *, cutoff: float = 0.6) -> str:
    """Return the end of a message on an unknown word: the most similar known word, or one that begins with it.

    It is empty where none is as similar as `cutoff`, in [0, 1] (Ratcliff and Metzener, 1988).
    """
    words = [*known]
    near = get_close_matches(word, words, n=1, cutoff=cutoff)
    near = near or [each for each in words if len(word) > 2 and each.startswith(word)]
    return f", did you mean '{near[0]}'?" if near else ""


def suggestion(word: str, known: Iterable[str], /) -> str:
    """Return the end of a message on an unknown word: what `guess` returns, or else all known words."""
    words = sorted(known)
    return guess(word, words) or (f"; known: {', '.join(words)}" if words else "")


def no_file(name: str, /) -> str:
    """Return what is said of a missing file that a scene names."""
    slashes = f"; write / between folders, '{name.replace(chr(92), '/')}'" if "\\" in name else ""
    return f"no file '{name}' relative to the scene{slashes}"


def in_words(value: object, /) -> str:
    """Return a scene file's value in words, for messages."""
    match value:
        case None:
            return "nothing"
        case bool():
            return str(value).lower()
        case str():
            return f"the text '{value}'" if len(value) <= 40 else f"the text '{value[:40]}...'"
        case list() | tuple():
            return f"a list of {len(value)}"
        case dict():
            return "a mapping of keys"
        case _:
            return f"an array of shape {value.shape}" if isinstance(value, np.ndarray) else str(value)


def _unknown_key(error: ErrorDetails, field: Field) -> str:
    key = str(error["loc"][-1])
    return f"unknown key '{key}'{suggestion(key, field.keys)}"


def _not_among(error: ErrorDetails, field: Field) -> str:
    value, choices = error["input"], re.findall(r"'([^']*)'", error["ctx"]["expected"])
    near = guess(value, choices) if isinstance(value, str) else ""
    return f"{field.name} must be one of {', '.join(choices)}; found {in_words(value)}{near}"


def _out_of_range(error: ErrorDetails, field: Field) -> str:
    bounds = field.limits | error["ctx"]
    if "ge" in bounds and "le" in bounds:
        text = f"between {_number(bounds['ge'])} and {_number(bounds['le'])}"
    else:
        words = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
        text = " and ".join(f"{words[name]} {_number(bounds[name])}" for name in words if name in bounds)
    unit = _UNIT.search(field.description)
    return f"{field.name} must be {text}{' ' + unit[1] if unit else ''}, found {in_words(error['input'])}"


def _of_length(error: ErrorDetails, field: Field) -> str:
    value, limits = error["input"], field.limits | error["ctx"]
    if isinstance(value, list | tuple):
        most = limits.get("max_length", 0)
        commas = len(value) == 2 * most and all(type(each) is int for each in value)
        point = f"; a decimal takes a point, {value[0]}.{value[1]}" if commas else ""
        return f"{field.name} must be {_list(field)}, found {len(value)}{point}"
    least, most = limits.get("min_length", 0), limits.get("max_length", "any number of")
    return f"{field.name} must have {least} to {most} entries, found {len(value)}"


def _of_pattern(error: ErrorDetails, field: Field) -> str:
    pattern, text = error["ctx"]["pattern"], str(error["input"])
    if LONG not in pattern:
        return f"{field.name} must be text of the form {pattern}, found {in_words(text)}"
    near = nearest(text)
    guess = f", did you mean '{near}'?" if near else ""
    return f"{field.name} must be {_COLOUR}, found {in_words(text)}{guess}"


def _is_colour(field: Field) -> bool:
    return LONG in field.limits.get("pattern", "")


def _number(value: float) -> str:
    return str(value) if isinstance(value, int) else format(value, ".12g")


def _list(field: Field) -> str:
    least, most = field.limits.get("min_length", 0), field.limits.get("max_length")
    things = "numbers" if inside(field, "").annotation in (int, float) else "entries"
    if least == most:
        return f"a list of {least} {things}"
    return f"a list of {least} to {most} {things}" if most else "a list"


def _hint(kind: str, value: object, field: Field) -> str:
    if kind == "model_type":
        return _hint_of_mapping(value, field)
    if value is None and _is_colour(field):
        return "; a colour needs quotes, because # begins a comment"
    if isinstance(value, str) and kind in ("float_type", "int_type"):
        if _DECIMAL_COMMA.fullmatch(value):
            return f"; write it with a point, {value.replace(',', '.')}"
        number = _WITH_UNIT.fullmatch(value)
        return f"; leave the unit out, {number[1]}" if number else ""
    return ""


def _hint_of_mapping(value: object, field: Field) -> str:
    """Return a hint for a `value` that should have been a mapping."""
    if value is None:
        return "; write {} to leave everything at its default" if _needs_nothing(field.model) else ""
    if field.model is not None and field.name in field.model.model_fields:
        return "; this key stands one level deeper, below a name"
    tight = _TIGHT.match(value) if isinstance(value, str) else None
    return f"; a space is missing after '{tight[1]}:'" if tight else ""


def _needs_nothing(model: type[BaseModel] | None) -> bool:
    try:
        return model is not None and bool(model.model_validate({}))
    except ValidationError:
        return False


_SENTENCES: dict[str, Callable[[ErrorDetails, Field], str]] = {
    "extra_forbidden": _unknown_key,
    "missing": lambda error, _: f"the key '{error['loc'][-1]}' is missing",
    "literal_error": _not_among,
    "greater_than": _out_of_range,
    "greater_than_equal": _out_of_range,
    "less_than": _out_of_range,
    "less_than_equal": _out_of_range,
    "too_short": _of_length,
    "too_long": _of_length,
    "string_too_short": lambda _, field: f"{field.name} must not be empty",
    "string_pattern_mismatch": _of_pattern,
    "value_error": lambda error, _: str(error["ctx"]["error"]),
    "unknown_kind": lambda error, _: error["msg"],
    "missing_kind": lambda error, _: error["msg"],
}
