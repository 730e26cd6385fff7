"""Programs composed from the package's shader files."""

import re
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from importlib import import_module
from importlib.resources import files
from typing import Any, NamedTuple

import moderngl

from .emit import emitted

_INCLUDE = re.compile(r'\s*#include\s+"([^"]+)"')
_WORD = re.compile(r"\w+")
_PLACE = re.compile(r"\b\d+:(\d+)\b|\b\d+\((\d+)\)")
PACKAGE = "tallgrass"
_VERSION = "#version 330 core"

Line = tuple[str, int, str]
"""File name, line number, text."""


class Texts(NamedTuple):
    """What a driver makes a program of."""

    vertex: str
    fragment: str


class ShaderError(RuntimeError):
    """A shader file is missing or does not compile; the message names its file and line."""


@lru_cache(maxsize=64)
def _read(name: str) -> tuple[str, ...]:
    """Return the lines of a shader file: one of `lib/`, or else one named by its path inside the package.

    Of a module of Python they are its `GLSL`.
    """
    if name.endswith(".py"):
        return tuple(emitted(import_module(f"{PACKAGE}.{name[:-3].replace('/', '.')}").GLSL).splitlines())
    source = files(PACKAGE).joinpath("engine/shaders/" + name if name.startswith("lib/") else name)
    if not source.is_file():
        raise ShaderError(f"there is no shader file '{name}'")
    return tuple(source.read_text("utf-8").splitlines())


@lru_cache(maxsize=256)
def _parts(name: str, made: frozenset[str]) -> tuple[tuple[str, str, tuple[Line, ...]], ...]:
    """Return what a shader consists of: stretches of files, as text and lines, each after a file of `made` or none.

    It is the same for every context and all defines, and a scene needs many programs.
    """
    places = [""]
    stretches: list[list[Line]] = [[]]
    seen: set[str] = set()

    def gather(file: str) -> None:
        seen.add(file)
        if file in made:
            places.append(file)
            stretches.append([])
            return
        for number, text in enumerate(_read(file), 1):
            included = _INCLUDE.match(text)
            if included is None:
                stretches[-1].append((file, number, text))
            elif included[1] not in seen:
                gather(included[1])

    gather(name)
    return tuple((place, _text(lines), tuple(lines)) for place, lines in zip(places, stretches, strict=True))


@lru_cache(maxsize=256)
def _words(name: str, made: frozenset[str]) -> frozenset[str]:
    """Return every word of a shader."""
    return frozenset(_WORD.findall("".join(text for _, text, _ in _parts(name, made))))


def _text(lines: Iterable[Line]) -> str:
    return "".join(text + "\n" for _, _, text in lines)


def compose(
    name: str,
    defines: Mapping[str, str | int] | None = None,
    made: Mapping[str, Sequence[Line]] | None = None,
) -> tuple[str, list[Line]]:
    """Return a shader's source with every include in place once, and where each of its lines comes from.

    `made` has lines that stand in place of some files, and in which nothing is included. Of `defines` the source has
    those that it names: the driver knows it again, whatever others there are.
    """
    given = made or {}
    words = _words(name, frozenset(given)).union(_WORD.findall(_text(line for each in given.values() for line in each)))
    told = ((key, value) for key, value in (defines or {}).items() if key in words)
    lines: list[Line] = [(name, 0, text) for text in (_VERSION, *(f"#define {key} {value}" for key, value in told))]
    source = _text(lines)
    for place, text, stretch in _parts(name, frozenset(given)):
        stands = given.get(place, ())
        source += _text(stands) + text
        lines += [*stands, *stretch]
    return source, lines


def locate(message: str, lines: list[Line]) -> str:
    """Return a driver's message with the places of its composed source put back to files and lines."""

    def place(match: re.Match[str]) -> str:
        number = int(match[1] or match[2])
        if not 1 <= number <= len(lines):
            return match[0]
        name, line, _ = lines[number - 1]
        return f"{name}:{line}"

    return _PLACE.sub(place, message)


