"""What a GL context has: asked for once, and never of what it may not know, which would leave the host an error."""

import re
from ctypes import c_int
from dataclasses import dataclass
from functools import lru_cache

from .functions import NUMBERS, Functions

OLDEST = (3, 3)
"""The oldest OpenGL that will do."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What a context is, and how much it has of what not all have alike."""

    version: tuple[int, int]
    renderer: str
    layers: int
    """Layers of a texture array, 256 at least."""

    bindings: int
    """Uniform blocks that may be bound, 36 at least."""

    side: int
    """Texels along a side of a texture, 1024 at least."""

    timed: bool
    """Whether it can tell the time: a timer may have no bits at all."""

    clipped: bool
    """Whether the host may have turned clip space over, or its depth from 0 to 1 (`glClipControl`)."""

    beside: str
    """Whose `GL_..._parallel_shader_compile` it has, to make programs in threads of its own; "" for nobody's."""

    viewports: int
    """Viewports and scissors by index, 1 where there are none."""


@lru_cache(maxsize=16)
def limits_of(gl: Functions) -> Limits:
    """Return what the current context has; RuntimeError, in one sentence, where it is too old or OpenGL ES."""
    version, embedded = version_of(gl)
    if version == (0, 0):
        raise RuntimeError("there is no GL context: create the window before the prairie is first drawn, or pass ctx")
    if embedded or version < OLDEST:
        found = f"OpenGL{' ES' if embedded else ''} {version[0]}.{version[1]}"
        raise RuntimeError(
            f"a prairie is drawn with OpenGL 3.3 or newer, and this context has {found}: ask for version 3.3 and a "
            "core profile when the window is made, on macOS for a forward compatible one too"
        )
    extensions = _extensions(gl)
    several = version >= (4, 1) or "GL_ARB_viewport_array" in extensions
    bits = (c_int * 1)()
    gl.glGetQueryiv(NUMBERS["TIMESTAMP"], NUMBERS["QUERY_COUNTER_BITS"], bits)
    return Limits(
        version=version,
        renderer=_told(gl.glGetString(NUMBERS["RENDERER"])),
        layers=gl.number("MAX_ARRAY_TEXTURE_LAYERS"),
        bindings=gl.number("MAX_UNIFORM_BUFFER_BINDINGS"),
        side=gl.number("MAX_TEXTURE_SIZE"),
        timed=bits[0] > 0,
        clipped=version >= (4, 5) or "GL_ARB_clip_control" in extensions,
        beside=next((by for by in ("KHR", "ARB") if f"GL_{by}_parallel_shader_compile" in extensions), ""),
        viewports=gl.number("MAX_VIEWPORTS") if several else 1,
    )


def version_of(gl: Functions, /) -> tuple[tuple[int, int], bool]:
    """Return the version of the current context, and whether it is OpenGL ES; (0, 0) where no context is current."""
    told = _told(gl.glGetString(NUMBERS["VERSION"]))
    number = re.search(r"(\d+)\.(\d+)", told)
    return (int(number[1]), int(number[2])) if number else (0, 0), told.startswith("OpenGL ES")


def _extensions(gl: Functions) -> frozenset[str]:
    numbers = range(gl.number("NUM_EXTENSIONS"))
    return frozenset(_told(gl.glGetStringi(NUMBERS["EXTENSIONS"], number)) for number in numbers)


def _told(text: bytes | None) -> str:
    return (text or b"").decode("utf-8", "replace")
