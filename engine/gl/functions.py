"""GL's functions, called by address, and its constants: what moderngl does not offer, without another library."""

import ctypes
from ctypes import c_char_p, c_float, c_int, c_ssize_t, c_ubyte, c_uint, c_uint64, c_void_p
from functools import lru_cache
from typing import Any

import moderngl

ENUMS = {
    "NONE": 0x0000, "BLEND": 0x0BE2, "CULL_FACE": 0x0B44, "DEPTH_TEST": 0x0B71, "PROGRAM_POINT_SIZE": 0x8642,
    "RASTERIZER_DISCARD": 0x8C89, "COLOR_LOGIC_OP": 0x0BF2, "DEPTH_CLAMP": 0x864F, "POLYGON_OFFSET_FILL": 0x8037,
    "POLYGON_SMOOTH": 0x0B41,
    "SAMPLE_ALPHA_TO_COVERAGE": 0x809E, "SAMPLE_COVERAGE": 0x80A0, "CLIP_DISTANCE0": 0x3000,
    "CLIP_DISTANCE1": 0x3001, "PRIMITIVE_RESTART": 0x8F9D, "TEXTURE_CUBE_MAP_SEAMLESS": 0x884F,
    "SCISSOR_TEST": 0x0C11, "BLEND_SRC_RGB": 0x80C9, "BLEND_DST_RGB": 0x80C8, "BLEND_SRC_ALPHA": 0x80CB,
    "BLEND_DST_ALPHA": 0x80CA, "UNPACK_ALIGNMENT": 0x0CF5, "UNPACK_ROW_LENGTH": 0x0CF2, "PACK_ALIGNMENT": 0x0D05,
    "ARRAY_BUFFER": 0x8892, "UNIFORM_BUFFER": 0x8A11, "PIXEL_UNPACK_BUFFER": 0x88EC, "ARRAY_BUFFER_BINDING": 0x8894,
    "UNIFORM_BUFFER_BINDING": 0x8A28, "PIXEL_UNPACK_BUFFER_BINDING": 0x88EF, "CURRENT_PROGRAM": 0x8B8D,
    "VERTEX_ARRAY_BINDING": 0x85B5, "FRAMEBUFFER": 0x8D40, "DRAW_FRAMEBUFFER": 0x8CA9, "READ_FRAMEBUFFER": 0x8CA8,
    "DRAW_FRAMEBUFFER_BINDING": 0x8CA6, "READ_FRAMEBUFFER_BINDING": 0x8CAA, "RENDERBUFFER": 0x8D41,
    "RENDERBUFFER_BINDING": 0x8CA7, "ACTIVE_TEXTURE": 0x84E0, "FRONT_AND_BACK": 0x0408, "POLYGON_MODE": 0x0B40,
    "FRONT_FACE": 0x0B46, "CULL_FACE_MODE": 0x0B45, "DEPTH_FUNC": 0x0B74, "DEPTH_WRITEMASK": 0x0B72,
    "DEPTH_RANGE": 0x0B70,
    "COLOR_WRITEMASK": 0x0C23, "BLEND_EQUATION_RGB": 0x8009, "BLEND_EQUATION_ALPHA": 0x883D, "VIEWPORT": 0x0BA2,
    "SCISSOR_BOX": 0x0C10, "PRIMITIVE_RESTART_INDEX": 0x8F9E, "DRAW_BUFFER0": 0x8825, "COLOR_ATTACHMENT1": 0x8CE1,
    "COLOR_ATTACHMENT0": 0x8CE0, "FRAMEBUFFER_ATTACHMENT_OBJECT_NAME": 0x8CD1, "TEXTURE": 0x1702,
    "FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE": 0x8CD0, "TEXTURE_2D_ARRAY": 0x8C1A, "UNSIGNED_BYTE": 0x1401, "RED": 0x1903,
    "R8": 0x8229, "RG": 0x8227, "RG8": 0x822B, "RGB": 0x1907, "RGB8": 0x8051, "RGBA": 0x1908, "RGBA8": 0x8058,
    "SAMPLES": 0x80A9, "DEPTH": 0x1801, "COLOR": 0x1800, "DEPTH_ATTACHMENT": 0x8D00,
    "TEXTURE_2D": 0x0DE1, "TEXTURE_3D": 0x806F, "TEXTURE_BINDING_3D": 0x806A, "TEXTURE0": 0x84C0,
    "TEXTURE_MAX_LEVEL": 0x813D,
    "UNPACK_SWAP_BYTES": 0x0CF0, "UNPACK_LSB_FIRST": 0x0CF1, "UNPACK_SKIP_ROWS": 0x0CF3, "UNPACK_SKIP_PIXELS": 0x0CF4,
    "UNPACK_SKIP_IMAGES": 0x806D, "UNPACK_IMAGE_HEIGHT": 0x806E, "PACK_SWAP_BYTES": 0x0D00, "PACK_LSB_FIRST": 0x0D01,
    "PACK_ROW_LENGTH": 0x0D02, "PACK_SKIP_ROWS": 0x0D03, "PACK_SKIP_PIXELS": 0x0D04, "PACK_SKIP_IMAGES": 0x806B,
    "PACK_IMAGE_HEIGHT": 0x806C, "PIXEL_PACK_BUFFER": 0x88EB, "PIXEL_PACK_BUFFER_BINDING": 0x88ED,
    "COPY_READ_BUFFER": 0x8F36, "COPY_READ_BUFFER_BINDING": 0x8F36,
    "COPY_WRITE_BUFFER": 0x8F37, "COPY_WRITE_BUFFER_BINDING": 0x8F37,
    "TRANSFORM_FEEDBACK_BUFFER": 0x8C8E, "TRANSFORM_FEEDBACK_BUFFER_BINDING": 0x8C8F,
    "TRANSFORM_FEEDBACK_BUFFER_START": 0x8C84, "TRANSFORM_FEEDBACK_BUFFER_SIZE": 0x8C85,
    "SAMPLES_PASSED": 0x8914, "ANY_SAMPLES_PASSED": 0x8C2F, "CURRENT_QUERY": 0x8865,
    "QUERY_WAIT": 0x8E13, "QUERY_NO_WAIT": 0x8E14,
    "TIMESTAMP": 0x8E28, "QUERY_RESULT": 0x8866, "QUERY_RESULT_AVAILABLE": 0x8867, "QUERY_COUNTER_BITS": 0x8864,
    "VENDOR": 0x1F00, "RENDERER": 0x1F01, "VERSION": 0x1F02, "EXTENSIONS": 0x1F03, "NUM_EXTENSIONS": 0x821D,
    "MAX_TEXTURE_SIZE": 0x0D33,
    "MAX_ARRAY_TEXTURE_LAYERS": 0x88FF, "MAX_UNIFORM_BUFFER_BINDINGS": 0x8A2F, "MAX_VIEWPORTS": 0x825B,
    "TEXTURE_BINDING_2D": 0x8069, "TEXTURE_BINDING_2D_ARRAY": 0x8C1D, "SAMPLER_BINDING": 0x8919,
    "CLIP_ORIGIN": 0x935C, "CLIP_DEPTH_MODE": 0x935D, "LOWER_LEFT": 0x8CA1, "UPPER_LEFT": 0x8CA2,
    "NEGATIVE_ONE_TO_ONE": 0x935E, "ZERO_TO_ONE": 0x935F, "PROVOKING_VERTEX": 0x8E4F,
    "VERTEX_SHADER": 0x8B31, "FRAGMENT_SHADER": 0x8B30, "COMPLETION_STATUS": 0x91B1,
    "LAST_VERTEX_CONVENTION": 0x8E4E, "VERTEX_ATTRIB_ARRAY_DIVISOR": 0x88FE,
}  # fmt: skip
"""Values of GL's enums, by their names without GL_."""