def texts(vertex: str, fragment: str, defines: Mapping[str, str | int]) -> Texts:
    """Return what a driver is given of a program of two shader files."""
    return Texts(compose(vertex, defines)[0], compose(fragment, defines)[0])


def program(
    ctx: moderngl.Context,
    vertex: str,
    fragment: str | None,
    *,
    defines: Mapping[str, str | int] | None = None,
    varyings: tuple[str, ...] = (),
    made: Mapping[str, Sequence[Line]] | None = None,
) -> moderngl.Program:
    """Return the program of two shader files; raises `ShaderError` with the file and line of what fails.

    `made` has lines that stand in place of some included files.
    """
    sources = {name: compose(name, defines, made) for name in (vertex, fragment) if name is not None}
    try:
        compiled = ctx.program(
            vertex_shader=sources[vertex][0],
            fragment_shader=None if fragment is None else sources[fragment][0],
            varyings=varyings,
        )
        compiled.extra = {}  # by name, what it was told last and the uniform
    except moderngl.Error as error:
        stage = fragment if fragment is not None and "fragment_shader" in str(error) else vertex
        raise ShaderError(locate(str(error), sources[stage][1])) from error
    return compiled


ALL = ""
"""By what a program knows the names of all that it asks for."""


def tell(program: moderngl.Program, name: str, *value: float) -> None:
    """Tell a program a number or a vector, if it asks for it and was not told the same before."""
    told = program.extra.get(name) or _asked(program, name)
    if told[0] != value:
        told[0] = value
        if told[1] is not None:
            told[1].value = value if len(value) > 1 else value[0]


def tell_asked(program: moderngl.Program, *numbers: Mapping[str, tuple[float, ...]]) -> frozenset[str]:
    """Tell a program those of some numbers and vectors that it asks for, and return all names it asks for."""
    asked = program.extra.get(ALL)
    if asked is None:
        uniforms = frozenset(name for name in program if isinstance(program[name], moderngl.Uniform))
        asked = program.extra[ALL] = [uniforms, None]
    for each in numbers:
        for name in asked[0] & each.keys():
            tell(program, name, *each[name])
    return frozenset(asked[0])


Due = list[tuple[list[Any], object, bytes]]
"""What a program is to be told: what it was told last and the uniform; what it is told, and that in bytes."""


def due(program: moderngl.Program, *numbers: Mapping[str, tuple[float, ...]]) -> Due:
    """Tell a program those of some numbers and vectors that it asks for, and return them for `tell_due`.

    So they are looked for and packed once.
    """
    found = Due()
    for each in numbers:
        for name in sorted(tell_asked(program) & each.keys()):
            tell(program, name, *each[name])
            told = program.extra[name]
            found.append((told, each[name], told[1].read()))
    return found


def due_all(program: moderngl.Program, name: str, values: Sequence[tuple[float, ...]]) -> Due:
    """Tell a program an array of vectors, and return it likewise."""
    tell_all(program, name, values)
    told = program.extra[name]
    return [] if told[1] is None else [(told, values, told[1].read())]


def tell_due(numbers: Due) -> None:
    """Tell a program what it was not told the same before."""
    for told, value, packed in numbers:
        if told[0] != value:
            told[0] = value
            told[1].write(packed)


def _asked(program: moderngl.Program, name: str) -> list[Any]:
    """Return what a program was told last by a name, nothing yet, and what takes it, if it asks."""
    asked = program.get(name, None)  # `in` would go through all of its names
    program.extra[name] = found = [None, asked if isinstance(asked, moderngl.Uniform) else None]
    return found


def tell_all(program: moderngl.Program, name: str, values: Sequence[float] | Sequence[tuple[float, ...]]) -> None:
    """Tell a program an array of numbers or vectors, as much of it as it asks for: what is never read is left out."""
    told = program.extra.get(name) or _asked(program, name)
    if told[1] is not None and told[0] != values:
        told[0], room = values, told[1].array_length
        told[1].value = [*values, *[values[-1]] * room][:room] if room > 1 else values[0]
