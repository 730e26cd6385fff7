"""The host's pyglet contexts and its GL state. The only module that uses `pyglet.gl`, without ever importing it.

A host that does not draw with pyglet has no `pyglet.gl` loaded, and so no pyglet contexts. GL state is saved and
restored by GL's own functions.
"""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import addressof, c_int, c_int64
from typing import Any

import moderngl
import numpy as np

from ...components.arrays import Floats
from .functions import ENUMS, Functions
from .limits import Limits
from .outputs import Outputs
from .units import Units
from .viewports import Box, Viewports

DEFAULT_CLIP = ENUMS["LOWER_LEFT"], ENUMS["NEGATIVE_ONE_TO_ONE"]
"""OpenGL's default clip space: origin and depth mode of `glClipControl`."""

MODERNGLS = ("BLEND", "CULL_FACE", "DEPTH_TEST", "PROGRAM_POINT_SIZE", "RASTERIZER_DISCARD")
"""Capabilities of `glEnable` that moderngl knows by the same names; a guest sets them itself."""

SWITCHED_OFF = (
    "COLOR_LOGIC_OP", "DEPTH_CLAMP", "POLYGON_OFFSET_FILL", "POLYGON_SMOOTH", "SAMPLE_ALPHA_TO_COVERAGE",
    "SAMPLE_COVERAGE", "CLIP_DISTANCE0", "CLIP_DISTANCE1", "PRIMITIVE_RESTART", "TEXTURE_CUBE_MAP_SEAMLESS",
)  # fmt: skip
"""Capabilities that moderngl does not set and that would change a guest's picture: they are off while it draws.

No texture here is a cube map, but Mesa's software rasteriser compiles every program again when seamlessness changes.
"""

SWITCHES = (*MODERNGLS, *SWITCHED_OFF, "SCISSOR_TEST")
"""Capabilities that are restored. A guest draws within the host's scissor box.

Stencil test and FRAMEBUFFER_SRGB are left as the host has set them.
"""

BLEND = ("BLEND_SRC_RGB", "BLEND_DST_RGB", "BLEND_SRC_ALPHA", "BLEND_DST_ALPHA")

ALIGNMENTS = ("UNPACK_ALIGNMENT", "PACK_ALIGNMENT")
"""Alignment of rows of texels, which moderngl sets at each upload and download."""

LAYOUTS = tuple(
    f"{way}_{name}"
    for way in ("UNPACK", "PACK")
    for name in ("SWAP_BYTES", "LSB_FIRST", "ROW_LENGTH", "IMAGE_HEIGHT", "SKIP_ROWS", "SKIP_PIXELS", "SKIP_IMAGES")
)
"""Other layout of texels in memory; moderngl assumes that each of these is 0."""

FEEDBACK = "TRANSFORM_FEEDBACK_BUFFER"
TEXELS = ("PIXEL_UNPACK_BUFFER", "PIXEL_PACK_BUFFER")
"""Targets of buffers that texels would be loaded from, or read into, in place of memory."""

COPIED = ("COPY_READ_BUFFER", "COPY_WRITE_BUFFER")
"""Targets of buffers that moderngl copies from and to."""

TARGETS = ("ARRAY_BUFFER", "UNIFORM_BUFFER", *TEXELS, *COPIED, FEEDBACK)

REMEMBERED = (
    *((name, 1) for name in (*BLEND, *ALIGNMENTS, *LAYOUTS, *(f"{target}_BINDING" for target in TARGETS))),
    ("CURRENT_PROGRAM", 1), ("VERTEX_ARRAY_BINDING", 1), ("DRAW_FRAMEBUFFER_BINDING", 1),
    ("READ_FRAMEBUFFER_BINDING", 1), ("RENDERBUFFER_BINDING", 1), ("ACTIVE_TEXTURE", 1), ("POLYGON_MODE", 2),
    ("FRONT_FACE", 1), ("CULL_FACE_MODE", 1), ("DEPTH_FUNC", 1), ("DEPTH_WRITEMASK", 1), ("COLOR_WRITEMASK", 4),
    ("BLEND_EQUATION_RGB", 1), ("BLEND_EQUATION_ALPHA", 1), ("VIEWPORT", 4), ("SCISSOR_BOX", 4),
    ("PRIMITIVE_RESTART_INDEX", 1), ("PROVOKING_VERTEX", 1), ("DEPTH_RANGE", 2),
)  # fmt: skip
"""Other state that is saved, and the number of integers of each."""


def loaded_gl() -> Any | None:
    """Return pyglet's GL module if the host draws with pyglet; never imports it."""
    module = sys.modules.get("pyglet.gl")
    return module if module is not None and getattr(module, "current_context", None) is not None else None


def pyglet_context() -> Any | None:
    """Return the current pyglet context, or None if the host does not draw with pyglet."""
    gl = loaded_gl()
    return None if gl is None else gl.current_context


