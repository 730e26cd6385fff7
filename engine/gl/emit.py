"""Emitting GLSL from Python: constants that both languages share, structs and uniform blocks of record dtypes.

A shader includes a Python module as `#include "systems/light/color.py"`. That inserts the module's `GLSL`: a mapping of
names to constants, or GLSL text.
"""

from collections.abc import Mapping, Sequence

import numpy as np

Number = float | int | tuple[float, ...]


def emitted(numbers: Mapping[str, Number] | str, /) -> str:
    """Return GLSL that declares constants by name; GLSL text is returned unchanged.

    A float becomes a `const float`, two to four floats a `const vec2` to `vec4`, and an int a macro, so that `#if` can
    test it. Raises `ValueError` for any other count.
    """
    return numbers if isinstance(numbers, str) else "".join(_line(*each) for each in numbers.items())


def _line(name: str, number: Number) -> str:
    if isinstance(number, tuple):
        if not 2 <= len(number) <= 4:
            raise ValueError(f"{name} has {len(number)} numbers, and vectors of GLSL have 2 to 4")
        kind = f"vec{len(number)}"
        return f"const {kind} {name} = {kind}({', '.join(repr(float(each)) for each in number)});\n"
    return f"#define {name} {number}\n" if isinstance(number, int) else f"const float {name} = {number!r};\n"


def struct(name: str, record: np.dtype[np.void], /) -> str:
    """Return the GLSL struct of a record of float32 fields: numbers, vectors, and lists of vectors or of records."""
    return f"struct {name} {{\n{_members(record)}}};\n"


def block(name: str, record: np.dtype[np.void], /) -> str:
    """Return the GLSL of a record as a std140 uniform block, preceded by the structs of its nested records.

    Raises `ValueError` where a field's offset is not std140's.
    """
    structs, expected = "", 0
    for field in record.names or ():
        kind, offset = record[field], _offset(record, field)
        if kind.base.names:
            structs += struct(field.capitalize(), kind.base)
        expected += -expected % _alignment(kind)
        if expected != offset:
            raise ValueError(f"{name}.{field} is at {offset}, and std140 has it at {expected}")
        expected += kind.itemsize
    return f"{structs}layout(std140) uniform {name} {{\n{_members(record)}}};\n"


def record_lookup(name: str, record: np.dtype[np.void], sampler: str, per_row: int, /) -> str:
    """Return GLSL of a function `name_of(number)`, which reads a `Name` record from a texture of `per_row` in a row."""
    texels, values = record.itemsize // 16, []
    for field in record.names or ():
        texel, first = divmod(_offset(record, field) // 4, 4)
        count = record[field].itemsize // 4
        if first + count > 4:
            raise ValueError(f"{name}.{field} lies in two texels")
        values.append(f"part{texel}.{'xyzw'[first : first + count]}")
    fetched = "".join(
        f"    vec4 part{texel} = texelFetch({sampler}, at + ivec2({texel}, 0), 0);\n" for texel in range(texels)
    )
    return (
        f"{struct(name, record)}uniform sampler2D {sampler};\n{name} {name.lower()}_of(int number) {{\n"
        f"    ivec2 at = ivec2(number % {per_row} * {texels}, number / {per_row});\n{fetched}"
        f"    return {name}({', '.join(values)});\n}}\n"
    )


def _offset(record: np.dtype[np.void], field: str) -> int:
    fields = record.fields
    assert fields is not None
    return fields[field][1]


def _alignment(kind: np.dtype[np.void]) -> int:
    """Return the multiple of bytes that a field of a std140 block begins at: a number, a pair, or anything larger."""
    return 1 if _is_padding(kind) else {(): 4, (2,): 8}.get(kind.shape, 16)


_KINDS: Sequence[str] = ("float", "vec2", "vec3", "vec4")


def _members(record: np.dtype[np.void]) -> str:
    fields = ((name, record[name]) for name in record.names or ())
    return "".join(f"    {_member(name, kind)}\n" for name, kind in fields if not _is_padding(kind))


def _member(name: str, kind: np.dtype[np.void]) -> str:
    if kind.base.names:
        return f"{name.capitalize()} {name}[{kind.shape[0]}];"
    if kind.shape == (16,):
        return f"mat4 {name};"
    many = f"[{kind.shape[0]}]" if len(kind.shape) == 2 else ""
    return f"{_KINDS[(kind.shape[-1] if kind.shape else 1) - 1]} {name}{many};"


def _is_padding(kind: np.dtype[np.void]) -> bool:
    return kind.base.kind == "V" and not kind.base.names
