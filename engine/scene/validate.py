"""From a scene's values to its `Scene`, or to every problem they have."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeGuard, get_origin

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ...components.declaration import DeclarationError
from ...components.field import Field, declared, inside
from ...components.wind import WindPrimitive
from ...components.words import found, sentence
from ..declared.scene import FORMAT, Reading, Scene
from ..plugins import wind_kinds
from .document import Document, Node, Where
from .problem import MOST_PROBLEMS, Problem, SceneError
from .version import FIRST, upgrade


def validate(document: Document, /, *, folder: Path | None = None, also: Iterable[Problem] = ()) -> Scene:
    """Return the scene of a file. Raises SceneError with every problem of the file, those in `also` among them.

    Files that winds name are relative to `folder`, and are read only where there is one.
    """
    if not isinstance(document.root.data, dict):
        message = f"{FIRST}, then its keys; this is {found(document.root.data)}"
        raise SceneError([*document.problems, document.problem((), message)])
    problems = [*document.problems, *also, *_of_version(document)]
    values = upgraded(document)
    find = wind_kinds().find
    reading = Reading(wind=find) if folder is None else Reading(wind=find, folder=folder)
    try:
        scene = Scene.model_validate(values | {"tallgrass": FORMAT}, context=reading)
    except ValidationError as error:
        raise _refusal(document, problems, error.errors(include_url=False)) from error
    if problems:
        raise SceneError(problems)
    return scene


def _of_version(document: Document) -> Iterator[Problem]:
    version = document.root.data.get("tallgrass")
    if "tallgrass" not in document.root.data:
        yield document.problem((), FIRST)
    elif not _is_whole(version):
        yield document.problem(("tallgrass",), f"tallgrass must be the number {FORMAT}, found {found(version)}")


def upgraded(document: Document, /) -> dict[str, Any]:
    """Return the values of a file as the newest format has them. Raises SceneError for a format that there is not."""
    values: dict[str, Any] = document.root.data
    version = values.get("tallgrass")
    try:
        return upgrade(values, version if _is_whole(version) else FORMAT)
    except ValueError as error:
        raise SceneError([*document.problems, document.problem(("tallgrass",), str(error))]) from error


def _is_whole(version: object) -> TypeGuard[int]:
    return isinstance(version, int) and not isinstance(version, bool)


def _refusal(document: Document, problems: list[Problem], errors: list[ErrorDetails]) -> SceneError:
    told = {(problem.line, problem.column) for problem in document.problems}
    new = [_problem(document, error) for error in errors[:MOST_PROBLEMS]]
    problems += [problem for problem in new if (problem.line, problem.column) not in told]
    return SceneError(problems, more=len(errors[MOST_PROBLEMS:]))


def _problem(document: Document, error: ErrorDetails) -> Problem:
    where: Where = error["loc"]
    field = field_at(document.root, where)
    reason = error.get("ctx", {}).get("error")
    if isinstance(reason, DeclarationError):
        where = (*where, *reason.where)
    return document.problem(where, sentence(error, field), at_key=error["type"] == "extra_forbidden")


def field_at(root: Node, where: Where, /) -> Field:
    """Return the field at `where`, a way as pydantic gives it: marks of a union and unknown keys are skipped."""
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
