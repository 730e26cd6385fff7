"""A guest's manners: drawing into the host's framebuffer and leaving its GL state as it was."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import moderngl

Box = tuple[int, int, int, int]

UNITS = 12
"""Texture units that are used, from 0."""


def host_context(ctx: moderngl.Context | None) -> moderngl.Context:
    """Return `ctx`, or the context that is current now; RuntimeError if the host has no window yet."""
    found = ctx if ctx is not None else moderngl.get_context()
    if found.screen is not None and found.screen.size == (1, 1):
        raise RuntimeError("there is no window yet: create the window before the prairie is first drawn")
    return found


def _pyglet_gl() -> Any | None:
    """Return pyglet's GL module if the host draws with pyglet, without ever loading it."""
    module = sys.modules.get("pyglet.gl")
    return module if module is not None and getattr(module, "current_context", None) is not None else None


def _boxes(ctx: moderngl.Context, target: moderngl.Framebuffer, gl: Any | None) -> tuple[Box, Box | None]:
    """Return the host's viewport and scissor box, None where nothing is cut off.

    moderngl remembers the size that a window had when it first saw it, so beside pyglet these are asked of GL itself.
    """
    if gl is None:
        whole = (0, 0, *target.size)
        viewport, scissor = (whole, whole) if ctx.fbo is None else (_box(ctx.viewport), _box(ctx.scissor))
        return viewport, scissor if scissor != whole else None
    viewport, scissor = (gl.GLint * 4)(), (gl.GLint * 4)()
    gl.glGetIntegerv(gl.GL_VIEWPORT, viewport)
    gl.glGetIntegerv(gl.GL_SCISSOR_BOX, scissor)
    return _box(viewport), _box(scissor) if gl.glIsEnabled(gl.GL_SCISSOR_TEST) else None


def _host_framebuffer(ctx: moderngl.Context, target: moderngl.Framebuffer, gl: Any | None) -> moderngl.Framebuffer:
    """Return the host's own object for the framebuffer it has bound, with its masks, where it draws with moderngl."""
    bound = ctx.fbo if gl is None else None
    return bound if bound is not None and bound.glo == target.glo else target


def _aim(target: moderngl.Framebuffer, viewport: Box, scissor: Box | None) -> None:
    target.viewport = viewport
    target.scissor = scissor  # type: ignore[assignment]


def _box(numbers: Any) -> Box:
    x, y, width, height = numbers
    return int(x), int(y), int(width), int(height)


@contextmanager
def guest(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    """Draw as a guest: yields the framebuffer that the host has bound, whole and with a known state.

    On leaving, the host's framebuffer, viewport and scissor are as they were, nothing is enabled, and no vertex
    array, program, texture unit or sampler of ours stays bound. Never touches uniform binding point 0.
    """
    target, gl = ctx.detect_framebuffer(), _pyglet_gl()
    viewport, scissor = _boxes(ctx, target, gl)
    host = _host_framebuffer(ctx, target, gl)
    _aim(target, viewport, scissor)
    ctx.wireframe = False
    ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
    ctx.front_face = "ccw"
    ctx.depth_func = "<="
    target.color_mask = (True, True, True, True)
    target.depth_mask = True
    target.use()
    ctx.clear_samplers(0, UNITS)
    try:
        yield target
    finally:
        target.depth_mask = True
        _aim(target, viewport, scissor)
        host.use()
        ctx.enable_only(moderngl.NOTHING)
        ctx.clear_samplers(0, UNITS)
        if gl is not None:
            gl.glBindVertexArray(0)
            gl.glUseProgram(0)
            gl.glActiveTexture(gl.GL_TEXTURE0)
