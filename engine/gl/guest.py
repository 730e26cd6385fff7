"""A guest's manners: drawing into the host's framebuffer and leaving its GL state as it was."""

from collections.abc import Iterator
from contextlib import contextmanager

import moderngl
import numpy as np

from ...components.arrays import Doubles
from ..camera import View, is_reversed
from .current import current_functions, is_own, own_context
from .functions import NUMBERS, functions_of
from .host import State, has_windows, is_hidden, loaded_gl, pyglet_context
from .limits import limits_of
from .outputs import is_not_plain_2d
from .units import SCRATCH_UNIT

_saved: list[State] = []

TURNED = {"<": ">", "<=": ">=", ">": "<", "1": "1"}
"""Tests of depth, and what each is where less is farther off."""


def block_binding(ctx: moderngl.Context) -> int:
    """Return the binding point of the one uniform block that is used: the highest, away from a host's own."""
    return limits_of(functions_of(ctx)).bindings - 1


def host_context(ctx: moderngl.Context | None) -> moderngl.Context:
    """Return `ctx`, or one of our own in the context that is current now; RuntimeError if none is, or too old a one."""
    if ctx is not None:
        return ctx
    _must_have_window()
    limits_of(current_functions())
    return own_context()


def _must_have_window() -> None:
    """Raise RuntimeError where pyglet draws and only its hidden window is current."""
    if not is_hidden(pyglet_context()):
        return
    if has_windows():
        raise RuntimeError("no window is current: call the switch_to of one before the prairie is drawn, or pass ctx")
    raise RuntimeError("there is no window yet: create the window before the prairie is first drawn, or pass ctx")


@contextmanager
def saved_state(ctx: moderngl.Context | None) -> Iterator[State]:
    """Leave the host's GL state exactly as it is, whatever is done inside; yields what it was.

    `ctx` is the host's context, None for the one that is current now; RuntimeError if there is none, or too old a one.
    Which textures are bound to units from `FIRST_UNIT` on is not kept, nor what is bound to the last uniform block.
    """
    if _saved:
        yield _saved[-1]
        return
    if ctx is None:
        _must_have_window()
    elif isinstance(ctx.mglo, moderngl.InvalidObject):
        raise RuntimeError(
            "the moderngl context of this prairie was released: load the prairie again, with another one"
        )
    gl = current_functions() if ctx is None else functions_of(ctx)
    if ctx is not None and gl.glGetString(NUMBERS["VERSION"]) is None:
        raise RuntimeError("no GL context is current in this thread: draw in that of the window, or make one current")
    unit = SCRATCH_UNIT if ctx is None else ctx.default_texture_unit
    _saved.append(State(gl, limits_of(gl), unit))
    try:
        _saved[-1].clear()
        yield _saved[-1]
    finally:
        _saved.pop().restore()


def guest_view(seen: View) -> View:
    """Return a view for clip space in which a guest draws, from the host's (`glClipControl`).

    That is OpenGL's own, but for depth that is reversed: it stays as the host has it.
    """
    clip = _saved[-1].clip(keeps_depth=is_reversed(seen))
    return seen if clip is None else View(seen.view, clip @ seen.projection)


def guest_clip(matrix: Doubles, /) -> Doubles:
    """Return a matrix to clip space as OpenGL has it, from one to the host's, (4, 4)."""
    clip = _saved[-1].clip()
    return matrix if clip is None else np.asarray(clip @ matrix, np.float64)


def borrow(unit: int, texture: int, /) -> None:
    """Bind a 2D texture to a unit before `FIRST_UNIT`, until the host's state is brought back."""
    _saved[-1].borrow(unit, texture)


def sync_framebuffer(ctx: moderngl.Context) -> None:
    """Tell moderngl which framebuffer the host has bound.

    Whenever it makes one, it binds again what it knows of; of a host that does not draw with it, that is an old one,
    which the host may have deleted.
    """
    _host_framebuffer(ctx, _bound(ctx)).use()