RETURN_FLAG = {
    "glIsEnabled": (c_int,), "glIsEnabledi": (c_int,) * 2, "glIsProgram": (c_int,), "glIsBuffer": (c_int,),
    "glIsVertexArray": (c_int,), "glIsTexture": (c_int,), "glIsSampler": (c_int,), "glIsFramebuffer": (c_int,),
    "glIsRenderbuffer": (c_int,),
}  # fmt: skip
"""Argument types of the functions that return a boolean."""

RETURN_TEXT = {"glGetString": (c_int,), "glGetStringi": (c_int,) * 2}
"""Functions that return a string."""

RETURN_NOTHING = {
    "glGetIntegerv": (c_int, c_void_p), "glGetBooleani_v": (c_int, c_int, c_void_p),
    "glGetIntegeri_v": (c_int, c_int, c_void_p), "glGetInteger64i_v": (c_int, c_int, c_void_p),
    "glGetFloati_v": (c_int, c_int, c_void_p),
    "glBindBufferBase": (c_int,) * 3, "glBindBufferRange": (c_int, c_int, c_int, c_ssize_t, c_ssize_t),
    "glGetFramebufferAttachmentParameteriv": (c_int, c_int, c_int, c_void_p), "glDrawBuffers": (c_int, c_void_p),
    "glEnable": (c_int,), "glDisable": (c_int,), "glEnablei": (c_int,) * 2, "glDisablei": (c_int,) * 2,
    "glPixelStorei": (c_int,) * 2, "glBindBuffer": (c_int,) * 2, "glBindFramebuffer": (c_int,) * 2,
    "glBindRenderbuffer": (c_int,) * 2, "glBindVertexArray": (c_int,), "glUseProgram": (c_int,),
    "glActiveTexture": (c_int,), "glPrimitiveRestartIndex": (c_int,), "glViewport": (c_int,) * 4,
    "glScissor": (c_int,) * 4, "glPolygonMode": (c_int,) * 2, "glFrontFace": (c_int,), "glCullFace": (c_int,),
    "glDepthFunc": (c_int,), "glDepthMask": (c_ubyte,), "glColorMaski": (c_int, *(c_ubyte,) * 4),
    "glBlendFuncSeparate": (c_int,) * 4, "glBlendEquationSeparate": (c_int,) * 2,
    "glBindTexture": (c_int,) * 2, "glBindSampler": (c_int,) * 2, "glTexImage2D": (*(c_int,) * 8, c_void_p),
    "glTexImage3D": (*(c_int,) * 9, c_void_p), "glTexSubImage2D": (*(c_int,) * 8, c_void_p),
    "glTexSubImage3D": (*(c_int,) * 10, c_void_p),
    "glTexParameteri": (c_int,) * 3,
    "glProvokingVertex": (c_int,), "glClipControl": (c_int,) * 2,
    "glViewportIndexedf": (c_int, *(c_float,) * 4), "glScissorIndexed": (c_int,) * 5,
    "glGenVertexArrays": (c_int, c_void_p), "glDeleteVertexArrays": (c_int, c_void_p),
    "glVertexAttribDivisor": (c_int,) * 2, "glGetVertexAttribiv": (c_int, c_int, c_void_p),
    "glCopyTexSubImage2D": (c_int,) * 8, "glGenQueries": (c_int, c_void_p), "glDeleteQueries": (c_int, c_void_p),
    "glBeginQuery": (c_int, c_uint), "glEndQuery": (c_int,),
    "glBeginConditionalRender": (c_uint, c_int), "glEndConditionalRender": (),
    "glQueryCounter": (c_int,) * 2, "glGetQueryiv": (c_int, c_int, c_void_p),
    "glGetQueryObjectiv": (c_int, c_int, c_void_p), "glGetQueryObjectui64v": (c_int, c_int, c_void_p),
    "glFlush": (), "glShaderSource": (c_int, c_int, c_void_p, c_void_p), "glCompileShader": (c_int,),
    "glAttachShader": (c_int,) * 2, "glLinkProgram": (c_int,), "glGetProgramiv": (c_int, c_int, c_void_p),
    "glDeleteShader": (c_int,),
    "glDeleteProgram": (c_int,), "glMaxShaderCompilerThreadsKHR": (c_int,), "glMaxShaderCompilerThreadsARB": (c_int,),
    "glClearBufferfv": (c_int, c_int, c_void_p),
}  # fmt: skip
"""Functions that return nothing: for reading and restoring GL state, and for what moderngl does not offer."""

