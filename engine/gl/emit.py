"""What Python tells shaders: numbers that are written once, in a module of Python, and emitted as GLSL by name.

A shader takes them by `#include "systems/light/color.py"`: they are that module's `GLSL`, a mapping of names to
numbers, or lines of GLSL.
"""

from collections.abc import Mapping

Number = float | int | tuple[float, ...]


def emitted(numbers: Mapping[str, Number] | str, /) -> str:
    """Return GLSL that declares numbers by name; GLSL itself stays as it is.

    A float is a `const float`, two to four of them are a `const vec2` to `vec4`, and an int is a macro, so that
    conditions may ask it. Raises `ValueError` for any other count.
    """
    return numbers if isinstance(numbers, str) else "".join(_line(*each) for each in numbers.items())


def _line(name: str, number: Number) -> str:
    if isinstance(number, tuple):
        if not 2 <= len(number) <= 4:
            raise ValueError(f"{name} has {len(number)} numbers, and vectors of GLSL have 2 to 4")
        kind = f"vec{len(number)}"
        return f"const {kind} {name} = {kind}({', '.join(repr(float(each)) for each in number)});\n"
    return f"#define {name} {number}\n" if isinstance(number, int) else f"const float {name} = {number!r};\n"
