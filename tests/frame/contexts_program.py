"""A program with several GL contexts, without pyglet: what `test_contexts.py` runs.

It prints one line of JSON: for each check its faults, an empty text where there are none.
"""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from ctypes import CDLL, CFUNCTYPE, Array, addressof, c_int, c_void_p

import moderngl
import numpy as np
from numpy.typing import NDArray

from tallgrass import Prairie
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.engine.declared.quality import LodName

Picture = NDArray[np.uint8]
SIZE = (96, 64)
EGL = CDLL("libEGL.so.1")
for _name in ("eglGetDisplay", "eglGetPlatformDisplay", "eglCreateContext", "eglGetProcAddress"):
    getattr(EGL, _name).restype = c_void_p
SURFACELESS = 0x31DD
CORE = (c_int * 7)(0x3098, 3, 0x30FB, 3, 0x30FD, 1, 0x3038)
EMBEDDED = (c_int * 3)(0x3098, 3, 0x3038)


class Screens:
    """Maker of GL contexts without windows."""

    def __init__(self) -> None:
        self.display = c_void_p(EGL.eglGetPlatformDisplay(SURFACELESS, None, None))
        assert EGL.eglInitialize(self.display, None, None)
        self.config, count = c_void_p(), c_int()
        kinds = (c_int * 3)(0x3040, 0x48, 0x3038)
        EGL.eglChooseConfig(self.display, kinds, c_void_p(addressof(self.config)), 1, c_void_p(addressof(count)))

    def open(self, shares: "Window | None" = None, *, kind: Array[c_int] = CORE) -> "Window":
        """Return a new context, which may share what another one has."""
        other = None if shares is None else shares.context
        assert EGL.eglBindAPI(0x30A2 if kind is CORE else 0x30A0)
        return Window(self, c_void_p(EGL.eglCreateContext(self.display, self.config, other, kind)))


class Window:
    """A context with a framebuffer of its own, which stands for a window's."""

    def __init__(self, screens: Screens, context: c_void_p) -> None:
        assert context.value
        self.screens, self.context = screens, context
        self.switch_to()
        name = (c_int * 1)()
        gl("glGenFramebuffers", 1, name)
        self.target = name[0]
        gl("glBindFramebuffer", 0x8D40, self.target)
        for attachment, kind in ((0x8CE0, 0x8058), (0x8D00, 0x81A6)):
            gl("glGenRenderbuffers", 1, name)
            gl("glBindRenderbuffer", 0x8D41, name[0])
            gl("glRenderbufferStorage", 0x8D41, kind, *SIZE)
            gl("glFramebufferRenderbuffer", 0x8D40, attachment, 0x8D41, name[0])
        gl("glViewport", 0, 0, *SIZE)

    def switch_to(self) -> None:
        """Make the context current."""
        assert EGL.eglMakeCurrent(self.screens.display, None, None, self.context)

    def close(self) -> None:
        """End the context."""
        EGL.eglMakeCurrent(self.screens.display, None, None, None)
        EGL.eglDestroyContext(self.screens.display, self.context)

    def picture(self, prairie: Prairie) -> Picture:
        """Return the picture of a prairie in this context."""
        self.switch_to()
        gl("glClear", 0x4100)
        camera = camera_at(prairie.scene.camera, None, prairie.height_at)
        prairie.draw(view_matrix(camera), projection_matrix(camera.view, SIZE[0] / SIZE[1]))
        found = np.zeros((SIZE[1], SIZE[0], 4), np.uint8)
        gl("glReadPixels", 0, 0, *SIZE, 0x1908, 0x1401, c_void_p(found.ctypes.data))
        return found

    def objects(self) -> dict[str, int]:
        """Return the number of GL objects of each kind."""
        self.switch_to()
        kinds = ("Buffer", "Texture", "VertexArray", "Program", "Shader", "Framebuffer")
        return {kind: sum(gl(f"glIs{kind}", name) & 1 for name in range(1, 600)) for kind in kinds}