RETURN_NUMBER = {"glCreateShader": (c_int,), "glCreateProgram": ()}
"""Functions that return the number of a new object."""

RESULTS = {
    name: kind
    for names, kind in (
        (RETURN_FLAG, c_ubyte), (RETURN_TEXT, c_char_p), (RETURN_NOTHING, None), (RETURN_NUMBER, c_uint),
    )
    for name in names
}  # fmt: skip
ARGUMENTS: dict[str, tuple[Any, ...]] = RETURN_FLAG | RETURN_TEXT | RETURN_NOTHING | RETURN_NUMBER

convention = getattr(ctypes, "WINFUNCTYPE", ctypes.CFUNCTYPE)
"""GL's calling convention: stdcall on Windows, cdecl elsewhere."""


ARRAY_TYPES = tuple(kind * count for kind in (c_int, c_uint, c_float, c_ubyte, c_uint64) for count in (1, 2, 4, 8))
"""Array types of arguments. Kept here, as ctypes else makes the type anew at each use: a cycle for the collector."""


class Functions:
    """GL's functions by name, those of `ARGUMENTS`; each is looked up at its first use."""

    def __init__(self, loader: Any) -> None:
        self._address = getattr(loader, "load_opengl_function", None) or loader.load

    def __getattr__(self, name: str) -> Any:
        if name not in ARGUMENTS:
            raise AttributeError(f"{name} is not among GL's functions here")
        found = convention(RESULTS[name], *ARGUMENTS[name])(self._address(name))
        setattr(self, name, found)
        return found

    def number(self, name: str, /) -> int:
        """Return an integer of GL's state, by its name in `ENUMS`."""
        found = (c_int * 1)()
        self.glGetIntegerv(ENUMS[name], found)
        return found[0]

    def living(self, sort: str, number: int, /) -> int:
        """Return an object's number, or 0 where it has been deleted, as binding it would be an error.

        `sort` is as in `glIs...`: "Framebuffer", "Program" and so on.
        """
        return number if number and getattr(self, f"glIs{sort}")(number) else 0


@lru_cache(maxsize=16)
def functions_of_loader(loader: Any) -> Functions:
    """Return the functions that a moderngl loader finds."""
    return Functions(loader)


def functions_of(ctx: moderngl.Context) -> Functions:
    """Return the functions of a moderngl context."""
    return functions_of_loader(ctx.mglo._context)  # noqa: SLF001 - moderngl has no public access
