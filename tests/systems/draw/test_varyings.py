"""Varyings: never more than every OpenGL 3.3 allows, for any number of kinds."""

import ctypes
import re
from collections.abc import Mapping, Sequence
from ctypes import c_char_p, c_int, c_uint, c_void_p
from pathlib import Path
from typing import Any

import moderngl
import pytest

from tallgrass import Footprint, testing
from tallgrass.engine.declared.grass import MOST_KINDS
from tallgrass.engine.gl import shaders
from tallgrass.engine.gl.functions import convention, functions_of
from tallgrass.systems.prairie import Prairie
from tallgrass.testing import LITTLE, looking

SURE = 60
"""Least GL_MAX_VARYING_COMPONENTS of OpenGL 3.3."""

NUMBERS = {0x1406: 1, 0x8B50: 2, 0x8B51: 3, 0x8B52: 4, 0x8B5C: 16, 0x1404: 1}
"""Numbers of GL_FLOAT, its vectors, GL_FLOAT_MAT4 and GL_INT."""

SPECIAL = "grass:\n  flowers: { plant: flower, plants: 60, height: [0.2, 0.4], head: { petals: 5, size: [0.05, 0.1] } }"

Asked = list[tuple[str, Mapping[str, str | int], Mapping[str, Sequence[shaders.Line]] | None]]


class Inputs:
    """Queries a driver for the inputs of a fragment shader that it does not drop."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._address = functions_of(ctx)._address  # noqa: SLF001

    def _call(self, name: str, takes: Sequence[Any], *given: Any, answers: Any = None) -> Any:
        return convention(answers, *takes)(self._address(name))(*given)

    def numbers(self, source: str) -> list[int]:
        """Return the number of components of each input."""
        text = (c_char_p * 1)(source.encode())
        made = self._call("glCreateShaderProgramv", (c_uint, c_int, c_void_p), 0x8B30, 1, text, answers=c_uint)
        linked, count, told = c_int(), c_int(), (c_int * 2)()
        self._call("glGetProgramiv", (c_uint, c_uint, c_void_p), made, 0x8B82, ctypes.byref(linked))
        assert linked.value, "the shader does not compile"
        interface = (c_uint, c_uint, c_uint, c_void_p)
        self._call("glGetProgramInterfaceiv", interface, made, 0x92E3, 0x92F5, ctypes.byref(count))
        asked, found, name = (c_uint * 2)(0x92FA, 0x92FB), [], ctypes.create_string_buffer(80)  # type, array size
        for number in range(count.value):
            self._call(
                "glGetProgramResourceiv", (*(c_uint,) * 3, c_int, c_void_p, c_int, c_void_p, c_void_p),
                made, 0x92E3, number, 2, asked, 2, None, told,
            )  # fmt: skip
            named = (c_uint, c_uint, c_uint, c_int, c_void_p, c_void_p)
            self._call("glGetProgramResourceName", named, made, 0x92E3, number, 80, None, name)
            if not name.value.startswith(b"gl_"):
                found.append(NUMBERS[told[0]] * told[1])
        self._call("glDeleteProgram", (c_uint,), made)
        return found


@pytest.fixture(scope="module")
def fragments(ctx: moderngl.Context, tmp_path_factory: pytest.TempPathFactory) -> Asked:
    """Inputs of the fragment shaders of a prairie with flowers, which need more than grass, before and after a cut."""
    asked: Asked = []
    real = shaders.compose

    def noted(name: str, defines: Any = None, made: Any = None) -> tuple[str, list[shaders.Line]]:
        asked.append((name, dict(defines or {}), made))
        return real(name, defines, made)

    path = tmp_path_factory.mktemp("scene") / "scene.yaml"
    with pytest.MonkeyPatch.context() as patch, testing.stage(ctx) as stage:
        patch.setattr(shaders, "compose", noted)
        for name in ("render", "transform"):  # to draw with them takes a software rasteriser ten seconds
            patch.setattr(moderngl.VertexArray, name, lambda *_, **__: None)
        path.write_text(LITTLE.replace("\ngrass:", "\n" + SPECIAL), "utf-8")
        prairie = Prairie.load(path, ctx=ctx)
        stage.shot(prairie, looking(0.0, 1.7, 5.0))
        prairie.cut(Footprint(radius=5.0), 0.1)
        stage.shot(prairie, looking(0.0, 1.7, 5.0))
        prairie.release()
    return [each for each in asked if each[0].startswith("systems/show/") and each[0].endswith(".frag")]


@pytest.mark.parametrize("kinds", [pytest.param(4, marks=pytest.mark.slow), MOST_KINDS])  # more take more
def test_pixels_take_no_more_numbers_than_are_sure_to_come_through(
    ctx: moderngl.Context, fragments: Asked, kinds: int
) -> None:
    inputs, tried = Inputs(ctx), set()
    for name, defines, made in fragments:
        if "receivers" in name or name.endswith(("/far.frag", "/mean.frag")):
            continue
        source, _ = shaders.compose(name, {**defines, "KINDS": kinds}, made)
        if source in tried:
            continue
        tried.add(source)
        found = inputs.numbers(source)
        assert 0 < sum(found) <= SURE, name
        if "carpet" not in name:  # whole vectors, as not every driver packs what is smaller together
            assert sum(-(-each // 4) * 4 for each in found) <= SURE, name
    assert len(tried) >= 8


@pytest.mark.parametrize("name", ["carpet", "coarse", "ground", "under"])
def test_of_several_samples_a_pixel_none_asks_beyond_a_tiles_edge_where_numbers_have_any_value(name: str) -> None:
    folder = Path(shaders.__file__).parents[2] / "systems/show/carpet"
    text = (folder / f"{name}.frag").read_text("utf-8")
    shared = f'#define PASSED in\n#include "systems/show/carpet/{name}.glsl"'
    if shared in text:  # its varyings are declared for both stages at once
        text = text.replace(shared, (folder / f"{name}.glsl").read_text("utf-8").replace("PASSED", "in"))
    wild = re.findall(r"^in \w+ (\w+);", text, re.MULTILINE)
    assert {*wild} <= {"place", "mesh_place"}, "of these, only differences count, to the next pixel"
    assert not re.search(r"^#define \w+ in$", text, re.MULTILINE)
