"""Limits and abilities of a GL context, queried once; only what the version knows, as GL errors would be the host's."""

import re
from ctypes import c_int
from dataclasses import dataclass
from functools import lru_cache

from .functions import ENUMS, Functions

OLDEST = (3, 3)
"""The oldest OpenGL version that is supported."""


@dataclass(frozen=True, slots=True)
class Limits:
    """Version, limits and abilities of a GL context."""

    version: tuple[int, int]
    renderer: str
    layers: int
    """Greatest number of layers of a texture array, at least 256."""

    bindings: int
    """Number of binding points for uniform blocks, at least 36."""

    side: int
    """Greatest number of texels along a side of a texture, at least 1024."""

    timed: bool
    """Whether timer queries work: a driver may have them with no bits at all."""

    clipped: bool
    """Whether there is `glClipControl`, so that the host may have changed its clip space."""

    parallel_compile: str
    """Prefix of its `GL_..._parallel_shader_compile`, which compiles in the driver's threads; "" where it has none."""

    viewports: int
    """Number of indexed viewports and scissors; 1 where they cannot be indexed."""


@lru_cache(maxsize=16)
def limits_of(gl: Functions) -> Limits:
    """Return the limits of the current context; RuntimeError, in one sentence, where it is too old or OpenGL ES."""
    version, embedded = version_of(gl)
    if version == (0, 0):
        raise RuntimeError("there is no GL context: create the window before the prairie is first drawn, or pass ctx")
    if embedded or version < OLDEST:
        found = f"OpenGL{' ES' if embedded else ''} {version[0]}.{version[1]}"
        raise RuntimeError(
            f"a prairie is drawn with OpenGL 3.3 or newer, and this context has {found}: ask for version 3.3 and a "
            "core profile when the window is made, on macOS for a forward compatible one too"
        )
    numbers = range(gl.number("NUM_EXTENSIONS"))
    extensions = {_text(gl.glGetStringi(ENUMS["EXTENSIONS"], number)) for number in numbers}
    several = version >= (4, 1) or "GL_ARB_viewport_array" in extensions
    bits = (c_int * 1)()
    gl.glGetQueryiv(ENUMS["TIMESTAMP"], ENUMS["QUERY_COUNTER_BITS"], bits)
    return Limits(
        version=version,
        renderer=_text(gl.glGetString(ENUMS["RENDERER"])),
        layers=gl.number("MAX_ARRAY_TEXTURE_LAYERS"),
        bindings=gl.number("MAX_UNIFORM_BUFFER_BINDINGS"),
        side=gl.number("MAX_TEXTURE_SIZE"),
        timed=bits[0] > 0,
        clipped=version >= (4, 5) or "GL_ARB_clip_control" in extensions,
        parallel_compile=next((by for by in ("KHR", "ARB") if f"GL_{by}_parallel_shader_compile" in extensions), ""),
        viewports=gl.number("MAX_VIEWPORTS") if several else 1,
    )


def version_of(gl: Functions, /) -> tuple[tuple[int, int], bool]:
    """Return the version of the current context, and whether it is OpenGL ES; (0, 0) where no context is current."""
    text = _text(gl.glGetString(ENUMS["VERSION"]))
    number = re.search(r"(\d+)\.(\d+)", text)
    return (int(number[1]), int(number[2])) if number else (0, 0), text.startswith("OpenGL ES")


def _text(text: bytes | None) -> str:
    return (text or b"").decode("utf-8", "replace")
