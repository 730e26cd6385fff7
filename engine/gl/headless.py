"""A GL context without a window and without a display."""

from typing import Any

import moderngl

BACKENDS: tuple[dict[str, Any], ...] = ({"backend": "egl"}, {})
"""What is tried, in this order: EGL, which needs no display, or else the platform's own."""


class NoContextError(RuntimeError):
    """There is no OpenGL 3.3 that works without a window; the message is one sentence that says what helps."""


def standalone_context() -> moderngl.Context:
    """Return a new context of OpenGL 3.3 or newer, without a window, and make it current.

    Raises NoContextError with what each backend said where none works.
    """
    complaints: list[str] = []
    for backend in BACKENDS:
        try:
            return moderngl.create_context(require=330, standalone=True, **backend)
        except Exception as error:  # noqa: BLE001 - the backends raise nothing narrower
            complaints.append(str(error))
    said = "; ".join(dict.fromkeys(complaints))
    raise NoContextError(f"no OpenGL 3.3 without a window: {said} (tallgrass doctor says what to install)")
