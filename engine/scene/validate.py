"""Validating the values of a scene, or of a part of it: the `Scene`, or all problems."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeGuard, TypeVar, get_origin

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from ...components.declaration import DeclarationError
from ...components.field import Field, declared, inside
from ...components.wind import WindPrimitive
from ...components.words import errors_in_words, in_words, sentence
from ..declared.grass import GrassKind
from ..declared.scene import FORMAT, Reading, Scene
from ..plugins import wind_kinds
from .document import Document, Node, Where
from .problem import MOST_PROBLEMS, Problem, SceneError
from .values import values_document
from .version import FIRST, upgrade

Model = TypeVar("Model", bound=BaseModel)


def validate(document: Document, /, *, folder: Path | None = None, also: Iterable[Problem] = ()) -> Scene:
    """Return the scene of a document. Raises SceneError with every problem of it, and those in `also`.

    Files that winds name are relative to `folder`, and are read only if it is given.
    """
    if not isinstance(document.root.data, dict):
        message = f"{FIRST}, then its keys; this is {in_words(document.root.data)}"
        raise SceneError([*document.problems, document.problem((), message)])
    problems = [*document.problems, *also, *_of_version(document)]
    values = upgraded(document)
    find = wind_kinds().find
    reading = Reading(wind=find) if folder is None else Reading(wind=find, folder=folder)
    try:
        scene = Scene.model_validate(values | {"tallgrass": FORMAT}, context=reading)
    except ValidationError as error:
        raise _refusal(document, problems, error.errors(include_url=False)) from None
    if problems:
        raise SceneError(problems)
    return scene


def _of_version(document: Document) -> Iterator[Problem]:
    version = document.root.data.get("tallgrass")
    if "tallgrass" not in document.root.data:
        yield document.problem((), FIRST)
    elif not _is_whole(version):
        yield document.problem(("tallgrass",), f"tallgrass must be the number {FORMAT}, found {in_words(version)}")


def upgraded(document: Document, /) -> dict[str, Any]:
    """Return the values of a file in the newest format. Raises SceneError for an unknown format."""
    values: dict[str, Any] = document.root.data
    version = values.get("tallgrass")
    try:
        return upgrade(values, version if _is_whole(version) else FORMAT)
    except ValueError as error:
        raise SceneError([*document.problems, document.problem(("tallgrass",), str(error))]) from error


def _is_whole(version: object) -> TypeGuard[int]:
    return isinstance(version, int) and not isinstance(version, bool)


def _refusal(document: Document, problems: list[Problem], errors: list[ErrorDetails]) -> SceneError:
    reported = {(problem.line, problem.column) for problem in document.problems}
    new = [_problem(document, error) for error in errors[:MOST_PROBLEMS]]
    problems += [problem for problem in new if (problem.line, problem.column) not in reported]
    return SceneError(problems, more=len(errors[MOST_PROBLEMS:]))


def _problem(document: Document, error: ErrorDetails) -> Problem:
    where: Where = error["loc"]
    field = field_at(document.root, where)
    reason = error.get("ctx", {}).get("error")
    if isinstance(reason, DeclarationError):
        where = (*where, *reason.where)
    return document.problem(where, sentence(error, field), at_key=error["type"] == "extra_forbidden")


def field_at(root: Node, where: Where, /) -> Field:
    """Return the field at a path of pydantic's errors; marks of unions and unknown keys in the path are skipped."""
    field, entry, node = Field("the scene", Scene, model=Scene), False, root
    for step in where:
        if isinstance(step, int):
            field = inside(field, f"item {step + 1} of {field.name}")
        elif entry:
            field, entry = inside(field, step), False
        elif field.model is not None and step in field.model.model_fields:
            field = declared(step, field.model.model_fields[step])
            entry = get_origin(field.annotation) is dict
        node = node.below.get(step, node)
        if isinstance(step, int) and field.model is WindPrimitive:
            field = replace(field, model=_kind(node))
    return field


def _kind(node: Node) -> type[WindPrimitive]:
    kind = node.data.get("kind") if isinstance(node.data, dict) else None
    try:
        return wind_kinds().find(kind) if isinstance(kind, str) else WindPrimitive
    except ValueError:
        return WindPrimitive


def changed(part: Model, values: Mapping[str, object], /, *, name: str) -> Model:
    """Return a part of a scene, called `name`, with some values replaced.

    Raises ValueError with a sentence for each invalid value.
    """
    try:
        return type(part).model_validate(part.model_dump() | dict(values))
    except ValidationError as error:
        raise ValueError(errors_in_words(error, type(part), name)) from error


def changed_kind(scene: Scene, name: str, values: Mapping[str, object], /) -> GrassKind:
    """Return a kind of a scene's grass with some values replaced; a `head` is merged into the present one.

    Raises SceneError with a problem for each invalid value, by the path of its key.
    """
    kind = scene.grass[name]
    old = {key: getattr(kind, key) for key in GrassKind.model_fields if key in kind.model_fields_set}
    head = values.get("head")
    if isinstance(head, Mapping) and kind.head is not None:
        old["head"] = {key: getattr(kind.head, key) for key in kind.head.model_fields_set} | dict(head)
        values = {key: value for key, value in values.items() if key != "head"}
    whole = {"tallgrass": scene.tallgrass, "grass": {name: old | dict(values)}, "quality": scene.quality}
    return validate(values_document(whole)).grass[name]
