"""Programs compiled in the driver's own threads: they are thrown away, and leave nothing behind."""

from time import monotonic, sleep

import moderngl
import pytest

from tallgrass.engine.gl.background import BackgroundCompiler, compiles_in_background
from tallgrass.engine.gl.functions import functions_of
from tallgrass.engine.gl.rasteriser import draws_in_software
from tallgrass.engine.gl.shaders import Texts

VERTEX = "#version 330 core\nvoid main() { gl_Position = vec4(1.0); }\n"
DRAWN = Texts(VERTEX, "#version 330 core\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n")
WRONG = Texts(VERTEX, "#version 330 core\nvoid main() { nothing(); }\n")


def numbers(ctx: moderngl.Context) -> list[int]:
    return [number for number in range(1, 4096) if functions_of(ctx).glIsProgram(number)]


def test_what_a_driver_was_asked_for_is_made_and_given_back_whatever_it_is(ctx: moderngl.Context) -> None:
    before, compiler = numbers(ctx), BackgroundCompiler(ctx)
    for texts in (DRAWN, WRONG):
        compiler.start(texts)
    assert len(numbers(ctx)) == len(before) + 2
    start = monotonic()
    while compiler.pending and monotonic() - start < 20.0:
        sleep(0.001)
    assert (compiler.pending, numbers(ctx), ctx.error) == (0, before, "GL_NO_ERROR")


def test_what_is_underway_is_given_back_with_it(ctx: moderngl.Context) -> None:
    before, compiler = numbers(ctx), BackgroundCompiler(ctx)
    compiler.start(DRAWN)
    compiler.release()
    assert numbers(ctx) == before


def test_a_rasteriser_makes_nothing_beside_as_its_threads_draw(ctx: moderngl.Context) -> None:
    if not draws_in_software(ctx):
        pytest.skip("a card does")
    assert not compiles_in_background(ctx)
