"""The host's side of GL: its pyglet contexts, and its state. The only module that uses `pyglet.gl`, and never loads it.

A host that does not draw with pyglet has no `pyglet.gl` loaded; then there are no contexts here, and its state is read
and brought back with GL's own functions.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import addressof, c_int, c_int64
from typing import Any

import moderngl
import numpy as np

from ...components.arrays import Floats
from .functions import NUMBERS, Functions
from .limits import Limits
from .outputs import Outputs
from .units import Units
from .viewports import Viewports

Box = tuple[int, int, int, int]

AS_EVER = NUMBERS["LOWER_LEFT"], NUMBERS["NEGATIVE_ONE_TO_ONE"]
"""Clip space as OpenGL has it where nobody says otherwise."""

MODERNGLS = ("BLEND", "CULL_FACE", "DEPTH_TEST", "PROGRAM_POINT_SIZE", "RASTERIZER_DISCARD")
"""The switches that moderngl knows, by the same names: a guest sets them itself."""

SWITCHED_OFF = (
    "COLOR_LOGIC_OP", "DEPTH_CLAMP", "POLYGON_OFFSET_FILL", "SAMPLE_ALPHA_TO_COVERAGE", "SAMPLE_COVERAGE",
    "CLIP_DISTANCE0", "CLIP_DISTANCE1", "PRIMITIVE_RESTART", "TEXTURE_CUBE_MAP_SEAMLESS",
)  # fmt: skip
"""Those that moderngl leaves as they are, and that would change a guest's picture: they are off while it draws.

No picture of ours is a cube map, but Mesa's software rasteriser compiles every program once for either.
"""

SWITCHES = (*MODERNGLS, *SWITCHED_OFF, "SCISSOR_TEST")
"""All that are brought back: a guest keeps to the scissor box.

Stencil test and FRAMEBUFFER_SRGB are the host's own affair: a guest is drawn under them and never sets them.
"""

BLEND = ("BLEND_SRC_RGB", "BLEND_DST_RGB", "BLEND_SRC_ALPHA", "BLEND_DST_ALPHA")

ALIGNMENTS = ("UNPACK_ALIGNMENT", "PACK_ALIGNMENT")
"""How rows of texels are aligned: moderngl sets it whenever it loads or reads some."""

LAYOUTS = tuple(
    f"{way}_{name}"
    for way in ("UNPACK", "PACK")
    for name in ("SWAP_BYTES", "LSB_FIRST", "ROW_LENGTH", "IMAGE_HEIGHT", "SKIP_ROWS", "SKIP_PIXELS", "SKIP_IMAGES")
)
"""How else texels lie in memory; moderngl takes for granted that each of these is 0."""

FEEDBACK = "TRANSFORM_FEEDBACK_BUFFER"
TEXELS = ("PIXEL_UNPACK_BUFFER", "PIXEL_PACK_BUFFER")
"""Buffers that texels would be loaded from, or read into, in place of memory."""

COPIED = ("COPY_READ_BUFFER", "COPY_WRITE_BUFFER")
"""Buffers that moderngl copies from and to."""

TARGETS = ("ARRAY_BUFFER", "UNIFORM_BUFFER", *TEXELS, *COPIED, FEEDBACK)

REMEMBERED = (
    *((name, 1) for name in (*BLEND, *ALIGNMENTS, *LAYOUTS, *(f"{target}_BINDING" for target in TARGETS))),
    ("CURRENT_PROGRAM", 1), ("VERTEX_ARRAY_BINDING", 1), ("DRAW_FRAMEBUFFER_BINDING", 1),
    ("READ_FRAMEBUFFER_BINDING", 1), ("RENDERBUFFER_BINDING", 1), ("ACTIVE_TEXTURE", 1), ("POLYGON_MODE", 2),
    ("FRONT_FACE", 1), ("CULL_FACE_MODE", 1), ("DEPTH_FUNC", 1), ("DEPTH_WRITEMASK", 1), ("COLOR_WRITEMASK", 4),
    ("BLEND_EQUATION_RGB", 1), ("BLEND_EQUATION_ALPHA", 1), ("VIEWPORT", 4), ("SCISSOR_BOX", 4),
    ("PRIMITIVE_RESTART_INDEX", 1), ("PROVOKING_VERTEX", 1), ("DEPTH_RANGE", 2),
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


def has_windows() -> bool:
    """Return whether a window of pyglet's is open, current or not."""
    app = sys.modules.get("pyglet.app")
    return app is not None and len(app.windows) > 0


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
    """The numbers of what a state is made of, and a buffer for each of its values."""

    def __init__(self) -> None:
        self.switches = [(name, NUMBERS[name]) for name in SWITCHES]
        found = [(name, (c_int * count)()) for name, count in REMEMBERED]
        # Addresses are handed over as numbers: ctypes takes them faster than arrays.
        self.values = [(name, NUMBERS[name], addressof(values), values) for name, values in found]
        self.off = [(name, NUMBERS[name]) for name in SWITCHED_OFF]
        self.stores = [(name, NUMBERS[name]) for name in (*ALIGNMENTS, *LAYOUTS)]
        self.layouts = [NUMBERS[name] for name in LAYOUTS]
        self.texels = [NUMBERS[name] for name in TEXELS]
        self.targets = [(f"{name}_BINDING", NUMBERS[name]) for name in TARGETS]


