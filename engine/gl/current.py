"""The current GL context, whoever made it: its functions, and a moderngl context of our own that wraps it.

moderngl's default context is the one made last. A host with several windows makes several, and moderngl cannot tell
which belongs to the current window. So the host's moderngl contexts are not used: a moderngl context of our own caches
state for us alone.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any

import moderngl

from .functions import ENUMS, Functions, functions_of_loader
from .units import SCRATCH_UNIT

LIBRARIES = {
    "linux": (
        ("libEGL.so.1", "eglGetCurrentContext"), ("libGLX.so.0", "glXGetCurrentContext"),
        ("libGL.so.1", "glXGetCurrentContext"),
    ),
    "win32": (("opengl32.dll", "wglGetCurrentContext"),),
    "darwin": (("/System/Library/Frameworks/OpenGL.framework/OpenGL", "CGLGetCurrentContext"),),
}  # fmt: skip
"""Libraries and their functions that return the current context, by platform; only loaded libraries are called."""

Handle = tuple[int, ...]
"""Addresses of the current context, one for each library that has one; a later context may get the same address."""


_queries: dict[tuple[str, str], Callable[[], int | None]] = {}


def _look_for_libraries() -> None:
    for library, name in LIBRARIES.get(sys.platform, ()):
        with suppress(OSError, AttributeError):
            loaded = ctypes.CDLL(library, mode=getattr(os, "RTLD_NOLOAD", 0) | getattr(os, "RTLD_LAZY", 0))
            query = getattr(loaded, name)
            query.restype = ctypes.c_void_p
            _queries[library, name] = query


def current_handle() -> Handle:
    """Return the handle of the context that is current in this thread; () where none is, or where it is unknown."""
    found = tuple(handle for query in _queries.values() if (handle := query()))
    if not found:  # libraries may have been loaded meanwhile
        _look_for_libraries()
        found = tuple(handle for query in _queries.values() if (handle := query()))
    return found


def current_functions() -> Functions:
    """Return the functions of the current context; RuntimeError where there is none.

    The context's state stays as it is; a new moderngl context would change it.
    """
    return functions_of_loader(_loader(current_handle()))


def own_context() -> moderngl.Context:
    """Return our own moderngl context for the current GL context; moderngl's default context stays the host's."""
    return _made(current_handle())


def is_own(ctx: moderngl.Context, /) -> bool:
    """Return whether `own_context` made a moderngl context."""
    return ctx.extra is _OWN


_OWN = object()


@lru_cache(maxsize=8)
def _loader(_handle: Handle) -> Any:
    """Return moderngl's loader of GL functions for the current context: on Windows they may differ by context."""
    try:
        return sys.modules["_moderngl"].DefaultLoader()
    except Exception as error:  # it raises nothing narrower
        raise RuntimeError(
            f"there is no GL context ({error}): create the window before the prairie is first drawn, or pass ctx"
        ) from error


@lru_cache(maxsize=8)
def _made(handle: Handle) -> moderngl.Context:
    store: Any = moderngl._store  # type: ignore[attr-defined]  # noqa: SLF001 - making a context replaces the default
    before, gl = store.default_context, functions_of_loader(_loader(handle))
    target, drawn = ENUMS["DRAW_FRAMEBUFFER"], gl.number("DRAW_FRAMEBUFFER_BINDING")
    gl.glBindFramebuffer(target, 0)  # to ask for its size, moderngl would bind its texture to a unit of the host
    try:
        ctx = moderngl.create_context(context=_loader(handle))
    finally:
        store.default_context = before
        gl.glBindFramebuffer(target, drawn)
    ctx.extra, ctx.default_texture_unit = _OWN, SCRATCH_UNIT
    gl.glDisable(ENUMS["TEXTURE_CUBE_MAP_SEAMLESS"])  # moderngl has set it
    return ctx
