"""What comes through from vertices to pixels: never more than every OpenGL 3.3 takes, however many kinds there are."""

import re
from itertools import product

import pytest

from tallgrass.engine.declared.grass import MOST_KINDS
from tallgrass.engine.gl.shaders import compose

SURE = 60
"""GL_MAX_VARYING_COMPONENTS at least, in OpenGL 3.3."""

SIZES = {"float": 1, "int": 1, "vec2": 2, "vec3": 3, "vec4": 4, "mat4": 16}
VARYING = re.compile(r"(?:flat |noperspective )*in (\w+) \w+;")

Defines = dict[str, str | int]


def holds(condition: str, defines: Defines) -> bool:
    """Whether a condition of the preprocessor's does."""
    told = re.sub(r"defined\((\w+)\)", lambda match: str(match[1] in defines), condition)
    told = told.replace("||", " or ").replace("&&", " and ").replace("!", " not ")
    return bool(eval(told, {}, dict(defines)))  # noqa: S307 - our own shaders


def left(source: str, defines: Defines) -> list[str]:
    """The lines of a shader that its conditions leave."""
    lines, stack = [], [True]
    for line in source.splitlines():
        word, _, rest = line.partition(" ")
        if word in ("#if", "#ifdef", "#ifndef"):
            name = rest.split()[0]
            inside = holds(rest.split("//")[0], defines) if word == "#if" else (name in defines) == (word == "#ifdef")
            stack.append(inside)
        elif word == "#else":
            stack[-1] = not stack[-1]
        elif word == "#endif":
            stack.pop()
        elif all(stack):
            lines.append(line)
    return lines


def numbers(shader: str, kinds: int, conditions: set[str]) -> int:
    """How many numbers a fragment shader takes."""
    defines: Defines = {"KINDS": kinds, **dict.fromkeys(conditions, 1)}
    sizes = SIZES | {"ByKind": 4 * -(-kinds // 4)}
    found = [VARYING.match(line) for line in left(compose(shader, defines)[0], defines)]
    return sum(sizes[match[1]] for match in found if match is not None)


@pytest.mark.parametrize("kinds", [1, 4, 5, 9, MOST_KINDS])
@pytest.mark.parametrize(
    ("shader", "conditions"),
    [
        ("systems/show/carpet/ground.frag", ("CARPET", "HEADS", "MOWN", "TRODDEN")),
        ("systems/show/carpet/ground.frag", ("CARPET", "UNDER", "MOWN")),
        ("systems/show/strips/strips.frag", ("THIN", "MOWN")),
    ],
    ids=["carpet", "under", "strips"],
)
def test_pixels_take_no_more_numbers_than_are_sure_to_come_through(
    shader: str, conditions: tuple[str, ...], kinds: int
) -> None:
    for chosen in product(*(({name}, set[str]()) for name in conditions)):
        count = numbers(shader, kinds, set().union(*chosen))
        assert 0 < count <= SURE
