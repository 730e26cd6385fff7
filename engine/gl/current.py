"""The GL context that is current, whoever made it: its functions, and moderngl's context of our own in it.

moderngl has a default context, the last one that was made. A host that has several windows makes several, and which of
them belongs to the window that is current, moderngl cannot say. So nothing of the host's is asked for: what moderngl
remembers in a context of ours is nobody else's affair.
"""

import ctypes
import os
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from typing import Any

import moderngl

from .functions import NUMBERS, Functions, functions_of_loader
from .units import SCRATCH_UNIT

LIBRARIES = {
    "linux": (
        ("libEGL.so.1", "eglGetCurrentContext"), ("libGLX.so.0", "glXGetCurrentContext"),
        ("libGL.so.1", "glXGetCurrentContext"),
    ),
    "win32": (("opengl32.dll", "wglGetCurrentContext"),),
    "darwin": (("/System/Library/Frameworks/OpenGL.framework/OpenGL", "CGLGetCurrentContext"),),
}  # fmt: skip
"""What says which context is current, by platform; of a library that is not loaded, none is."""

Handle = tuple[int, ...]
"""The address of the context that is current; one that is made later may have it again."""


_ask: dict[tuple[str, str], Callable[[], int | None]] = {}


def _look_for_libraries() -> None:
    for library, name in LIBRARIES.get(sys.platform, ()):
        with suppress(OSError, AttributeError):
            loaded = ctypes.CDLL(library, mode=getattr(os, "RTLD_NOLOAD", 0) | getattr(os, "RTLD_LAZY", 0))
            asked = getattr(loaded, name)
            asked.restype = ctypes.c_void_p
            _ask[library, name] = asked


def current_handle() -> Handle:
    """Return which context is current in this thread, () where none is, or where nobody can say."""
    found = tuple(handle for ask in _ask.values() if (handle := ask()))
    if not found:  # libraries may have been loaded meanwhile
        _look_for_libraries()
        found = tuple(handle for ask in _ask.values() if (handle := ask()))
    return found


def current_functions() -> Functions:
    """Return the functions of the context that is current, and leave its state alone: a new moderngl context would not.

    RuntimeError where there is none.
    """
    return functions_of_loader(_loader(current_handle()))


def own_context() -> moderngl.Context:
    """Return moderngl's context of our own in the context that is current; the host's default one stays what it is."""
    return _made(current_handle())


def is_own(ctx: moderngl.Context, /) -> bool:
    """Return whether a context of moderngl's is one that `own_context` made."""
    return ctx.extra is _OWN


_OWN = object()


@lru_cache(maxsize=8)
def _loader(_handle: Handle) -> Any:
    """Return what finds GL's functions in the context that is current: on Windows each may have others."""
    try:
        return sys.modules["_moderngl"].DefaultLoader()
    except Exception as error:  # it raises nothing narrower
        raise RuntimeError(
            f"there is no GL context ({error}): create the window before the prairie is first drawn, or pass ctx"
        ) from error


@lru_cache(maxsize=8)
def _made(handle: Handle) -> moderngl.Context:
    store: Any = moderngl._store  # type: ignore[attr-defined]  # noqa: SLF001 - making a context replaces the default
    before = store.default_context
    try:
        ctx = moderngl.create_context(context=_loader(handle))
    finally:
        store.default_context = before
    ctx.extra, ctx.default_texture_unit = _OWN, SCRATCH_UNIT
    functions_of_loader(_loader(handle)).glDisable(NUMBERS["TEXTURE_CUBE_MAP_SEAMLESS"])  # moderngl has set it
    return ctx