def is_hidden(context: Any | None) -> bool:
    """Return whether a pyglet context belongs to the hidden window that pyglet opens by itself."""
    return context is not None and context is _hidden()


def _hidden() -> Any | None:
    window = getattr(sys.modules.get("pyglet.gl"), "_shadow_window", None)
    return None if window is None else window.context


def has_windows() -> bool:
    """Return whether a pyglet window is open, current or not."""
    app = sys.modules.get("pyglet.app")
    return app is not None and len(app.windows) > 0


def is_lost(context: Any | None) -> bool:
    """Return whether a pyglet context is gone, as its window was closed."""
    return context is not None and context.canvas is None


@contextmanager
def current(context: Any | None) -> Iterator[bool]:
    """Make a pyglet context current inside; yields whether its objects may be deleted now.

    The shared objects of a lost context live on as long as pyglet's hidden window. They are deleted in the context of
    that window, which has no vertex arrays that might be deleted by mistake.
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


_SWITCHES = [(name, ENUMS[name]) for name in SWITCHES]
_RESULTS = [(name, (c_int * count)()) for name, count in REMEMBERED]
_VALUES = [(name, ENUMS[name], addressof(values), values) for name, values in _RESULTS]
"""Saved state: its name, GL's constant, and an array for the result of a query, with its address: ctypes converts
integers faster than arrays."""

_OFF = [(name, ENUMS[name]) for name in SWITCHED_OFF]
_STORES = [(name, ENUMS[name]) for name in (*ALIGNMENTS, *LAYOUTS)]
_TARGETS = [(f"{name}_BINDING", ENUMS[name]) for name in TARGETS]
_LAYOUTS, _TEXELS = ([ENUMS[name] for name in names] for names in (LAYOUTS, TEXELS))


class State:
    """Snapshot of the host's GL state, which `restore` brings back.

    `limits` are those of its context; `unit` is the texture unit on which moderngl loads textures.
    """

    def __init__(self, gl: Functions, limits: Limits, unit: int) -> None:
        self.gl = gl
        self._on = {name for name, switch in _SWITCHES if gl.glIsEnabled(switch)}
        for _, number, address, _ in _VALUES:
            gl.glGetIntegerv(number, address)
        self._value: dict[str, list[int]] = {name: found[:] for name, _, _, found in _VALUES}
        self._clip = DEFAULT_CLIP
        if limits.clipped:
            self._clip = gl.number("CLIP_ORIGIN"), gl.number("CLIP_DEPTH_MODE")
        self._feedback = _feedback(gl)
        self.outputs = Outputs(gl, self.framebuffer, blends="BLEND" in self._on)
        self._viewports = Viewports(gl, limits.viewports)
        self._units = Units(gl, unit)
        self.is_reversed = False
        """Whether the guest's clip depth is reversed, decreasing with distance; set by `set_depth`."""
        gl.glActiveTexture(*self._value["ACTIVE_TEXTURE"])

    @property
    def viewport(self) -> Box:
        """The host's viewport [pixels]."""
        x, y, width, height = self._value["VIEWPORT"]
        return x, y, width, height

    @property
    def scissor(self) -> Box | None:
        """The host's scissor box [pixels]; None where its scissor test is off."""
        x, y, width, height = self._value["SCISSOR_BOX"]
        return (x, y, width, height) if "SCISSOR_TEST" in self._on else None

    @property
    def framebuffer(self) -> int:
        """Number of the framebuffer that the host draws into, 0 for its window."""
        return self._value["DRAW_FRAMEBUFFER_BINDING"][0]

    @property
    def flags(self) -> int:
        """Flags of moderngl that the host has enabled."""
        return sum(getattr(moderngl, name) for name in MODERNGLS if name in self._on)

    def clip_conversion(self, *, keeps_depth: bool = False) -> Floats | None:
        """Return the matrix (4, 4) from the host's clip space to `DEFAULT_CLIP`; None where they are the same.

        A host may have flipped clip space vertically, and let its depth run from 0 to 1: `keeps_depth` leaves that.
        """
        if self._clip == DEFAULT_CLIP:
            return None
        conversion = np.eye(4, dtype=np.float32)
        if self._clip[0] != DEFAULT_CLIP[0]:
            conversion[1, 1] = -1.0
        if self._from_zero and not keeps_depth:
            conversion[2, 2:] = 2.0, -1.0
        return conversion

    def set_depth(self, *, is_reversed: bool) -> None:
        """Use the host's clip depth if depth is reversed, as it is most precise near 0, and OpenGL's default else."""
        self.is_reversed = is_reversed
        if self._from_zero:
            self.gl.glClipControl(DEFAULT_CLIP[0], self._clip[1] if is_reversed else DEFAULT_CLIP[1])

    @property
    def depth_ends(self) -> tuple[float, float]:
        """Depths of the near and the far plane in the guest's clip space."""
        if not self.is_reversed:
            return -1.0, 1.0
        return 1.0, 0.0 if self._from_zero else -1.0

    @property
    def far_is_less(self) -> bool:
        """Whether smaller depth is farther away in the framebuffer: the host may also have reversed `glDepthRange`."""
        first, last = self._value["DEPTH_RANGE"]
        return self.is_reversed != (first > last)

    @property
    def _from_zero(self) -> bool:
        return self._clip[1] != DEFAULT_CLIP[1]

    def clear(self) -> None:
        """Reset state that moderngl does not set and that would change a guest's picture, or texels it transfers."""
        gl = self.gl
        for name, switch in _OFF:
            if name in self._on:
                gl.glDisable(switch)
        for store in _LAYOUTS:
            gl.glPixelStorei(store, 0)
        for target in _TEXELS:
            gl.glBindBuffer(target, 0)
        self._units.clear()
        gl.glProvokingVertex(ENUMS["LAST_VERTEX_CONVENTION"])
        if self._clip != DEFAULT_CLIP:
            gl.glClipControl(*DEFAULT_CLIP)

    def borrow(self, unit: int, texture: int) -> None:
        """Bind a 2D texture to a unit of the host, until `restore`."""
        self._units.borrow(unit, texture)

    def restrict_colour(self) -> None:
        """Write colour to the host's first output alone, through the host's colour mask."""
        self.outputs.restrict()
        self.gl.glColorMaski(0, *self._value["COLOR_WRITEMASK"])

    def restore(self) -> None:
        """Restore all saved state."""
        gl, value = self.gl, self._value
        for name, switch in _SWITCHES:
            (gl.glEnable if name in self._on else gl.glDisable)(switch)
        for target in ("DRAW_FRAMEBUFFER", "READ_FRAMEBUFFER"):
            gl.glBindFramebuffer(ENUMS[target], gl.living("Framebuffer", *value[f"{target}_BINDING"]))
        gl.glViewport(*value["VIEWPORT"])
        gl.glScissor(*value["SCISSOR_BOX"])
        gl.glPolygonMode(ENUMS["FRONT_AND_BACK"], value["POLYGON_MODE"][0])
        gl.glFrontFace(*value["FRONT_FACE"])
        gl.glCullFace(*value["CULL_FACE_MODE"])
        gl.glDepthFunc(*value["DEPTH_FUNC"])
        gl.glDepthMask(*value["DEPTH_WRITEMASK"])
        gl.glColorMaski(0, *value["COLOR_WRITEMASK"])
        self.outputs.restore()
        gl.glBlendFuncSeparate(*(value[name][0] for name in BLEND))
        gl.glBlendEquationSeparate(*value["BLEND_EQUATION_RGB"], *value["BLEND_EQUATION_ALPHA"])
        gl.glPrimitiveRestartIndex(*value["PRIMITIVE_RESTART_INDEX"])
        gl.glProvokingVertex(*value["PROVOKING_VERTEX"])
        self._viewports.restore()
        if self._clip != DEFAULT_CLIP:
            gl.glClipControl(*self._clip)
        self._bind()

    def _bind(self) -> None:
        gl, value = self.gl, self._value
        for name, store in _STORES:
            gl.glPixelStorei(store, *value[name])
        gl.glUseProgram(gl.living("Program", *value["CURRENT_PROGRAM"]))
        gl.glBindVertexArray(gl.living("VertexArray", *value["VERTEX_ARRAY_BINDING"]))
        buffer, start, size = self._feedback
        buffer = gl.living("Buffer", buffer)
        # A buffer that was bound as a whole has size 0. Both calls also bind the general target, so they come first.
        if buffer and size:
            gl.glBindBufferRange(ENUMS[FEEDBACK], 0, buffer, start, size)
        else:
            gl.glBindBufferBase(ENUMS[FEEDBACK], 0, buffer)
        for name, target in _TARGETS:
            gl.glBindBuffer(target, gl.living("Buffer", *value[name]))
        gl.glBindRenderbuffer(ENUMS["RENDERBUFFER"], gl.living("Renderbuffer", *value["RENDERBUFFER_BINDING"]))
        self._units.restore()
        gl.glActiveTexture(*value["ACTIVE_TEXTURE"])


def _feedback(gl: Functions) -> tuple[int, int, int]:
    """Return the buffer at transform feedback's binding point 0, and the start and size of its range [bytes]."""
    buffer, span = c_int(), (c_int64(), c_int64())
    gl.glGetIntegeri_v(ENUMS[f"{FEEDBACK}_BINDING"], 0, addressof(buffer))
    for name, found in zip(("START", "SIZE"), span, strict=True):
        gl.glGetInteger64i_v(ENUMS[f"{FEEDBACK}_{name}"], 0, addressof(found))
    return buffer.value, span[0].value, span[1].value
