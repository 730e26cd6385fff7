"""The host's side of GL: its pyglet contexts, and its state. The only module that uses `pyglet.gl`, and never loads it.

A host that does not draw with pyglet has no `pyglet.gl` loaded; then everything here says so and does nothing.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from typing import Any

Box = tuple[int, int, int, int]

SWITCHES = (
    "BLEND", "CULL_FACE", "DEPTH_TEST", "PROGRAM_POINT_SIZE", "RASTERIZER_DISCARD", "COLOR_LOGIC_OP", "DEPTH_CLAMP",
    "POLYGON_OFFSET_FILL", "SAMPLE_ALPHA_TO_COVERAGE", "SAMPLE_COVERAGE", "CLIP_DISTANCE0", "CLIP_DISTANCE1",
    "PRIMITIVE_RESTART", "SCISSOR_TEST",
)  # fmt: skip
"""What may be enabled and would change a picture; stencil test and sRGB are the host's own affair."""

BLEND = ("BLEND_SRC_RGB", "BLEND_DST_RGB", "BLEND_SRC_ALPHA", "BLEND_DST_ALPHA")
STORES = ("UNPACK_ALIGNMENT", "UNPACK_ROW_LENGTH", "PACK_ALIGNMENT")
TARGETS = ("ARRAY_BUFFER", "UNIFORM_BUFFER", "PIXEL_UNPACK_BUFFER")

SWITCHED_OFF = SWITCHES[5:-2]
"""Those that are off while a guest draws, and that moderngl does not know."""

NUMBERS = (
    *((name, 1) for name in (*BLEND, *STORES, *(f"{target}_BINDING" for target in TARGETS))),
    ("CURRENT_PROGRAM", 1), ("VERTEX_ARRAY_BINDING", 1), ("DRAW_FRAMEBUFFER_BINDING", 1),
    ("READ_FRAMEBUFFER_BINDING", 1), ("ACTIVE_TEXTURE", 1), ("POLYGON_MODE", 2), ("FRONT_FACE", 1),
    ("CULL_FACE_MODE", 1), ("DEPTH_FUNC", 1), ("DEPTH_WRITEMASK", 1), ("COLOR_WRITEMASK", 4),
    ("BLEND_EQUATION_RGB", 1), ("BLEND_EQUATION_ALPHA", 1), ("VIEWPORT", 4), ("SCISSOR_BOX", 4),
)  # fmt: skip
"""What is remembered besides, and how many numbers each is."""


def loaded_gl() -> Any | None:
    """Return pyglet's GL module if the host draws with pyglet, without ever loading it."""
    module = sys.modules.get("pyglet.gl")
    return module if module is not None and getattr(module, "current_context", None) is not None else None


def pyglet_context() -> Any | None:
    """Return the pyglet context that is current, or None if the host does not draw with pyglet."""
    gl = loaded_gl()
    return None if gl is None else gl.current_context


def is_hidden(context: Any | None) -> bool:
    """Return whether a pyglet context is that of the hidden window that pyglet opens by itself."""
    return context is not None and context is _hidden()


def _hidden() -> Any | None:
    window = getattr(sys.modules.get("pyglet.gl"), "_shadow_window", None)
    return None if window is None else window.context


def is_lost(context: Any | None) -> bool:
    """Return whether a pyglet context has gone with its window."""
    return context is not None and context.canvas is None


@contextmanager
def current(context: Any | None) -> Iterator[bool]:
    """Make a pyglet context current for a while; yields whether objects made in it may be deleted now.

    Of a context that is lost, what it shared is still there as long as the hidden window is: that has no vertex
    arrays of anybody's, so that everything can be deleted in it.
    """
    before, lost = pyglet_context(), is_lost(context)
    place = _hidden() if lost else context
    if place is None or (lost and (is_lost(place) or place.object_space is not context.object_space)):  # type: ignore[union-attr]
        yield not lost
        return
    if place is not before:
        place.set_current()
    try:
        yield True
    finally:
        if before is not None and before is not place and not is_lost(before):
            before.set_current()


