"""A GL context without a window and without a display."""

from typing import Any

import moderngl

BACKENDS: tuple[dict[str, Any], ...] = ({"backend": "egl"}, {})
"""Arguments of moderngl's backends in the order of trial: EGL, which needs no display, then the platform's own."""


class NoContextError(RuntimeError):
    """No OpenGL 3.3 works without a window; the message is one sentence that says what helps."""


def standalone_context() -> moderngl.Context:
    """Make a context of OpenGL 3.3 or newer without a window current, and return it.

    Raises NoContextError with the message of each backend where none works.
    """
    complaints: list[str] = []
    for backend in BACKENDS:
        try:
            return moderngl.create_context(require=330, standalone=True, **backend)
        except Exception as error:  # noqa: BLE001 - the backends raise nothing narrower
            complaints.append(str(error))
    said = "; ".join(dict.fromkeys(complaints))
    raise NoContextError(f"no OpenGL 3.3 without a window: {said} (tallgrass doctor says what to install)")