WORDS = Words()


class State:
    """The host's GL state at one moment, which `restore` brings back.

    `limits` is what its context has, and `unit` the texture unit that moderngl loads textures on.
    """

    def __init__(self, gl: Functions, limits: Limits, unit: int) -> None:
        self.gl = gl
        self._on = {name for name, switch in WORDS.switches if gl.glIsEnabled(switch)}
        for _, number, address, _ in WORDS.values:
            gl.glGetIntegerv(number, address)
        self._value: dict[str, list[int]] = {name: found[:] for name, _, _, found in WORDS.values}
        self._clip = AS_EVER
        if limits.clipped:
            self._clip = gl.number("CLIP_ORIGIN"), gl.number("CLIP_DEPTH_MODE")
        self._feedback = _feedback(gl)
        self._outputs = Outputs(gl, self.framebuffer, blends="BLEND" in self._on)
        self._viewports = Viewports(gl, limits.viewports)
        self._units = Units(gl, unit)
        self.is_reversed = False
        """Whether depth is less farther off in what a guest draws now; `look` says so."""
        gl.glActiveTexture(*self._value["ACTIVE_TEXTURE"])

    @property
    def viewport(self) -> Box:
        """Where the host draws [pixels]."""
        x, y, width, height = self._value["VIEWPORT"]
        return x, y, width, height

    @property
    def scissor(self) -> Box | None:
        """What the host cuts off everything outside of [pixels]; None where it cuts nothing off."""
        x, y, width, height = self._value["SCISSOR_BOX"]
        return (x, y, width, height) if "SCISSOR_TEST" in self._on else None

    @property
    def framebuffer(self) -> int:
        """What the host draws into: the number of a framebuffer, 0 for its window."""
        return self._value["DRAW_FRAMEBUFFER_BINDING"][0]

    @property
    def flags(self) -> int:
        """What the host has enabled of what moderngl knows, in moderngl's flags."""
        return sum(getattr(moderngl, name) for name in MODERNGLS if name in self._on)

    def clip(self, *, keeps_depth: bool = False) -> Floats | None:
        """Return what brings the host's clip space to that of `AS_EVER`, (4, 4); None where it is that.

        A host may have turned it over, or let depth run from 0 to 1 in it. That stays so where it `keeps_depth`.
        """
        if self._clip == AS_EVER:
            return None
        found = np.eye(4, dtype=np.float32)
        if self._clip[0] != AS_EVER[0]:
            found[1, 1] = -1.0
        if self._from_zero and not keeps_depth:
            found[2, 2:] = 2.0, -1.0
        return found

    def look(self, *, is_reversed: bool) -> None:
        """Let depth be the host's own where it is reversed, which is finest near 0, and usual otherwise."""
        self.is_reversed = is_reversed
        if self._from_zero:
            self.gl.glClipControl(AS_EVER[0], self._clip[1] if is_reversed else AS_EVER[1])

    @property
    def ends(self) -> tuple[float, float]:
        """Depths of the near and the far end of the clip space that a guest draws in now."""
        if not self.is_reversed:
            return -1.0, 1.0
        return 1.0, 0.0 if self._from_zero else -1.0

    @property
    def is_turned(self) -> bool:
        """Whether less is farther off in the depth that a guest writes now: the host may have turned its range, too."""
        first, last = self._value["DEPTH_RANGE"]
        return self.is_reversed != (first > last)

    @property
    def _from_zero(self) -> bool:
        return self._clip[1] != AS_EVER[1]

    def clear(self) -> None:
        """Set back what moderngl leaves and what would change a guest's picture, or the texels it loads and reads."""
        gl = self.gl
        for name, switch in WORDS.off:
            if name in self._on:
                gl.glDisable(switch)
        for store in WORDS.layouts:
            gl.glPixelStorei(store, 0)
        for target in WORDS.texels:
            gl.glBindBuffer(target, 0)
        self._units.clear()
        gl.glProvokingVertex(NUMBERS["LAST_VERTEX_CONVENTION"])
        if self._clip != AS_EVER:
            gl.glClipControl(*AS_EVER)

    def borrow(self, unit: int, texture: int) -> None:
        """Bind a 2D texture to a unit of the host's own, until it is brought back."""
        self._units.borrow(unit, texture)

    def narrow(self) -> None:
        """Let colour through where the host lets it: to its first output, in the colours that its mask has."""
        self._outputs.narrow()
        self.gl.glColorMaski(0, *self._value["COLOR_WRITEMASK"])

    def restore(self) -> None:
        """Bring it all back."""
        gl, value = self.gl, self._value
        for name, switch in WORDS.switches:
            (gl.glEnable if name in self._on else gl.glDisable)(switch)
        for target in ("DRAW_FRAMEBUFFER", "READ_FRAMEBUFFER"):
            gl.glBindFramebuffer(NUMBERS[target], gl.living("Framebuffer", *value[f"{target}_BINDING"]))
        gl.glViewport(*value["VIEWPORT"])
        gl.glScissor(*value["SCISSOR_BOX"])
        gl.glPolygonMode(NUMBERS["FRONT_AND_BACK"], value["POLYGON_MODE"][0])
        gl.glFrontFace(*value["FRONT_FACE"])
        gl.glCullFace(*value["CULL_FACE_MODE"])
        gl.glDepthFunc(*value["DEPTH_FUNC"])
        gl.glDepthMask(*value["DEPTH_WRITEMASK"])
        gl.glColorMaski(0, *value["COLOR_WRITEMASK"])
        self._outputs.restore()
        gl.glBlendFuncSeparate(*(value[name][0] for name in BLEND))
        gl.glBlendEquationSeparate(*value["BLEND_EQUATION_RGB"], *value["BLEND_EQUATION_ALPHA"])
        gl.glPrimitiveRestartIndex(*value["PRIMITIVE_RESTART_INDEX"])
        gl.glProvokingVertex(*value["PROVOKING_VERTEX"])
        self._viewports.restore()
        if self._clip != AS_EVER:
            gl.glClipControl(*self._clip)
        self._bind()

    def _bind(self) -> None:
        gl, value = self.gl, self._value
        for name, store in WORDS.stores:
            gl.glPixelStorei(store, *value[name])
        gl.glUseProgram(gl.living("Program", *value["CURRENT_PROGRAM"]))
        gl.glBindVertexArray(gl.living("VertexArray", *value["VERTEX_ARRAY_BINDING"]))
        buffer, start, size = self._feedback
        buffer = gl.living("Buffer", buffer)
        # What was bound as a whole has no size. Either call binds the target itself too, so it comes before the others.
        if buffer and size:
            gl.glBindBufferRange(NUMBERS[FEEDBACK], 0, buffer, start, size)
        else:
            gl.glBindBufferBase(NUMBERS[FEEDBACK], 0, buffer)
        for name, target in WORDS.targets:
            gl.glBindBuffer(target, gl.living("Buffer", *value[name]))
        gl.glBindRenderbuffer(NUMBERS["RENDERBUFFER"], gl.living("Renderbuffer", *value["RENDERBUFFER_BINDING"]))
        self._units.restore()
        gl.glActiveTexture(*value["ACTIVE_TEXTURE"])


def _feedback(gl: Functions) -> tuple[int, int, int]:
    """Return the buffer that the first of the captured outputs goes to, and from where how far [bytes]."""
    buffer, span = c_int(), (c_int64(), c_int64())
    gl.glGetIntegeri_v(NUMBERS[f"{FEEDBACK}_BINDING"], 0, addressof(buffer))
    for name, found in zip(("START", "SIZE"), span, strict=True):
        gl.glGetInteger64i_v(NUMBERS[f"{FEEDBACK}_{name}"], 0, addressof(found))
    return buffer.value, span[0].value, span[1].value
