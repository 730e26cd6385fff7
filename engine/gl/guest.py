"""A guest's manners: drawing into the host's framebuffer and leaving its GL state as it was."""

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl

from .functions import Functions, current_functions, functions_of
from .host import State, has_windows, is_hidden, loaded_gl, pyglet_context

FIRST_UNIT = 32
"""The first texture unit that is used: OpenGL 3.3 has 48, and hosts use the first few, with textures and samplers."""

_kept: list[State] = []


def host_context(ctx: moderngl.Context | None) -> moderngl.Context:
    """Return `ctx`, or the context that is current now; RuntimeError if the host has none, or none is current.

    moderngl's own choice is taken, whichever of a host's windows is current: it stands for the functions of GL, and
    what it remembers is set anew for every frame.
    """
    if ctx is not None:
        return ctx
    place = pyglet_context()
    if is_hidden(place) and has_windows():
        raise RuntimeError("no window is current: call the switch_to of one before the prairie is drawn, or pass ctx")
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
def kept(ctx: moderngl.Context | None) -> Iterator[State]:
    """Leave the host's GL state exactly as it is, whatever is done inside; yields what it was.

    `ctx` is the host's context, None for the one that is current now; RuntimeError if there is none. What is bound to
    texture units from `FIRST_UNIT` on, and to the last uniform block, is not kept.
    """
    if _kept:
        yield _kept[-1]
        return
    _kept.append(State(_functions(ctx)))
    try:
        _kept[-1].clear()
        yield _kept[-1]
    finally:
        _kept.pop().restore()


def arrive(ctx: moderngl.Context) -> None:
    """Tell moderngl which framebuffer the host has bound.

    Whenever it makes one, it binds again what it knows of; of a host that does not draw with it, that is an old one,
    which the host may have deleted.
    """
    _host_framebuffer(ctx, ctx.detect_framebuffer()).use()


def _functions(ctx: moderngl.Context | None) -> Functions:
    """Return GL's functions for the host."""
    if ctx is None:
        try:
            return current_functions()
        except Exception:  # noqa: BLE001 - its loaders raise nothing narrower
            ctx = host_context(None)
    return functions_of(ctx)


@contextmanager
def guest(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    """Draw as a guest: yields the framebuffer that the host has bound, whole and with a known state.

    Colour goes to the host's first output alone, as far as the host's colour mask lets it; what the others are written
    to stays as it is. Depth is written whatever the host's depth mask says, and where there is no colour, depth alone.
    On leaving, the host's state is as it was. Never touches uniform binding point 0, nor the texture units before
    `FIRST_UNIT`.
    """
    with kept(ctx) as state:
        target = ctx.detect_framebuffer()
        with _remembered(ctx, target, state):
            _begin(ctx, target, state)
            yield target


@contextmanager
def aside(ctx: moderngl.Context, target: moderngl.Framebuffer) -> Iterator[None]:
    """Draw into framebuffers of one's own while a guest in `target`, or into buffers; nothing is blended or hidden."""
    box, cut = target.viewport, target.scissor
    ctx.enable_only(moderngl.NOTHING)
    try:
        yield
    finally:
        target.use()
        target.viewport = box
        target.scissor = cut if cut != (0, 0, *target.size) else None  # type: ignore[assignment]
        if target.glo == _kept[-1].framebuffer:
            _kept[-1].narrow()


@contextmanager
def _remembered(ctx: moderngl.Context, target: moderngl.Framebuffer, state: State) -> Iterator[None]:
    """Let moderngl remember in the end what it does now, so that a host that draws with it finds what it has set."""
    host = _host_framebuffer(ctx, target)
    box, cut, writes = target.viewport, target.scissor, target.depth_mask
    before = ctx.front_face, ctx.cull_face, ctx.wireframe
    try:
        yield
    finally:
        target.viewport, target.depth_mask = box, writes
        target.scissor = cut if cut != (0, 0, *target.size) else None  # type: ignore[assignment]
        host.use()
        ctx.enable_only(state.flags)
        ctx.front_face, ctx.cull_face, ctx.wireframe = before


def _host_framebuffer(ctx: moderngl.Context, target: moderngl.Framebuffer) -> moderngl.Framebuffer:
    """Return the host's own object for the framebuffer it has bound, where it draws with moderngl."""
    bound = ctx.fbo if loaded_gl() is None else None
    if bound is None or bound.glo != target.glo or isinstance(bound.mglo, moderngl.InvalidObject):
        return target
    return bound


def _begin(ctx: moderngl.Context, target: moderngl.Framebuffer, state: State) -> None:
    target.viewport = state.viewport
    target.scissor = state.scissor  # type: ignore[assignment]
    ctx.wireframe = False
    ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
    ctx.front_face = "ccw"
    ctx.depth_func = "<="
    target.depth_mask = True
    target.use()
    state.narrow()
