"""Drawing into memory."""

import moderngl
import numpy as np
import pytest

from tallgrass.app.studio.errors import MachineError
from tallgrass.app.studio.offscreen import Offscreen, standalone_context

EVERYWHERE = """
#version 330
void main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0.9, 1.0); }
"""


def test_a_picture_is_read_top_row_first(ctx: moderngl.Context) -> None:
    with Offscreen((5, 4), ctx) as target:
        target.begin()
        drawn = ctx.detect_framebuffer()
        drawn.scissor = (0, 3, 2, 1)
        drawn.clear(1.0, 0.6, 0.0)
        picture = target.read()
    assert picture.shape == (4, 5, 3)
    np.testing.assert_array_equal(picture[0, :2], [[255, 153, 0]] * 2)
    assert picture[0, 2:].max() == 0
    assert picture[1:].max() == 0


def test_begin_clears_colour_and_depth(ctx: moderngl.Context) -> None:
    with Offscreen((2, 2), ctx) as target:
        target.begin()
        ctx.detect_framebuffer().clear(1.0, 1.0, 1.0, depth=0.0)
        target.begin()
        assert target.read().max() == 0
        ctx.enable_only(moderngl.DEPTH_TEST)
        program = ctx.program(
            vertex_shader=EVERYWHERE, fragment_shader="#version 330\nout vec4 color; void main() { color = vec4(1); }"
        )
        ctx.vertex_array(program, []).render(vertices=3)
        ctx.enable_only(moderngl.NOTHING)
        assert target.read().min() == 255


def test_what_the_host_had_bound_is_bound_again(ctx: moderngl.Context) -> None:
    host = ctx.simple_framebuffer((9, 7))
    host.use()
    with Offscreen((3, 3), ctx) as target:
        target.begin()
        assert ctx.detect_framebuffer().glo != host.glo
    assert ctx.detect_framebuffer().glo == host.glo
    assert ctx.detect_framebuffer().viewport == (0, 0, 9, 7)
    host.release()


def test_without_egl_the_platforms_own_context_is_tried(monkeypatch: pytest.MonkeyPatch, ctx: moderngl.Context) -> None:
    asked: list[dict[str, object]] = []

    def create_context(**options: object) -> moderngl.Context:
        asked.append(options)
        if options.get("backend") == "egl":
            raise RuntimeError("libEGL.so not loaded")
        return ctx

    monkeypatch.setattr(moderngl, "create_context", create_context)
    assert standalone_context() is ctx
    assert [options.get("backend") for options in asked] == ["egl", None]
    assert all(options["standalone"] and options["require"] == 330 for options in asked)


def test_without_any_gl_one_sentence_says_why_and_who_knows_more(monkeypatch: pytest.MonkeyPatch) -> None:
    def create_context(**options: object) -> moderngl.Context:
        raise RuntimeError(f"libGL.so not found by {options.get('backend', 'the platform')}")

    monkeypatch.setattr(moderngl, "create_context", create_context)
    with pytest.raises(MachineError, match=r"by egl; .* by the platform .*tallgrass doctor"):
        standalone_context()
