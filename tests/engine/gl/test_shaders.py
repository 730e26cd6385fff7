"""Programs composed from shader files, and compile errors that name file and line."""

import re
import sys
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path
from types import SimpleNamespace

import moderngl
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tallgrass.engine.gl import shaders
from tallgrass.engine.gl.emit import emitted
from tallgrass.engine.gl.shaders import (
    ShaderError,
    compose,
    locate,
    pack,
    pack_array,
    program,
    set_packed,
)

ROOT = Path(str(files("tallgrass")))
STAGES = sorted(
    path.relative_to(ROOT).as_posix() for stage in ("vert", "frag") for path in (ROOT / "systems").rglob(f"*.{stage}")
)
PARTS = sorted(entry.name for entry in files("tallgrass.engine.shaders.lib").iterdir() if entry.name.endswith(".glsl"))
PLAIN = {
    "plain.vert": ["void main() {", "    gl_Position = vec4(0.0);", "}"],
    "plain.frag": ["out vec4 pixel;", "void main() {", "    pixel = vec4(1.0);", "}"],
}


@pytest.fixture
def library(monkeypatch: pytest.MonkeyPatch) -> Iterator[dict[str, list[str]]]:
    """Shader files that exist in memory only."""
    sources = {name: list(lines) for name, lines in PLAIN.items()}
    monkeypatch.setattr(shaders, "_read", lambda name: tuple(sources[name]))
    shaders._parts.cache_clear()  # noqa: SLF001
    yield sources
    shaders._parts.cache_clear()  # noqa: SLF001


def test_there_are_shaders_to_try() -> None:
    assert {
        "systems/show/blades/blade.vert",
        "systems/show/blades/ribbon.vert",
        "systems/show/blades/blades.frag",
        "systems/show/strips/strips.vert",
        "systems/show/strips/strips.frag",
        "systems/show/carpet/ground.vert",
        "systems/show/carpet/ground.frag",
        "systems/show/carpet/under.vert",
        "systems/show/carpet/under.frag",
        "systems/show/carpet/carpet.vert",
        "systems/show/carpet/carpet.frag",
    } < set(STAGES)
    assert "light.glsl" in PARTS


@pytest.mark.parametrize("name", STAGES)
def test_every_part_is_included_once(name: str) -> None:
    source, lines = compose(name)
    assert source.startswith("#version 330 core\n")
    assert "#include" not in source
    where = [(file, line) for file, line, _ in lines if line > 0]
    assert len(where) == len(set(where))
    for file in {file for file, _ in where}:
        text = shaders._read(file)  # noqa: SLF001
        assert [line for other, line, _ in lines if other == file and line > 0] == [
            number for number, row in enumerate(text, 1) if not row.lstrip().startswith("#include")
        ]


def test_every_part_is_included_by_some_program() -> None:
    used = {file for name in STAGES for file, _, _ in compose(name)[1]}
    assert {f"lib/{part}" for part in PARTS} <= used


def test_parts_that_include_each_other_are_still_included_once(library: dict[str, list[str]]) -> None:
    library["a.glsl"] = ['#include "b.glsl"', "float a = 1.0;"]
    library["b.glsl"] = ['#include "a.glsl"', "float b = 2.0;"]
    library["plain.vert"][:0] = ['#include "a.glsl"', '#include "b.glsl"']
    text = [line for _, _, line in compose("plain.vert")[1]]
    assert text[:3] == ["#version 330 core", "float b = 2.0;", "float a = 1.0;"]


def test_definitions_follow_the_version_line() -> None:
    source, lines = compose("systems/light/sky.vert", {"UP": 3, "ACROSS": "5"})
    assert source.splitlines()[:3] == ["#version 330 core", "#define UP 3", "#define ACROSS 5"]
    assert [line for _, line, _ in lines[:3]] == [0, 0, 0]
    assert len(source.splitlines()) == len(lines)


def test_what_a_shader_does_not_name_is_not_defined_so_that_drivers_know_it_again() -> None:
    made = {"systems/wind/twins.glsl": [("twins.glsl", 1, "float x = MANY;")]}
    told = {"KINDS": 3, "NOBODY": 1}
    assert compose("systems/light/sky.frag", {"NOBODY": 1}) == compose("systems/light/sky.frag")
    assert "#define KINDS 3" in compose("systems/show/carpet/carpet.frag", told)[0]
    assert "#define MANY 2" in compose("systems/wind/hear.vert", {"MANY": 2}, made)[0]


