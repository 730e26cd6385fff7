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
    """Sources that a driver compiles and links to a program."""

    vertex: str
    fragment: str


class ShaderError(RuntimeError):
    """A shader file is missing or does not compile; the message names its file and line."""


@lru_cache(maxsize=64)
def _read(name: str) -> tuple[str, ...]:
    """Return the lines of a shader file: one of `lib/`, or else one named by its path inside the package.

    The lines of a Python module are its `GLSL`.
    """
    if name.endswith(".py"):
        return tuple(emitted(import_module(f"{PACKAGE}.{name[:-3].replace('/', '.')}").GLSL).splitlines())
    source = files(PACKAGE).joinpath("engine/shaders/" + name if name.startswith("lib/") else name)
    if not source.is_file():
        raise ShaderError(f"there is no shader file '{name}'")
    return tuple(source.read_text("utf-8").splitlines())


@lru_cache(maxsize=256)
def _parts(name: str, replaced: frozenset[str]) -> tuple[tuple[str, str, tuple[Line, ...]], ...]:
    """Return a shader's source with its includes in place, split at each file of `replaced`.

    Each part is the name of the replaced file before it ("" for the first part), its text, and its lines. Parts depend
    neither on the context nor on defines, so the many programs of a scene share them.
    """
    preceding = [""]
    parts: list[list[Line]] = [[]]
    seen: set[str] = set()

    def gather(file: str) -> None:
        seen.add(file)
        if file in replaced:
            preceding.append(file)
            parts.append([])
            return
        for number, text in enumerate(_read(file), 1):
            included = _INCLUDE.match(text)
            if included is None:
                parts[-1].append((file, number, text))
            elif included[1] not in seen:
                gather(included[1])

    gather(name)
    return tuple((file, _text(lines), tuple(lines)) for file, lines in zip(preceding, parts, strict=True))


@lru_cache(maxsize=256)
def _words(name: str, replaced: frozenset[str]) -> frozenset[str]:
    """Return every word of a shader's source, outside of the `replaced` files."""
    return frozenset(_WORD.findall("".join(text for _, text, _ in _parts(name, replaced))))


def _text(lines: Iterable[Line]) -> str:
    return "".join(text + "\n" for _, _, text in lines)


def compose(
    name: str,
    defines: Mapping[str, str | int] | None = None,
    made: Mapping[str, Sequence[Line]] | None = None,
) -> tuple[str, list[Line]]:
    """Return a shader's source with each include in place once, and the origin of each of its lines.

    `made` maps file names to lines that replace the file; includes in these lines are not resolved. The source gets
    only those `defines` whose names it contains, so that other defines do not make the driver's cache miss.
    """
    made = made or {}
    words = _words(name, frozenset(made)).union(_WORD.findall(_text(line for each in made.values() for line in each)))
    used = ((key, value) for key, value in (defines or {}).items() if key in words)
    lines: list[Line] = [(name, 0, text) for text in (_VERSION, *(f"#define {key} {value}" for key, value in used))]
    source = _text(lines)
    for file, text, part in _parts(name, frozenset(made)):
        replacement = made.get(file, ())
        source += _text(replacement) + text
        lines += [*replacement, *part]
    return source, lines


def locate(message: str, lines: list[Line]) -> str:
    """Return a driver's message with line numbers of the composed source replaced by file names and their lines."""

    def place(match: re.Match[str]) -> str:
        number = int(match[1] or match[2])
        if not 1 <= number <= len(lines):
            return match[0]
        name, line, _ = lines[number - 1]
        return f"{name}:{line}"

    return _PLACE.sub(place, message)


def texts(vertex: str, fragment: str, defines: Mapping[str, str | int]) -> Texts:
    """Return the composed sources of a program of two shader files."""
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
    """Return the program of two shader files; raises `ShaderError` with the file and line of an error.

    `made` maps names of included files to lines that replace them.
    """
    sources = {name: compose(name, defines, made) for name in (vertex, fragment) if name is not None}
    try:
        compiled = ctx.program(
            vertex_shader=sources[vertex][0],
            fragment_shader=None if fragment is None else sources[fragment][0],
            varyings=varyings,
        )
        compiled.extra = {}  # entries of uniforms by name: the value set last, and the uniform
    except moderngl.Error as error:
        stage = fragment if fragment is not None and "fragment_shader" in str(error) else vertex
        raise ShaderError(locate(str(error), sources[stage][1])) from error
    return compiled


ALL = ""
"""Key in a program's `extra` of the names of all its uniforms."""


def set_uniform(program: moderngl.Program, name: str, *value: float) -> None:
    """Set a uniform number or vector, if the program uses it and its value has changed."""
    entry = program.extra.get(name) or _entry(program, name)
    if entry[0] != value:
        entry[0] = value
        if entry[1] is not None:
            entry[1].value = value if len(value) > 1 else value[0]


def set_used_uniforms(program: moderngl.Program, *numbers: Mapping[str, tuple[float, ...]]) -> frozenset[str]:
    """Set those numbers and vectors that the program uses; return the names of all its uniforms."""
    used = program.extra.get(ALL)
    if used is None:
        uniforms = frozenset(name for name in program if isinstance(program[name], moderngl.Uniform))
        used = program.extra[ALL] = [uniforms, None]
    for each in numbers:
        for name in used[0] & each.keys():
            set_uniform(program, name, *each[name])
    return frozenset(used[0])


PackedUniforms = list[tuple[list[Any], object, bytes]]
"""Values for uniforms of one program: the uniform's entry in `extra`, its value, and the value's bytes."""


def pack(program: moderngl.Program, *numbers: Mapping[str, tuple[float, ...]]) -> PackedUniforms:
    """Set those numbers and vectors that the program uses; return them packed for `set_packed`.

    So they are looked up and packed once.
    """
    found = PackedUniforms()
    for each in numbers:
        for name in sorted(set_used_uniforms(program) & each.keys()):
            set_uniform(program, name, *each[name])
            entry = program.extra[name]
            found.append((entry, each[name], entry[1].read()))
    return found


def pack_array(program: moderngl.Program, name: str, values: Sequence[tuple[float, ...]]) -> PackedUniforms:
    """Set an array of vectors, if the program uses it; return it packed for `set_packed`."""
    set_uniform_array(program, name, values)
    entry = program.extra[name]
    return [] if entry[1] is None else [(entry, values, entry[1].read())]


def set_packed(numbers: PackedUniforms) -> None:
    """Set those uniforms whose values have changed."""
    for entry, value, packed in numbers:
        if entry[0] != value:
            entry[0] = value
            entry[1].write(packed)


def _entry(program: moderngl.Program, name: str) -> list[Any]:
    """Add a uniform's entry to the program's `extra`; return it: no value yet, and the uniform, None if unused."""
    member = program.get(name, None)  # `in` would go through all names of the program
    program.extra[name] = entry = [None, member if isinstance(member, moderngl.Uniform) else None]
    return entry


def set_uniform_array(
    program: moderngl.Program, name: str, values: Sequence[float] | Sequence[tuple[float, ...]]
) -> None:
    """Set an array of numbers or vectors, if the program uses it; drivers drop elements that are never read."""
    entry = program.extra.get(name) or _entry(program, name)
    if entry[1] is not None and entry[0] != values:
        entry[0], length = values, entry[1].array_length
        entry[1].value = [*values, *[values[-1]] * length][:length] if length > 1 else values[0]
