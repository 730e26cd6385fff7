"""Changing a part of a scene while it runs."""

from collections.abc import Mapping
from typing import TypeVar

from pydantic import BaseModel, ValidationError

from .fields import Field, declared
from .words import sentence

Part = TypeVar("Part", bound=BaseModel)


def changed(part: Part, values: Mapping[str, object], /, *, name: str) -> Part:
    """Return a part of a scene, called `name`, with other values.

    Raises ValueError with a sentence for each that cannot be.
    """
    try:
        return type(part).model_validate(part.model_dump() | dict(values))
    except ValidationError as error:
        whole, fields = Field(name, model=type(part)), type(part).model_fields
        places = [(each, str(each["loc"][0])) for each in error.errors(include_url=False)]
        told = [sentence(each, declared(key, fields[key]) if key in fields else whole) for each, key in places]
        raise ValueError("; ".join(told)) from error