def test_a_module_of_python_tells_shaders_its_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    numbers = {"MANY": 3, "PART": 0.25, "TINY": 1e-6, "WAY": (1.0, 2), "CURVE": (0.5, -1.0, 2.0)}
    monkeypatch.setitem(sys.modules, "tallgrass.systems.told", SimpleNamespace(GLSL=numbers))
    monkeypatch.setitem(sys.modules, "tallgrass.systems.said", SimpleNamespace(GLSL="float x;\n"))
    assert shaders._read("systems/told.py") == (  # noqa: SLF001
        "#define MANY 3",
        "const float PART = 0.25;",
        "const float TINY = 1e-06;",
        "const vec2 WAY = vec2(1.0, 2.0);",
        "const vec3 CURVE = vec3(0.5, -1.0, 2.0);",
    )
    assert shaders._read("systems/said.py") == ("float x;",)  # noqa: SLF001
    shaders._read.cache_clear()  # noqa: SLF001
    with pytest.raises(ValueError, match="WAY has 5 numbers, and vectors of GLSL have 2 to 4"):
        emitted({"WAY": (1.0,) * 5})


def test_a_missing_file_is_named() -> None:
    with pytest.raises(ShaderError, match=r"there is no shader file 'nowhere\.vert'"):
        compose("nowhere.vert")


@given(st.sampled_from(STAGES), st.data())
def test_any_line_that_a_driver_names_is_put_back_to_its_file(name: str, data: st.DataObject) -> None:
    _, lines = compose(name, {"KINDS": 1})
    number = data.draw(st.integers(1, len(lines)))
    file, line, _ = lines[number - 1]
    mesa, nvidia, apple = f"0:{number}(12): error: x", f"0({number}) : error C1: x", f"ERROR: 0:{number}: x"
    assert locate(mesa, lines) == f"{file}:{line}(12): error: x"
    assert locate(nvidia, lines) == f"{file}:{line} : error C1: x"
    assert locate(apple, lines) == f"ERROR: {file}:{line}: x"


def test_lines_that_are_not_ours_are_left_as_they_are() -> None:
    _, lines = compose("systems/light/sky.vert")
    message = f"0:0: x\n0:{len(lines) + 1}(3): y\nno line here"
    assert locate(message, lines) == message


def test_an_error_in_an_included_file_names_that_file_and_line(
    ctx: moderngl.Context, library: dict[str, list[str]]
) -> None:
    library["lib/one.glsl"] = ["", "float one() {", "    return oops;", "}"]
    library["plain.vert"][:0] = ["// a first line", '#include "lib/one.glsl"']
    with pytest.raises(ShaderError, match=r"lib/one\.glsl:3\b"):
        program(ctx, "plain.vert", "plain.frag", defines={"MANY": 2, "MORE": 3})


@pytest.mark.parametrize(("file", "line"), [("plain.vert", 2), ("plain.frag", 3)])
def test_an_error_names_the_stage_that_it_is_in(
    ctx: moderngl.Context, library: dict[str, list[str]], file: str, line: int
) -> None:
    library[file][line - 1] = "    oops = 1;"
    with pytest.raises(ShaderError, match=rf"{file}:{line}\b"):
        program(ctx, "plain.vert", "plain.frag")


def test_stages_that_do_not_fit_together_are_a_shader_error(
    ctx: moderngl.Context, library: dict[str, list[str]]
) -> None:
    library["plain.vert"][:] = ["out vec2 shade;", "void main() {", "    gl_Position.xy = shade = vec2(0.0);", "}"]
    library["plain.frag"][:] = ["in vec3 shade;", "out vec4 pixel;", "void main() {", "    pixel = shade.xyzz;", "}"]
    with pytest.raises(ShaderError):
        program(ctx, "plain.vert", "plain.frag")


def test_a_program_may_be_asked_what_it_computes(ctx: moderngl.Context, library: dict[str, list[str]]) -> None:
    library["twice.vert"] = ["in float x;", "out float y;", "void main() {", "    y = FACTOR * x;", "}"]
    made = program(ctx, "twice.vert", None, defines={"FACTOR": "2.0"}, varyings=("y",))
    numbers = np.arange(5, dtype=np.float32)
    source, result = ctx.buffer(numbers), ctx.buffer(reserve=20)
    array = ctx.vertex_array(made, [(source, "1f", "x")])
    array.transform(result, vertices=5)
    np.testing.assert_array_equal(np.frombuffer(result.read(), np.float32), 2.0 * numbers)
    for thing in (array, source, result, made):
        thing.release()


def test_lines_that_are_handed_in_stand_in_place_of_a_file(library: dict[str, list[str]]) -> None:
    library["plain.vert"][:0] = ['#include "a.glsl"']
    library["a.glsl"] = ["float a = 1.0;"]
    source, lines = compose("plain.vert", made={"a.glsl": [("mine.glsl", 7, "float b = 2.0;")]})
    assert "float a" not in source
    assert locate("0:2: error: x", lines) == "mine.glsl:7: error: x"


