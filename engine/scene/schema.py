"""The JSON Schema (draft 7) of scene files, for editors; descriptions come from the docstrings."""

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaMode, models_json_schema
from pydantic_core import CoreSchema

from ...components.wind import WindPrimitive
from ..declared.scene import FORMAT, Scene

DIALECT = "http://json-schema.org/draft-07/schema#"
"""Draft of JSON Schema that the language server for YAML reads."""

_PLACE = "#/definitions/"
_MODE: JsonSchemaMode = "validation"

Schema = dict[str, Any]


def scene_schema(winds: Mapping[str, type[WindPrimitive] | None], /) -> Schema:
    """Return the schema of scene files with these kinds of wind; a kind without a class may have any keys.

    Every valid scene fits the schema. Rules beyond a schema, such as the order of a path's times, are left to `check`.
    Raises pydantic's errors for a class without a schema.
    """
    classes = [primitive for primitive in winds.values() if primitive is not None]
    models: list[type[BaseModel]] = [Scene, WindPrimitive, *classes]
    inputs = [(model, _MODE) for model in models]
    names, made = models_json_schema(inputs, ref_template=_PLACE + "{model}", schema_generator=_Readable)
    definitions: dict[str, Schema] = made["$defs"]
    name_of = {model: schema["$ref"].removeprefix(_PLACE) for (model, _), schema in names.items()}
    scene = definitions.pop(name_of[Scene])
    del definitions[name_of[WindPrimitive]]
    kinds = {kind: name_of[primitive] if primitive else None for kind, primitive in winds.items()}
    scene["properties"]["wind"]["items"] = _of_its_kind(kinds)
    scene["title"] = f"tallgrass scene, format {FORMAT}"
    for model in (scene, *definitions.values()):
        _explain(model)
    return {"$schema": DIALECT, **scene, "definitions": definitions}


class _Readable(GenerateJsonSchema):
    """Leaves out titles that repeat a field's name, and defaults that no scene file could write."""

    ignored_warning_kinds = {"skipped-choice", "non-serializable-default"}  # noqa: RUF012 - as its base declares it

    def field_title_should_be_set(self, schema: CoreSchema | Any) -> bool:
        return False


def _of_its_kind(kinds: Mapping[str, str | None]) -> Schema:
    """Return the schema of one wind: its `kind` selects the definition, whose name `kinds` has."""
    return {
        "type": "object",
        "required": ["kind"],
        "properties": {"kind": {"enum": sorted(kinds)}},
        "allOf": [
            {"if": {"required": ["kind"], "properties": {"kind": {"const": kind}}}, "then": {"$ref": _PLACE + name}}
            for kind, name in sorted(kinds.items())
            if name is not None
        ],
    }


def _explain(model: Schema) -> None:
    """Write a model's descriptions for editors, with defaults and ranges."""
    model["description"] = _unfolded(model.get("description", ""))
    for name, field in model.get("properties", {}).items():
        texts = [_unfolded(field.pop("description", "")), _facts(field)]
        if field.get("default") is None or isinstance(field["default"], dict):
            field.pop("default", None)
        if "$ref" in field:  # in draft 7, other keys next to a reference are ignored
            field = {"allOf": [{"$ref": field.pop("$ref")}], **field}  # noqa: PLW2901
        model["properties"][name] = {"description": "\n\n".join(filter(None, texts)), **field}


def _unfolded(text: str) -> str:
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.split("\n\n"))


def _facts(field: Schema) -> str:
    default = field.get("default")
    facts = []
    if default not in (None, []) and not isinstance(default, dict) and "const" not in field:
        facts.append(f"Default: {written(default)}.")
    for numbers in (field, *field.get("anyOf", ())):
        facts += [f"Range: {' and '.join(limits(numbers))}."] if limits(numbers) else []
    return " ".join(facts)


def limits(numbers: Schema, /) -> list[str]:
    """Return the words for a schema's range of numbers, or for each of its limits; empty without limits."""
    words = {"minimum": "at least", "exclusiveMinimum": "above", "maximum": "at most", "exclusiveMaximum": "below"}
    if "minimum" in numbers and "maximum" in numbers:
        return [f"{written(numbers['minimum'])} to {written(numbers['maximum'])}"]
    return [f"{words[name]} {written(numbers[name])}" for name in words if name in numbers]


def written(value: object, /) -> str:
    """Return a value in the notation of scene files."""
    match value:
        case bool():
            return str(value).lower()
        case float():
            return format(value, ".12g")
        case list():
            return f"[{', '.join(map(written, value))}]"
        case _:
            return str(value)
