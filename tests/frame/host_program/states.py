"""GL states that a game may have set."""

from collections.abc import Callable

from pyglet import gl


def nothing() -> None:
    """Keep GL's defaults."""


def depth_and_culling() -> None:
    """Set what pyglet's own 3D examples set."""
    gl.glEnable(gl.GL_DEPTH_TEST)
    gl.glEnable(gl.GL_CULL_FACE)


def blending() -> None:
    """Set another blend equation."""
    gl.glEnable(gl.GL_BLEND)
    gl.glBlendEquation(gl.GL_FUNC_REVERSE_SUBTRACT)
    gl.glBlendFuncSeparate(gl.GL_DST_COLOR, gl.GL_ONE, gl.GL_ONE, gl.GL_ZERO)


def scissor() -> None:
    """Restrict drawing to a part of the picture."""
    gl.glEnable(gl.GL_SCISSOR_TEST)
    gl.glScissor(7, 9, 120, 80)


def wireframe() -> None:
    """Draw triangles as lines, and reverse the front face."""
    gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_LINE)
    gl.glFrontFace(gl.GL_CW)


def masks() -> None:
    """Mask depth and blue, and set a rare depth function."""
    gl.glEnable(gl.GL_DEPTH_TEST)
    gl.glDepthFunc(gl.GL_ALWAYS)
    gl.glDepthMask(gl.GL_FALSE)
    gl.glColorMask(gl.GL_TRUE, gl.GL_TRUE, gl.GL_FALSE, gl.GL_TRUE)


def switches() -> None:
    """Enable switches that hardly anybody leaves on."""
    for name in ("COLOR_LOGIC_OP", "POLYGON_OFFSET_FILL", "SAMPLE_ALPHA_TO_COVERAGE", "CLIP_DISTANCE0", "DEPTH_CLAMP"):
        gl.glEnable(getattr(gl, f"GL_{name}"))
    gl.glPolygonOffset(3.0, 50.0)
    gl.glLogicOp(gl.GL_COPY_INVERTED)
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 999)


def disorder() -> None:
    """Set all of these at once, except those that cut off the picture."""
    for leave in (depth_and_culling, blending, wireframe, masks, switches):
        leave()


STATES: tuple[Callable[[], None], ...] = (
    nothing, depth_and_culling, blending, scissor, wireframe, masks, switches, disorder,
)  # fmt: skip


def tidy() -> None:
    """Restore GL's defaults."""
    for name in (
        "DEPTH_TEST", "CULL_FACE", "BLEND", "SCISSOR_TEST", "COLOR_LOGIC_OP", "POLYGON_OFFSET_FILL",
        "SAMPLE_ALPHA_TO_COVERAGE", "CLIP_DISTANCE0", "DEPTH_CLAMP",
    ):  # fmt: skip
        gl.glDisable(getattr(gl, f"GL_{name}"))
    gl.glBlendEquation(gl.GL_FUNC_ADD)
    gl.glBlendFunc(gl.GL_ONE, gl.GL_ZERO)
    gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_FILL)
    gl.glFrontFace(gl.GL_CCW)
    gl.glDepthFunc(gl.GL_LESS)
    gl.glDepthMask(gl.GL_TRUE)
    gl.glColorMask(*(gl.GL_TRUE,) * 4)
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
    gl.glLogicOp(gl.GL_COPY)
    for unit in range(4):
        gl.glBindSampler(unit, 0)
    gl.glUseProgram(0)
    gl.glBindVertexArray(0)