PLAIN_NUMBER = re.compile(r"(?<![\w.])(?:\d+\.\d*|\.\d+|\d+)(?:e[-+]?\d+)?u?(?![\w.])")
OWN_TABLE = "engine/shaders/lib/random.glsl"
"""Its numbers are the hash's own; tests compare them bit for bit with `engine/random.py`."""

SHADERS = [
    path.relative_to(ROOT).as_posix()
    for folder in ("app", "engine", "systems")
    for ending in ("glsl", "vert", "frag")
    for path in sorted((ROOT / folder).rglob(f"*.{ending}"))
]


def unnamed(line: str) -> list[str]:
    """Return the numbers in a line that lack a name and need one.

    0, 1, 2 and 0.5 need none, nor do numbers of vector components up to 4.
    """
    code = line.partition("//")[0]
    if re.match(r"\s*(const\b|#|layout)", code):
        return []
    numbers = PLAIN_NUMBER.findall(code)
    plain = {"0.0", "0.5", "1.0", "2.0", "0", "1", "2", "3", "4", "0u", "1u"}
    return [number for number in numbers if number not in plain]


@pytest.mark.parametrize("name", [name for name in SHADERS if name != OWN_TABLE])
def test_every_number_of_a_shader_has_a_name(name: str) -> None:
    lines = (ROOT / name).read_text("utf-8").splitlines()
    assert {number: found for number, line in enumerate(lines, 1) if (found := unnamed(line))} == {}


def test_a_number_without_a_name_is_found() -> None:
    assert unnamed("    float left = 0.35 * right + max(far, 1e-6) + side[3].x; // 0.7") == ["0.35", "1e-6"]
    assert unnamed("    int upper = number >> 16 & 255;") == ["16", "255"]
    assert unnamed("const float SOFT = 0.35;") == unnamed("    vec3 color_12 = 0.5 * shade;") == []


def test_what_comes_through_a_medium_is_worked_out_in_one_place() -> None:
    by_chance = re.compile(r"\bexp\(-(?!off \* off)")  # but for the glow of a lamp on a body, which is a bell curve
    found = {name for name in SHADERS if any(map(by_chance.search, (ROOT / name).read_text("utf-8").splitlines()))}
    assert found == {"engine/shaders/lib/through.glsl"}


def test_no_table_is_asked_for_a_kind_that_may_be_a_face() -> None:
    """NVIDIA's compiler refuses `kinds[-1]` even in a branch that nothing takes; Mesa's and glslang do not."""
    asked = re.compile(r"reflector\.kind(?! [!=]= FACE)")
    found = [
        line.strip()
        for name in SHADERS
        for line in (ROOT / name).read_text("utf-8").splitlines()
        if asked.search(line.replace("kind_index(reflector.kind)", ""))
    ]
    assert found == []


def functions_in(text: str) -> dict[str, int]:
    """Return the number of lines of the longest function of each name."""
    found = re.finditer(r"^\w+ (\w+)\([^;{]*\{$.*?^\}$", text, re.MULTILINE | re.DOTALL)
    lengths: dict[str, int] = {}
    for one in found:
        lengths[one[1]] = max(lengths.get(one[1], 0), one[0].count("\n") + 1)
    return lengths


def test_functions_of_shaders_are_read_at_one_glance() -> None:
    most = {"main": 60}
    lengths = {name: functions_in((ROOT / name).read_text("utf-8")) for name in SHADERS}
    assert sum(map(len, lengths.values())) > 300
    long = [
        (name, function, lines)
        for name, found in lengths.items()
        for function, lines in found.items()
        if lines > most.get(function, 50)
    ]
    assert long == []


def test_numbers_that_are_due_are_told_again_once_others_were_told(ctx: moderngl.Context) -> None:
    text = "#version 330\nuniform float high; uniform vec2 at[2]; void main() { gl_Position = vec4(high, at[1], 1.0); }"
    made = ctx.program(vertex_shader=text)
    made.extra = {}
    high_told, at_told = made.get("high", None), made.get("at", None)
    assert isinstance(high_told, moderngl.Uniform)
    assert isinstance(at_told, moderngl.Uniform)
    numbers = [
        [
            *pack(made, {"high": (high,), "unasked": (0.0,)}),
            *pack_array(made, "at", [(0.0, 0.0), (high, 2.0)]),
        ]
        for high in (1.0, 3.0)
    ]
    for each, high in zip(numbers, (1.0, 3.0), strict=True):
        set_packed(each)
        assert high_told.value == high
        assert list(at_told.value)[1] == (high, 2.0)
        high_told.value = 7.0  # it was told, so it is not told the same again
        set_packed(each)
        assert high_told.value == 7.0
    set_packed(numbers[0])
    assert high_told.value == 1.0
    made.release()
