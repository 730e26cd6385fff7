"""A host's draw buffers: colour outputs of fragment shaders, their attachments, masks and blending."""

from ctypes import addressof, c_int, c_ubyte, c_uint

from .functions import ENUMS, Functions

COUNT = 8
"""Number of outputs that every OpenGL has."""

OTHERS = range(1, COUNT)
"""Outputs that a guest does not write: all but the first."""


class Outputs:
    """Snapshot of the bound framebuffer's outputs, which `restore` brings back.

    `framebuffer` is its number, 0 for the window; `blends` says whether the first output does. Masks are queried only
    where there are several attachments: elsewhere a guest changes the first mask alone.
    """

    def __init__(self, gl: Functions, framebuffer: int, *, blends: bool) -> None:
        self._gl = gl
        blend, self._blends = ENUMS["BLEND"], blends
        self._unlike = [output for output in OTHERS if bool(gl.glIsEnabledi(blend, output)) != blends]
        self._drawn = _drawn(gl) if framebuffer else None
        self.has_several = self._drawn is not None and (any(self._drawn[1:]) or _attached(gl, "COLOR_ATTACHMENT1"))
        """Whether there may be several attachments."""
        self._masks = {output: _mask(gl, output) for output in OTHERS} if self.has_several else {}

    def restrict(self) -> None:
        """Write the first output alone, to the host's attachment of it."""
        if self._drawn is not None:
            self._gl.glDrawBuffers(1, (c_uint * 1)(self._drawn[0]))

    def restore(self) -> None:
        """Restore all outputs; call it after the first output's mask and blending are restored."""
        gl = self._gl
        for output in self._unlike:
            (gl.glDisablei if self._blends else gl.glEnablei)(ENUMS["BLEND"], output)
        for output, mask in self._masks.items():
            gl.glColorMaski(output, *mask)
        if self._drawn is not None:
            gl.glDrawBuffers(COUNT, (c_uint * COUNT)(*self._drawn))


def has_depth(gl: Functions, framebuffer: int, /) -> bool:
    """Return whether the bound framebuffer has depth; `framebuffer` is its number, 0 for the window."""
    return _attached(gl, "DEPTH_ATTACHMENT" if framebuffer else "DEPTH")


def is_not_plain_2d(gl: Functions, /) -> bool:
    """Return whether the first colour attachment is a texture that moderngl has just failed to bind as a 2D texture."""
    if _asked(gl, "COLOR_ATTACHMENT0", "FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE") != ENUMS["TEXTURE"]:
        return False
    return gl.number("TEXTURE_BINDING_2D") != _asked(gl, "COLOR_ATTACHMENT0", "FRAMEBUFFER_ATTACHMENT_OBJECT_NAME")


def _drawn(gl: Functions) -> list[int]:
    """Return the attachment (draw buffer) of each output."""
    found, first = (c_int * COUNT)(), ENUMS["DRAW_BUFFER0"]
    start = addressof(found)
    for output in range(COUNT):
        gl.glGetIntegerv(first + output, start + 4 * output)
    return found[:]


def _attached(gl: Functions, name: str) -> bool:
    return _asked(gl, name, "FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE") != ENUMS["NONE"]


def _asked(gl: Functions, name: str, question: str) -> int:
    found = (c_int * 1)()
    gl.glGetFramebufferAttachmentParameteriv(ENUMS["DRAW_FRAMEBUFFER"], ENUMS[name], ENUMS[question], found)
    return found[0]


def _mask(gl: Functions, output: int) -> tuple[int, ...]:
    found = (c_ubyte * 4)()
    gl.glGetBooleani_v(ENUMS["COLOR_WRITEMASK"], output, found)
    return tuple(found)