class Words:
    """The constants that a state is made of, looked up once, and a buffer for each of its numbers."""

    def __init__(self, gl: Any) -> None:
        self.switches = [(name, getattr(gl, f"GL_{name}")) for name in SWITCHES]
        self.numbers = [(name, getattr(gl, f"GL_{name}"), (gl.GLint * count)()) for name, count in NUMBERS]
        self.off = [(name, getattr(gl, f"GL_{name}")) for name in SWITCHED_OFF]
        self.stores = [(name, getattr(gl, f"GL_{name}")) for name in STORES]
        self.targets = [(f"{name}_BINDING", getattr(gl, f"GL_{name}")) for name in TARGETS]


@lru_cache(maxsize=1)
def _words(gl: Any) -> Words:
    return Words(gl)


class State:
    """The host's GL state at one moment, which `restore` brings back."""

    def __init__(self, gl: Any) -> None:
        self._gl = gl
        self._words = words = _words(gl)
        self._on = {name for name, switch in words.switches if gl.glIsEnabled(switch)}
        for _, number, found in words.numbers:
            gl.glGetIntegerv(number, found)
        self._number: dict[str, list[int]] = {name: found[:] for name, _, found in words.numbers}

    @property
    def viewport(self) -> Box:
        """Where the host draws [pixels]."""
        x, y, width, height = self._number["VIEWPORT"]
        return x, y, width, height

    @property
    def scissor(self) -> Box | None:
        """What the host cuts off everything outside of [pixels]; None where it cuts nothing off."""
        x, y, width, height = self._number["SCISSOR_BOX"]
        return (x, y, width, height) if "SCISSOR_TEST" in self._on else None

    def clear(self) -> None:
        """Switch off what would change a guest's picture or uploads and what moderngl has no word for."""
        gl = self._gl
        for name, switch in self._words.off:
            if name in self._on:
                gl.glDisable(switch)
        gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
        gl.glBindBuffer(gl.GL_PIXEL_UNPACK_BUFFER, 0)

    def restore(self) -> None:
        """Bring it all back."""
        gl, number = self._gl, self._number
        for name, switch in self._words.switches:
            (gl.glEnable if name in self._on else gl.glDisable)(switch)
        gl.glBindFramebuffer(gl.GL_DRAW_FRAMEBUFFER, *number["DRAW_FRAMEBUFFER_BINDING"])
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, *number["READ_FRAMEBUFFER_BINDING"])
        gl.glViewport(*number["VIEWPORT"])
        gl.glScissor(*number["SCISSOR_BOX"])
        gl.glPolygonMode(gl.GL_FRONT_AND_BACK, number["POLYGON_MODE"][0])
        gl.glFrontFace(*number["FRONT_FACE"])
        gl.glCullFace(*number["CULL_FACE_MODE"])
        gl.glDepthFunc(*number["DEPTH_FUNC"])
        gl.glDepthMask(*number["DEPTH_WRITEMASK"])
        gl.glColorMask(*number["COLOR_WRITEMASK"])
        gl.glBlendFuncSeparate(*(number[name][0] for name in BLEND))
        gl.glBlendEquationSeparate(*number["BLEND_EQUATION_RGB"], *number["BLEND_EQUATION_ALPHA"])
        self._bind()

    def _bind(self) -> None:
        gl, number = self._gl, self._number
        for name, store in self._words.stores:
            gl.glPixelStorei(store, *number[name])
        program = number["CURRENT_PROGRAM"][0]
        # One that the host deleted while it was in use is gone by now.
        gl.glUseProgram(program if program and gl.glIsProgram(program) else 0)
        gl.glBindVertexArray(*number["VERTEX_ARRAY_BINDING"])
        for name, target in self._words.targets:
            gl.glBindBuffer(target, *number[name])
        gl.glActiveTexture(*number["ACTIVE_TEXTURE"])
