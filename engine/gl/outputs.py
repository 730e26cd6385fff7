"""Where a host's colours go: the outputs of its fragment shaders, and the attachments that they are written to."""

from ctypes import addressof, c_int, c_ubyte, c_uint

from .functions import NUMBERS, Functions

COUNT = 8
"""How many outputs every OpenGL has."""

OTHERS = range(1, COUNT)
"""All outputs but the first, which alone a guest writes."""


class Outputs:
    """The outputs of the framebuffer that is bound at one moment, which `restore` brings back.

    `framebuffer` is its number, 0 for the window, and `blends` says whether the first output does. Masks are asked for
    where there are several attachments: elsewhere a guest changes that of the first alone.
    """

    def __init__(self, gl: Functions, framebuffer: int, *, blends: bool) -> None:
        self._gl = gl
        blend, self._blends = NUMBERS["BLEND"], blends
        self._unlike = [output for output in OTHERS if bool(gl.glIsEnabledi(blend, output)) != blends]
        self._drawn = _drawn(gl) if framebuffer else None
        several = self._drawn is not None and (any(self._drawn[1:]) or _attached(gl, "COLOR_ATTACHMENT1"))
        self._masks = {output: _mask(gl, output) for output in OTHERS} if several else {}

    def narrow(self) -> None:
        """Write the first output alone, to wherever the host's goes."""
        if self._drawn is not None:
            self._gl.glDrawBuffers(1, (c_uint * 1)(self._drawn[0]))

    def restore(self) -> None:
        """Bring all outputs back, after the first has its own mask and blending."""
        gl = self._gl
        for output in self._unlike:
            (gl.glDisablei if self._blends else gl.glEnablei)(NUMBERS["BLEND"], output)
        for output, mask in self._masks.items():
            gl.glColorMaski(output, *mask)
        if self._drawn is not None:
            gl.glDrawBuffers(COUNT, (c_uint * COUNT)(*self._drawn))


def has_depth(gl: Functions, framebuffer: int, /) -> bool:
    """Return whether the framebuffer that is bound has depth; `framebuffer` is its number, 0 for the window."""
    return _attached(gl, "DEPTH_ATTACHMENT" if framebuffer else "DEPTH")


def is_not_plain_2d(gl: Functions, /) -> bool:
    """Return whether the first colours of a host's framebuffer are a texture that could not be bound just now as 2D."""
    if _asked(gl, "COLOR_ATTACHMENT0", "FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE") != NUMBERS["TEXTURE"]:
        return False
    return gl.number("TEXTURE_BINDING_2D") != _asked(gl, "COLOR_ATTACHMENT0", "FRAMEBUFFER_ATTACHMENT_OBJECT_NAME")


def _drawn(gl: Functions) -> list[int]:
    """Return the attachment of each output."""
    found, first = (c_int * COUNT)(), NUMBERS["DRAW_BUFFER0"]
    start = addressof(found)
    for output in range(COUNT):
        gl.glGetIntegerv(first + output, start + 4 * output)
    return found[:]


def _attached(gl: Functions, name: str) -> bool:
    return _asked(gl, name, "FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE") != NUMBERS["NONE"]


def _asked(gl: Functions, name: str, question: str) -> int:
    found = (c_int * 1)()
    gl.glGetFramebufferAttachmentParameteriv(NUMBERS["DRAW_FRAMEBUFFER"], NUMBERS[name], NUMBERS[question], found)
    return found[0]


def _mask(gl: Functions, output: int) -> tuple[int, ...]:
    found = (c_ubyte * 4)()
    gl.glGetBooleani_v(NUMBERS["COLOR_WRITEMASK"], output, found)
    return tuple(found)
