"""Public names and their interfaces: `python -m docs.making.public` records them in docs/public.json."""

import inspect
import json
import re
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any, cast

import typer

import tallgrass
import tallgrass.testing
from tallgrass.app.cli import app
from tallgrass.engine.plugged import SYSTEMS
from tallgrass.engine.plugins import GROUP

from .reference import public_keys

ROOT = Path(__file__).parents[2]
RECORD = ROOT / "docs" / "public.json"
Public = dict[str, str]
"""Interface of each public name, by its kind and name, such as `face: Prairie.draw(view)`."""

SOURCES = ("app", "components", "engine", "systems", "testing")
GIVEN = {"Clock", "GrassAt", "Heard", "Lod", "Patch", "Prairie", "Receivers", "Stage", "Viewer"}
"""Classes that programs are given and do not make: their constructors are not public."""

KEYS = {"bench": "measures.md", "film": "farm.md"}
"""The pages whose tables name the keys of JSON, by the command that prints it."""


def public() -> Public:
    """Return everything that is public now."""
    rows = [*_face("face", tallgrass), *_face("testing", tallgrass.testing)]
    rows += [(f"scene: {name}", told) for name, told in public_keys()]
    rows += _commands(typer.main.get_command(app), "")
    rows += [(f"json of {command}: {key}", "key") for command, page in KEYS.items() for key in _told(page)]
    rows += [(f"entry points: {group}", "group") for group in (GROUP, SYSTEMS)]
    texts = (file.read_text("utf-8") for folder in SOURCES for file in (ROOT / folder).rglob("*.py"))
    rows += [(f"environment: {name}", "variable") for text in texts for name in re.findall(r"\bTALLGRASS_\w+", text)]
    return dict(sorted(rows))


def recorded() -> Public:
    """Return what has been recorded as public."""
    return cast("Public", json.loads(RECORD.read_text("utf-8")))


def record() -> None:
    """Record the public names of this version, and print those that are gone, changed and new."""
    before, now = recorded() if RECORD.is_file() else {}, public()
    for line in [*broken(before, now), *(f"{name} is new" for name in now if name not in before)]:
        print(line)
    RECORD.write_text(json.dumps(now, indent=0) + "\n", "utf-8")


def broken(before: Public, now: Public, /) -> list[str]:
    """Return the changes that break programs written before, a sentence each."""
    told = [f"{name} is gone" for name in before if name not in now]
    told += [f"{name} was {was}, and is {now[name]}" for name, was in before.items() if now.get(name, was) != was]
    asked = [name for name, what in now.items() if "(" in name and "required" in what and name not in before]
    return told + [f"{name} has to be given now" for name in asked if name.partition("(")[0] in before]


def _face(kind: str, face: ModuleType) -> Iterator[tuple[str, str]]:
    for name in face.__all__:
        thing = getattr(face, name)
        if kind == "testing" and name in tallgrass.__all__:
            continue
        yield (
            f"{kind}: {name}",
            "class" if inspect.isclass(thing) else "module" if inspect.ismodule(thing) else "function",
        )
        if callable(thing) and name not in GIVEN:
            yield from _parameters(f"{kind}: {name}", thing)
        if inspect.isclass(thing):
            yield from _members(f"{kind}: {name}", thing)


def _members(owner: str, thing: type) -> Iterator[tuple[str, str]]:
    """Yield the fields, properties and methods of a class, also those that it has from bases of ours."""
    for base in reversed([base for base in inspect.getmro(thing) if base.__module__.startswith("tallgrass")]):
        for name in vars(base).get("__annotations__", {}):
            if not name.startswith("_"):
                yield f"{owner}.{name}", "field"
        for name, value in vars(base).items():
            plain = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            if name.startswith(("_", "model_")):
                continue
            if isinstance(plain, property):
                yield f"{owner}.{name}", "property" if plain.fset is None else "property that may be set"
            elif inspect.isfunction(plain) and "validator" not in repr(type(value)):
                yield f"{owner}.{name}", "method"
                yield from _parameters(f"{owner}.{name}", getattr(thing, name))


def _parameters(owner: str, thing: Any) -> Iterator[tuple[str, str]]:
    try:
        found = inspect.signature(thing).parameters.values()
    except ValueError:  # an exception that says no more than its base
        return
    for each in found:
        if each.name != "self" and each.kind not in {each.VAR_KEYWORD, each.VAR_POSITIONAL}:
            plain = isinstance(each.default, str | int | float | tuple | list | None)
            default = (
                "required" if each.default is each.empty else f"{each.default!r} unless told" if plain else "optional"
            )
            yield f"{owner}({each.name})", f"{each.kind.description}, {default}"


def _commands(command: Any, path: str) -> Iterator[tuple[str, str]]:
    for each in command.params:
        name = max(each.opts, key=len) if each.param_type_name == "option" else (each.metavar or each.name.upper())
        if path:
            yield f"commands: {path} {name}", f"{each.param_type_name}{', required' if each.required else ''}"
    for name, inner in getattr(command, "commands", {}).items():
        inside = f"{path} {name}".strip()
        yield f"commands: {inside}", "command"
        yield from _commands(inner, inside)


def _told(page: str) -> Iterator[str]:
    """Yield the keys that a page's tables of keys tell of: those headed `key` and `is`."""
    text = (ROOT / "docs" / page).read_text("utf-8")
    for table in re.findall(r"^\| key \| is \|\n\|---\|---\|\n((?:\|.*\n)+)", text, re.MULTILINE):
        for row in table.splitlines():
            yield from re.findall(r"`(\w+)`", row.split("|")[1])


if __name__ == "__main__":
    record()
