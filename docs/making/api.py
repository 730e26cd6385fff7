"""The page of public names: what each is, read from the source, in an order to read them in."""

import ast
import inspect
import re
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from types import ModuleType

import tallgrass
import tallgrass.testing
from tallgrass import WindPrimitive

BESIDE_WINDS = ("Extent", "Grass", "Hover", "Pose", "Shape", "TwinValues", "wind")
"""Names with which a wind is written, in addition to its base class."""

LONGEST = 100
"""Characters of a signature on one line; longer ones have a line for each parameter."""

Part = ast.ClassDef | ast.FunctionDef | ast.AnnAssign | ast.Assign


def api() -> str:
    """Return an entry for every public name of `tallgrass`, as Markdown."""
    names = [name for name in tallgrass.__all__ if not inspect.ismodule(getattr(tallgrass, name))]
    winds = [name for name in names if inspect.isclass(thing := getattr(tallgrass, name)) and _is_wind(thing)]
    winds.sort(key=lambda name: sum(each.__name__ in tallgrass.__all__ for each in getattr(tallgrass, name).__mro__))
    winds += [name for name in names if name in BESIDE_WINDS]
    rest = [name for name in names if name not in winds and name != "Prairie"]
    return _page("## A prairie", tallgrass, ["Prairie", *rest]) + "\n" + _page("## Winds", tallgrass, winds)


def testing() -> str:
    """Return an entry for every public name of `tallgrass.testing` alone, as Markdown."""
    names = [name for name in tallgrass.testing.__all__ if name not in tallgrass.__all__]
    told = inspect.getdoc(tallgrass.testing) or ""
    return f"{told}\n\n{_page('', tallgrass.testing, names).lstrip()}"


def _is_wind(thing: type) -> bool:
    return issubclass(thing, WindPrimitive)


def _page(title: str, face: ModuleType, names: list[str]) -> str:
    homes = dict(_homes(face))
    entries = [line for name in names for line in _entry(name, *_found(name, homes[name]))]
    return "\n\n".join([title, *entries]) + "\n"


def _homes(face: ModuleType) -> Iterator[tuple[str, ModuleType]]:
    """Yield the names that a package brings from its modules, and the modules."""
    for node in ast.walk(_parsed(face)):
        if isinstance(node, ast.ImportFrom) and node.level:
            for name in node.names:
                inside = "." * node.level + (node.module or "")
                yield name.name, import_module(inside, face.__name__)


def _parsed(module: ModuleType) -> ast.Module:
    return ast.parse(Path(str(module.__file__)).read_text("utf-8"))


def _found(name: str, home: ModuleType) -> tuple[Part, str]:
    """Return where a module defines a name, or the module that it has it from, and what is said of it."""
    for part, told in _parts(_parsed(home).body):
        if name == _name(part):
            return part, told
    return _found(name, dict(_homes(home))[name])


def _parts(body: list[ast.stmt]) -> Iterator[tuple[Part, str]]:
    """Yield the public definitions in a body that have docstrings, with these."""
    for node, after in zip(body, [*body[1:], ast.Pass()], strict=True):
        told = ""
        if isinstance(node, ast.ClassDef | ast.FunctionDef):
            told = ast.get_docstring(node) or ""
        elif isinstance(node, ast.AnnAssign | ast.Assign) and isinstance(after, ast.Expr):
            told = inspect.cleandoc(str(ast.literal_eval(after.value)))
        if told and isinstance(node, Part) and not _name(node).startswith("_"):
            yield node, told


def _name(part: Part) -> str:
    if isinstance(part, ast.ClassDef | ast.FunctionDef):
        return part.name
    return ast.unparse(part.target if isinstance(part, ast.AnnAssign) else part.targets[0])


def _entry(name: str, part: Part, told: str) -> Iterator[str]:
    """Yield the paragraphs of a public name."""
    yield f"### {name}"
    if isinstance(part, ast.FunctionDef):
        yield _signature(part, name)
    yield told
    if isinstance(part, ast.ClassDef):
        bases = [each for each in map(ast.unparse, part.bases) if each in tallgrass.__all__]
        if bases:
            yield f"It derives from {', '.join(f'[`{each}`](#{each.lower()})' for each in bases)}."
        yield from _members(name, [part, *_hidden_bases(getattr(tallgrass, name, object))])