@contextmanager
def guest(ctx: moderngl.Context, seen: View | None = None) -> Iterator[moderngl.Framebuffer]:
    """Draw as a guest: yields the framebuffer that the host has bound, whole and with a known state.

    Colour goes to the host's first output alone, as far as the host's colour mask lets it; what the others are written
    to stays as it is. Depth is written whatever the host's depth mask says, and where there is no colour, depth alone.
    It runs as in `seen`, where that is given. On leaving, the host's state is as it was. Never touches uniform binding
    point 0, nor the texture units before `FIRST_UNIT`.
    """
    with saved_state(ctx) as state:
        target = _bound(ctx)
        with _remembered(ctx, target, state):
            state.look(is_reversed=seen is not None and is_reversed(seen))
            _begin(ctx, target, state)
            try:
                yield target
            finally:
                state.look(is_reversed=False)


def set_depth_test(ctx: moderngl.Context, test: str, /) -> None:
    """Draw where a test of depth says so: "<" is nearer, however the host's depth runs."""
    ctx.depth_func = TURNED[test] if _saved[-1].is_turned else test


def depth_ends() -> tuple[float, float]:
    """Return the depths of the near and the far end of the clip space that a guest draws in now."""
    return _saved[-1].ends


def farthest_depth() -> float:
    """Return the depth that a framebuffer has where nothing has been drawn."""
    return 0.0 if _saved[-1].is_turned else 1.0


@contextmanager
def aside(ctx: moderngl.Context, target: moderngl.Framebuffer, *, alike: bool = False) -> Iterator[None]:
    """Draw into framebuffers of one's own while a guest in `target`, or into buffers; nothing is blended or hidden.

    Depth is the usual one there, or as in `target` where it is `alike`.
    """
    box, cut, was_reversed = target.viewport, target.scissor, _saved[-1].is_reversed
    ctx.enable_only(moderngl.NOTHING)
    _saved[-1].look(is_reversed=was_reversed and alike)
    set_depth_test(ctx, "<=")
    try:
        yield
    finally:
        _saved[-1].look(is_reversed=was_reversed)
        set_depth_test(ctx, "<=")
        target.use()
        target.viewport = box
        target.scissor = cut if cut != (0, 0, *target.size) else None  # type: ignore[assignment]
        if target.glo == _saved[-1].framebuffer:
            _saved[-1].narrow()


@contextmanager
def colourless(target: moderngl.Framebuffer) -> Iterator[None]:
    """Write no colour meanwhile into the framebuffer that is drawn in."""
    state = _saved[-1]
    state.gl.glColorMaski(0, 0, 0, 0, 0)
    try:
        yield
    finally:
        state.gl.glColorMaski(0, 1, 1, 1, 1)
        if target.glo == state.framebuffer:
            state.narrow()


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


def _bound(ctx: moderngl.Context) -> moderngl.Framebuffer:
    """Return the framebuffer that the host has bound.

    moderngl binds its colours as a 2D texture to ask for their size. Where they have several samples or layers, that
    leaves an error of GL, which the host would take for its own.
    """
    found = ctx.detect_framebuffer()
    if found.glo and is_not_plain_2d(functions_of(ctx)):
        _ = ctx.error
    return found


def _host_framebuffer(ctx: moderngl.Context, target: moderngl.Framebuffer) -> moderngl.Framebuffer:
    """Return the host's own object for the framebuffer it has bound, where it draws with moderngl."""
    bound = None if is_own(ctx) or loaded_gl() is not None else ctx.fbo
    if bound is None or bound.glo != target.glo or isinstance(bound.mglo, moderngl.InvalidObject):
        return target
    return bound


def _begin(ctx: moderngl.Context, target: moderngl.Framebuffer, state: State) -> None:
    target.viewport = state.viewport
    target.scissor = state.scissor  # type: ignore[assignment]
    ctx.wireframe = False
    ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
    ctx.front_face = "ccw"
    set_depth_test(ctx, "<=")
    target.depth_mask = True
    target.use()
    state.narrow()
