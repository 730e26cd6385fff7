"""The page of public names: what each is, read from the source, in an order to read them in."""

import inspect
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from types import ModuleType

import griffe

import tallgrass
import tallgrass.testing
from tallgrass import WindPrimitive

BESIDE_WINDS = ("Extent", "Grass", "Hover", "Pose", "Shape", "TwinValues", "wind")
"""Names with which a wind is written, in addition to its base class."""

LONGEST = 100
"""Characters of a signature on one line; longer ones have a line for each parameter."""

Part = griffe.Object | griffe.Alias


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
    entries = [line for name in names for line in _entry(name, _found(_home(face, name), name))]
    return "\n\n".join([title, *entries]) + "\n"


def _home(face: ModuleType, name: str) -> str:
    """Return the module that defines a name which a package brings."""
    thing = getattr(face, name)
    inside = (each for each in sys.modules if each.startswith(face.__name__ + "."))
    return getattr(thing, "__module__", None) or next(each for each in inside if hasattr(sys.modules[each], name))


def _found(module: str, name: str) -> Part:
    """Return what the source of a module says of a name."""
    return _read(module).members[name]


@cache
def _read(module: str) -> griffe.Module:
    file = Path(str(sys.modules[module].__file__))
    return griffe.visit(module, file, file.read_text("utf-8"))


def _entry(name: str, part: Part) -> Iterator[str]:
    """Yield the paragraphs of a public name."""
    yield f"### {name}"
    if isinstance(part, griffe.Function):
        yield _signature(part)
    yield _told(part)
    if isinstance(part, griffe.Class):
        bases = [each for each in map(str, part.bases) if each in tallgrass.__all__]
        if bases:
            yield f"It derives from {', '.join(f'[`{each}`](#{each.lower()})' for each in bases)}."
        yield from _members(name, [part, *_hidden_bases(getattr(tallgrass, name, object))])


def _told(part: Part) -> str:
    return part.docstring.value if part.docstring else ""


def _hidden_bases(thing: type) -> Iterator[Part]:
    """Yield the bases that are ours and that no entry tells of: their members are the class's."""
    told = [base for base in thing.__mro__[1:] if base.__name__ in tallgrass.__all__]
    for base in thing.__mro__[1:]:
        if base.__module__.startswith("tallgrass.") and not any(issubclass(each, base) for each in told):
            yield _found(base.__module__, base.__name__)


def told_of_bases(thing: type, /) -> set[str]:
    """Return the members of a class that the entries of its bases tell of."""
    return {name for base in thing.__mro__[1:] if base.__name__ in tallgrass.__all__ for name in vars(base)}


def _members(owner: str, parts: list[Part]) -> Iterator[str]:
    """Yield the paragraphs of a class, in as many parts as it has: fields and properties, and then methods."""
    members = [each for part in parts for each in part.members.values() if each.name[0] != "_" and each.docstring]
    values = [_value(each) for each in members if isinstance(each, griffe.Attribute)]
    if values:
        yield "\n".join(values)
    inherited = told_of_bases(getattr(tallgrass, owner, object))
    for each in members:
        if isinstance(each, griffe.Function) and each.name not in inherited:
            yield f"#### {owner}.{each.name}"
            yield _signature(each)
            yield _told(each)


def _value(part: griffe.Attribute) -> str:
    """Return a field or property as an item of a list; the default of a declared field is without its bounds."""
    default = part.value if "class-attribute" in part.labels else None
    if isinstance(default, griffe.ExprCall) and str(default.function) in {"Field", "field"}:
        keywords = [each for each in default.arguments if isinstance(each, griffe.ExprKeyword)]
        default = next((each.value for each in keywords if each.name == "default"), None)
    of_class = default is not None and "instance-attribute" not in part.labels  # griffe takes ClassVar off
    kind = f": ClassVar[{part.annotation}]" if of_class else f": {part.annotation}" if part.annotation else ""
    value = f" = {default}" if default is not None else ""
    return f"- `{part.name}{kind}{value}`: " + re.sub(r"\n(?=.)", "\n  ", _told(part))


def _signature(part: griffe.Function) -> str:
    """Return how a function is called, as a block of code."""
    line = part.signature()
    if len(line) > LONGEST:
        name, _, rest = line.partition("(")
        taken, _, result = rest.rpartition(")")
        lines = re.split(r", (?=\w+:|[*/])", taken)
        line = f"{name}(\n{''.join(f'    {each},{chr(10)}' for each in lines)}){result}"
    return f"```python\n{line}\n```"
