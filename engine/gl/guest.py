"""A guest's manners: drawing into the host's framebuffer and leaving its GL state as it was."""

from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import c_float
from functools import lru_cache

import moderngl
import numpy as np

from ...components.arrays import Doubles
from ..camera import View, is_reversed
from .current import current_functions, is_own, own_context
from .functions import ENUMS, functions_of
from .host import State, has_windows, is_hidden, loaded_gl, pyglet_context
from .limits import limits_of
from .outputs import is_not_plain_2d
from .units import SCRATCH_UNIT

_saved: list[State] = []

REVERSED_TESTS = {"<": ">", "<=": ">=", ">": "<", "1": "1"}
"""Depth tests, and their equivalents where smaller depth is farther away."""


def block_binding(ctx: moderngl.Context) -> int:
    """Return the binding point of the only uniform block in use: the highest, as hosts use the first ones."""
    return limits_of(functions_of(ctx)).bindings - 1


def host_context(ctx: moderngl.Context | None) -> moderngl.Context:
    """Return `ctx`, or else our own context for the current one; RuntimeError if there is none, or it is too old."""
    if ctx is not None:
        return ctx
    _must_have_window()
    limits_of(current_functions())
    return own_context()


def _must_have_window() -> None:
    """Raise RuntimeError where the host uses pyglet and only pyglet's hidden window is current."""
    if not is_hidden(pyglet_context()):
        return
    if has_windows():
        raise RuntimeError("no window is current: call the switch_to of one before the prairie is drawn, or pass ctx")
    raise RuntimeError("there is no window yet: create the window before the prairie is first drawn, or pass ctx")


@contextmanager
def saved_state(ctx: moderngl.Context | None) -> Iterator[State]:
    """Save the host's GL state and restore it exactly in the end; yields the saved state.

    `ctx` is the host's context, None for the current one; RuntimeError if there is none, or it is too old. Textures on
    units from `FIRST_UNIT` on and the binding of the last uniform block are not restored.
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
    if ctx is not None and gl.glGetString(ENUMS["VERSION"]) is None:
        raise RuntimeError("no GL context is current in this thread: make that of the window current in it")
    unit = SCRATCH_UNIT if ctx is None else ctx.default_texture_unit
    _saved.append(State(gl, limits_of(gl), unit))
    try:
        _saved[-1].clear()
        yield _saved[-1]
    finally:
        _saved.pop().restore()


def guest_view(seen: View) -> View:
    """Return a host's view with its projection converted to the guest's clip space.

    The host's clip space depends on its `glClipControl`. The guest's is OpenGL's default, but reversed depth keeps the
    host's range.
    """
    conversion = _saved[-1].clip_conversion(keeps_depth=is_reversed(seen))
    return seen if conversion is None else View(seen.view, conversion @ seen.projection)


def guest_clip(matrix: Doubles, /) -> Doubles:
    """Return a matrix to the host's clip space (4, 4), converted to OpenGL's default clip space."""
    conversion = _saved[-1].clip_conversion()
    return matrix if conversion is None else np.asarray(conversion @ matrix, np.float64)


def borrow(unit: int, texture: int, /) -> None:
    """Bind a 2D texture to a unit before `FIRST_UNIT`, until the host's state is restored."""
    _saved[-1].borrow(unit, texture)


def sync_framebuffer(ctx: moderngl.Context) -> None:
    """Make moderngl aware of the framebuffer that the host has bound.

    Whenever moderngl makes a framebuffer, it binds again the one it knows as bound. If the host does not draw with
    moderngl, that one is outdated, and the host may have deleted it.
    """
    _host_framebuffer(ctx, _bound(ctx)).use()


@contextmanager
def guest(ctx: moderngl.Context, seen: View | None = None) -> Iterator[moderngl.Framebuffer]:
    """Draw as a guest: yields the framebuffer that the host has bound, with GL in a known state.

    Colour goes to the host's first output alone, through the host's colour mask; other outputs are not written. Depth
    is written whatever the host's depth mask is, and alone where there is no colour. Depth is reversed if it is in
    `seen`. On leaving, the host's state is restored. Never touches uniform binding point 0, nor the texture units
    before `FIRST_UNIT`.
    """
    with saved_state(ctx) as state:
        target = _bound(ctx)
        with _moderngl_restored(ctx, target, state):
            state.set_depth(is_reversed=seen is not None and is_reversed(seen))
            _begin(ctx, target, state)
            try:
                yield target
            finally:
                state.set_depth(is_reversed=False)


def set_depth_test(ctx: moderngl.Context, test: str, /) -> None:
    """Set the depth test: "<" passes what is nearer, whether depth is reversed or not."""
    ctx.depth_func = REVERSED_TESTS[test] if _saved[-1].far_is_less else test


