"""What draws: a graphics card, or the processor itself."""

import moderngl

SOFTWARE = ("llvmpipe", "softpipe", "swrast", "software", "swiftshader", "basic render", "gdi generic", "noop")
"""Parts of the names of renderers that are no graphics cards, in small letters."""


def is_software(renderer: str, /) -> bool:
    """Return whether a renderer of this name, as GL tells it, is no graphics card."""
    return any(name in renderer.lower() for name in SOFTWARE)


def draws_in_software(ctx: moderngl.Context, /) -> bool:
    """Return whether a context is drawn in without a graphics card."""
    return is_software(str(ctx.info["GL_RENDERER"]))
