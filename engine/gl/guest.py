"""A guest's manners: drawing into the host's framebuffer and leaving its GL state as it was."""

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl

from .host import Box, State, is_hidden, loaded_gl, pyglet_context

FIRST_UNIT = 32
"""The first texture unit that is used: OpenGL 3.3 has 48, and hosts use the first few, with textures and samplers."""

_kept: list[State] = []


def host_context(ctx: moderngl.Context | None) -> moderngl.Context:
    """Return `ctx`, or the context that is current now; RuntimeError if the host has no window yet.

    moderngl's own choice is taken, whichever of a host's windows is current: it stands for the functions of GL, and
    what it remembers is set anew for every frame.
    """
    if ctx is not None:
        return ctx
    place = pyglet_context()
    if is_hidden(place):
        raise RuntimeError("there is no window yet: create the window before the prairie is first drawn, or pass ctx")
    try:
        found = moderngl.get_context()
        # A context without a window is another one than that of the window which is current.
        return moderngl.create_context() if place is not None and found.screen is None else found
    except Exception as error:  # its loaders raise nothing narrower
        raise RuntimeError(
            f"there is no GL context ({error}): create the window before the prairie is first drawn, or pass ctx"
        ) from error


@contextmanager
def kept() -> Iterator[None]:
    """Leave the GL state of a host that draws with pyglet exactly as it is, whatever is done inside.

    What is bound to texture units from `FIRST_UNIT` on, and to the last uniform block, is not kept. A host without
    pyglet finds buffers and textures bound that it has not bound, and has to bind its own before it uses them.
    """
    gl = loaded_gl()
    if gl is None or _kept:
        yield
        return
    _kept.append(State(gl))
    try:
        _kept[-1].clear()
        yield
    finally:
        _kept.pop().restore()


def viewport(ctx: moderngl.Context) -> Box:
    """Return where the host draws: x, y, width and height [pixels]."""
    gl = loaded_gl()
    if gl is None:
        return _boxes(ctx, ctx.detect_framebuffer())[0]
    found = (gl.GLint * 4)()
    gl.glGetIntegerv(gl.GL_VIEWPORT, found)
    return _box(found)


def _boxes(ctx: moderngl.Context, target: moderngl.Framebuffer) -> tuple[Box, Box | None]:
    """Return the host's viewport and scissor box, None where nothing is cut off.

    moderngl remembers the size that a window had when it first saw it, so beside pyglet these are asked of GL itself.
    """
    if _kept:
        return _kept[-1].viewport, _kept[-1].scissor
    whole = (0, 0, *target.size)
    bounds, scissor = (whole, whole) if ctx.fbo is None else (_box(ctx.viewport), _box(ctx.scissor or whole))
    return bounds, scissor if scissor != whole else None


def _host_framebuffer(ctx: moderngl.Context, target: moderngl.Framebuffer) -> moderngl.Framebuffer:
    """Return the host's own object for the framebuffer it has bound, with its masks, where it draws with moderngl."""
    bound = None if _kept else ctx.fbo
    return bound if bound is not None and bound.glo == target.glo else target


def _aim(target: moderngl.Framebuffer, bounds: Box, scissor: Box | None) -> None:
    target.viewport = bounds
    target.scissor = scissor  # type: ignore[assignment]


def _box(numbers: tuple[int, ...]) -> Box:
    x, y, width, height = numbers
    return int(x), int(y), int(width), int(height)


@contextmanager
def guest(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    """Draw as a guest: yields the framebuffer that the host has bound, whole and with a known state.

    On leaving, the host's framebuffer, viewport and scissor are as they were. Beside pyglet everything else is, too;
    without it nothing is enabled. Never touches uniform binding point 0, nor the texture units before `FIRST_UNIT`.
    """
    with kept():
        target = ctx.detect_framebuffer()
        bounds, scissor = _boxes(ctx, target)
        host = _host_framebuffer(ctx, target)
        before = ctx.front_face, ctx.wireframe
        _begin(ctx, target, bounds, scissor)
        try:
            yield target
        finally:
            target.depth_mask = True
            _aim(target, bounds, scissor)
            host.use()
            ctx.enable_only(moderngl.NOTHING)
            ctx.front_face, ctx.wireframe = before


def _begin(ctx: moderngl.Context, target: moderngl.Framebuffer, bounds: Box, scissor: Box | None) -> None:
    _aim(target, bounds, scissor)
    ctx.wireframe = False
    ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
    ctx.front_face = "ccw"
    ctx.depth_func = "<="
    target.color_mask = (True, True, True, True)
    target.depth_mask = True
    target.use()