def depth_ends() -> tuple[float, float]:
    """Return the depths of the near and the far plane in the guest's clip space."""
    return _saved[-1].depth_ends


def farthest_depth() -> float:
    """Return the depth of pixels where nothing has been drawn."""
    return 0.0 if _saved[-1].far_is_less else 1.0


@contextmanager
def aside(ctx: moderngl.Context, target: moderngl.Framebuffer, *, alike: bool = False) -> Iterator[None]:
    """Draw into other framebuffers or buffers, while a guest in the bound `target`; without blending and depth test.

    Depth is not reversed there, unless it is in `target` and `alike` is set.
    """
    is_boxed = _saved[-1].gl.glIsEnabled(ENUMS["SCISSOR_TEST"])
    viewport, scissor, was_reversed = target.viewport, target.scissor, _saved[-1].is_reversed
    ctx.enable_only(moderngl.NOTHING)
    _saved[-1].set_depth(is_reversed=was_reversed and alike)
    set_depth_test(ctx, "<=")
    try:
        yield
    finally:
        _saved[-1].set_depth(is_reversed=was_reversed)
        set_depth_test(ctx, "<=")
        target.use()
        target.viewport = viewport
        target.scissor = scissor if is_boxed else None  # type: ignore[assignment]
        if target.glo == _saved[-1].framebuffer:
            _saved[-1].restrict_colour()


def clear(target: moderngl.Framebuffer, *, depth: float | None = None, color: float = 0.0) -> None:
    """Clear a framebuffer that is bound: all colours to `color`, and its depth to `depth` where it has one.

    moderngl's own `clear` would leave these as the clear values of the host, who may have set them once for all frames.
    """
    gl, colors = functions_of(target.ctx), (c_float * 4)(*[color] * 4)
    for number in range(len(target.color_attachments or ())):
        gl.glClearBufferfv(ENUMS["COLOR"], number, colors)
    if depth is not None:
        gl.glClearBufferfv(ENUMS["DEPTH"], 0, (c_float * 1)(depth))


@contextmanager
def colourless(target: moderngl.Framebuffer) -> Iterator[None]:
    """Draw into `target`, the bound framebuffer, without writing colour."""
    state = _saved[-1]
    state.gl.glColorMaski(0, 0, 0, 0, 0)
    try:
        yield
    finally:
        state.gl.glColorMaski(0, 1, 1, 1, 1)
        if target.glo == state.framebuffer:
            state.restrict_colour()


@contextmanager
def _moderngl_restored(ctx: moderngl.Context, target: moderngl.Framebuffer, state: State) -> Iterator[None]:
    """Restore moderngl's own record of GL state in the end, for a host that draws with moderngl."""
    host = _host_framebuffer(ctx, target)
    viewport, scissor, writes_depth = target.viewport, target.scissor, target.depth_mask
    before = ctx.front_face, ctx.cull_face, ctx.wireframe
    try:
        yield
    finally:
        target.viewport, target.depth_mask = viewport, writes_depth
        target.scissor = scissor if scissor != (0, 0, *target.size) else None  # type: ignore[assignment]
        host.use()
        ctx.enable_only(state.flags)
        ctx.front_face, ctx.cull_face, ctx.wireframe = before


def _bound(ctx: moderngl.Context) -> moderngl.Framebuffer:
    """Return the framebuffer that the host has bound; its `size` may be out of date, where the host has resized it."""
    state = _saved[-1]
    return _detected(ctx, (state.gl.number("DRAW_FRAMEBUFFER_BINDING"), state.outputs.has_several))


@lru_cache(maxsize=256)
def _detected(ctx: moderngl.Context, sort: tuple[int, bool], /) -> moderngl.Framebuffer:
    """Return moderngl's object of the bound framebuffer, of this number and with several outputs or not.

    moderngl never frees such an object, so that one a frame would fill the memory. Viewport and scissor box are set
    whenever it is drawn into, and other outputs than the first are restored where there are several: so it serves
    until the host gives its number to another sort.

    moderngl binds the first colour texture as 2D to query the size. Where that texture has several samples or layers,
    this leaves a GL error, which the host would take for its own.
    """
    found = ctx.detect_framebuffer()
    if sort[0] and is_not_plain_2d(functions_of(ctx)):
        _ = ctx.error
    return found


def _host_framebuffer(ctx: moderngl.Context, target: moderngl.Framebuffer) -> moderngl.Framebuffer:
    """Return the host's own moderngl object of its bound framebuffer, or `target` where it has none."""
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
    state.restrict_colour()