def _hidden_bases(thing: type) -> Iterator[ast.ClassDef]:
    """Yield the bases that are ours and that no entry tells of: their members are the class's."""
    told = [base for base in thing.__mro__[1:] if base.__name__ in tallgrass.__all__]
    for base in thing.__mro__[1:]:
        if base.__module__.startswith("tallgrass.") and not any(issubclass(each, base) for each in told):
            parsed = _parsed(import_module(base.__module__))
            yield from (each for each in parsed.body if isinstance(each, ast.ClassDef) and each.name == base.__name__)


def told_of_bases(thing: type, /) -> set[str]:
    """Return the members of a class that the entries of its bases tell of."""
    return {name for base in thing.__mro__[1:] if base.__name__ in tallgrass.__all__ for name in vars(base)}


def _members(owner: str, parts: list[ast.ClassDef]) -> Iterator[str]:
    """Yield the paragraphs of a class, in as many parts as it has: fields and properties, and then methods."""
    members = [each for part in parts for each in _parts(part.body) if not isinstance(each[0], ast.ClassDef)]
    values = [_value(each, told) for each, told in members if _is_value(each)]
    if values:
        yield "\n".join(values)
    inherited = told_of_bases(getattr(tallgrass, owner, object))
    for each, told in members:
        if isinstance(each, ast.FunctionDef) and not _is_value(each) and each.name not in inherited:
            yield f"#### {owner}.{each.name}"
            yield _signature(each, each.name, method=True)
            yield told


def _is_value(part: Part) -> bool:
    return not isinstance(part, ast.FunctionDef) or any("property" in ast.unparse(each) for each in part.decorator_list)


def _value(part: Part, told: str) -> str:
    """Return a field or property as an item of a list."""
    kind, default = "", ""
    if isinstance(part, ast.FunctionDef):
        kind = _kind(part.returns) if part.returns else ""
    elif isinstance(part, ast.AnnAssign):
        kind, default = _kind(part.annotation), _default(part.value)
    elif isinstance(part, ast.Assign):
        default = _default(part.value)
    declared = f"{_name(part)}{f': {kind}' if kind else ''}{f' = {default}' if default else ''}"
    return f"- `{declared}`: {_indented(told)}"


def _default(value: ast.expr | None) -> str:
    """Return a default as it is written, that of a declared field without its bounds; nothing where it is made."""
    if isinstance(value, ast.Call) and ast.unparse(value.func) in {"Field", "field"}:
        value = next((each.value for each in value.keywords if each.arg == "default"), None)
    return "" if value is None else ast.unparse(value)


def _indented(told: str) -> str:
    return re.sub(r"\n(?=.)", "\n  ", told)


def _signature(part: ast.FunctionDef, name: str, *, method: bool = False) -> str:
    """Return how a function is called, as a block of code."""
    arguments = part.args
    if method and not any(ast.unparse(each) == "staticmethod" for each in part.decorator_list):
        (arguments.posonlyargs or arguments.args).pop(0)
    taken = list(_arguments(arguments))
    result = f" -> {_kind(part.returns)}" if part.returns else ""
    line = f"{name}({', '.join(taken)}){result}"
    if len(line) > LONGEST:
        line = f"{name}(\n{''.join(f'    {each},{chr(10)}' for each in taken)}){result}"
    return f"```python\n{line}\n```"


def _arguments(arguments: ast.arguments) -> Iterator[str]:
    """Yield the parameters of a signature, as they are written."""
    positional = [*arguments.posonlyargs, *arguments.args]
    defaults = [None] * (len(positional) - len(arguments.defaults)) + list(arguments.defaults)
    for number, (each, default) in enumerate(zip(positional, defaults, strict=True), 1):
        yield _argument(each, default)
        if number == len(arguments.posonlyargs):
            yield "/"
    if arguments.vararg:
        yield f"*{_argument(arguments.vararg, None)}"
    elif arguments.kwonlyargs:
        yield "*"
    for each, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        yield _argument(each, default)


def _argument(each: ast.arg, default: ast.expr | None) -> str:
    kind = f": {_kind(each.annotation)}" if each.annotation else ""
    return f"{each.arg}{kind}" + (f" = {ast.unparse(default)}" if default is not None else "")


def _kind(annotation: ast.expr) -> str:
    """Return an annotation as it is written, without the quotes of one that names what comes later."""
    return ast.unparse(annotation).strip("'")