def gl(name: str, *arguments: object) -> int:
    """Call one of GL's functions."""
    kinds = [c_int if isinstance(each, int) else c_void_p for each in arguments]
    called: int = CFUNCTYPE(c_int, *kinds)(EGL.eglGetProcAddress(name.encode()))(*arguments)
    return called


@contextmanager
def prairie_of(lod: LodName = "auto") -> Iterator[Prairie]:
    """Yield a prairie that is given no context."""
    prairie = Prairie.load(sys.argv[1], live=False, lod=lod)
    yield prairie
    prairie.release()


def by_turns(one: Window, two: Window) -> str:
    """Draw one prairie in two contexts by turns, and give it back in both."""
    before = [window.objects() for window in (one, two)]
    with prairie_of() as prairie:
        pictures = [window.picture(prairie) for window in (one, two, one, two)]
    for window in (one, two):  # it is given back where it is drawn next
        with prairie_of() as other:
            window.picture(other)
    told = "" if len(np.unique(pictures[0])) > 50 else "nothing was drawn; "
    told += ", ".join(f"picture {k} is another one" for k in range(1, 4) if (pictures[k] != pictures[0]).any())
    for number, window in enumerate((one, two)):
        more = {kind: count for kind, count in window.objects().items() if count > before[number][kind]}
        told += f"; {more} is left in {number}" if more else ""
    return told


def check_two_contexts(screens: Screens) -> str:
    """Two contexts that share nothing."""
    return by_turns(screens.open(), screens.open())


def check_two_that_share(screens: Screens) -> str:
    """Two contexts of one group, which share all but vertex arrays and framebuffers."""
    one = screens.open()
    return by_turns(one, screens.open(one))


def check_closed_and_opened_again(screens: Screens) -> str:
    """Contexts that come and go while another stays; a new one often has the address of one that is gone."""
    stays, pictures = screens.open(), []
    with prairie_of("strips") as prairie:
        for number in range(4):
            window = screens.open(stays if number % 2 else None)
            pictures += [window.picture(prairie), stays.picture(prairie)]
            window.close()
        stays.switch_to()
    return ", ".join(f"picture {k} is another one" for k in range(1, 8) if (pictures[k] != pictures[0]).any())


def check_the_hosts_moderngl(screens: Screens) -> str:
    """A host with a moderngl context in each of its windows: its default one stays what it was."""
    windows = [screens.open() for _ in range(2)]
    contexts = []
    for window in windows:
        window.switch_to()
        moderngl.init_context()
        contexts.append(moderngl.get_context())
    with prairie_of("strips") as prairie:
        pictures = [window.picture(prairie) for window in (*windows, *windows)]
    told = "" if moderngl.get_context() is contexts[1] else "the default context is another one; "
    for window, ctx in zip(windows, contexts, strict=True):
        window.switch_to()
        given = Prairie.load(sys.argv[1], ctx=ctx, live=False, lod="strips")
        pictures.append(window.picture(given))
        given.release()
    return told + ", ".join(f"picture {k} is another one" for k in range(1, 6) if (pictures[k] != pictures[0]).any())


def check_embedded(screens: Screens) -> str:
    """OpenGL ES is refused in one sentence that says what to ask for."""
    window, said = screens.open(kind=EMBEDDED), ""
    with prairie_of("strips") as prairie:
        try:
            window.picture(prairie)
        except RuntimeError as error:
            said = str(error)
    right = said.startswith("a prairie is drawn with OpenGL 3.3 or newer, and this context has OpenGL ES 3.")
    return "" if right and "ask for version 3.3 and a core profile" in said else f"said {said!r}"


def main() -> None:
    """Run all checks and print their faults."""
    screens, found = Screens(), {}
    for name, run in globals().items():
        if name.startswith("check_"):
            told, error = run(screens), gl("glGetError")
            found[name.removeprefix("check_")] = told + (f"GL's error {error:#x} is left" if error else "")
    sys.stdout.write(json.dumps(found))


if __name__ == "__main__":
    main()
