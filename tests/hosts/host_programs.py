"""Programs of other libraries with a prairie in them, which `test_hosts.py` runs: `host_programs.py LIBRARY SCENE`.

Each draws something of its own alone, then a prairie, then its own again, for some frames. It prints a line of JSON:
its faults, an empty text where there are none. If its library is not installed, it exits with 77.
"""

import json
import sys
from collections.abc import Callable
from contextlib import suppress
from importlib import import_module
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from tallgrass import Prairie
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix

Picture = NDArray[np.uint8]
Draw = Callable[[], None]
SIZE = (160, 120)
LACKS = 77
VERTEX = """#version 330
void main() { gl_Position = vec4(gl_VertexID == 1 ? 0.9 : -0.6, gl_VertexID == 2 ? 0.8 : -0.7, 0.2, 1.0); }"""
FRAGMENT = """#version 330
uniform sampler2D texels;
out vec4 color;
void main() { color = vec4(texture(texels, gl_FragCoord.xy / 97.0).rgb, 0.5); }"""


def needed(name: str) -> Any:
    """Return a library, or end the program where it is not installed."""
    try:
        return import_module(name)
    except ImportError as error:
        sys.stderr.write(f"{error}\n")
        sys.exit(LACKS)


class Triangle:
    """Drawing of a program that has GL to itself: a textured triangle, blended and tested, with moderngl."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self.program = ctx.program(vertex_shader=VERTEX, fragment_shader=FRAGMENT)
        self.array = ctx.vertex_array(self.program, [])
        self.texture = ctx.texture((8, 8), 4, np.random.default_rng(1).integers(0, 256, 256, np.uint8).tobytes())
        self.texture.use(15)  # bound once and for all, as state is set
        self.program["texels"] = 15
        ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)

    def draw(self) -> None:
        """Draw it."""
        self.array.render(moderngl.TRIANGLES, 3)

    def read(self) -> Picture:
        """Return the window's picture."""
        return np.frombuffer(self.ctx.screen.read(components=3, alignment=1), np.uint8)

    def clear(self) -> None:
        """Clear the window."""
        self.ctx.clear(0.1, 0.2, 0.3, depth=1.0)


def around(prairie: Prairie, clear: Draw, own: Draw, read: Callable[[], Picture], flip: Draw) -> str:
    """Return the faults in a program's own drawing after a prairie's."""
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    matrices = view_matrix(camera), projection_matrix(camera.view, SIZE[0] / SIZE[1])
    told, expected, first = [], b"", b""
    for frame in range(6):
        clear()
        if frame in {2, 3, 4}:
            prairie.draw(*matrices)
            seen = read()
            first = first or seen.tobytes()
            told += ["the prairie is not there"] * (len(np.unique(seen)) < 50)
            told += ["the prairie is another one"] * (seen.tobytes() != first)
            clear()
        own()
        expected = expected or read().tobytes()
        told += [f"its own drawing is another one in frame {frame}"] * (read().tobytes() != expected)
        flip()
    told += ["it draws nothing"] * (len(set(expected)) < 4)
    return ", ".join(dict.fromkeys(told))


def arcade(scene: str) -> str:
    """Arcade: sprites, text and shapes, drawn by its own context over pyglet's."""
    library = needed("arcade")
    window = library.Window(*SIZE, visible=False)
    prairie, sprites = Prairie.load(scene), library.SpriteList()
    for k in range(3):
        sprites.append(library.SpriteSolidColor(30, 20, 40 + 40 * k, 30, (200, 80, 40 + 60 * k, 160), angle=20 * k))
    text = library.Text("Prairie", 20, 80, (255, 255, 255), 14)

    def own() -> None:
        sprites.draw()
        text.draw()
        library.draw_circle_filled(120, 80, 25, (20, 80, 240, 120))

    def read() -> Picture:
        return np.frombuffer(window.ctx.screen.read(components=3), np.uint8)

    told = around(prairie, window.clear, own, read, window.flip)
    prairie.release()
    window.close()
    return told


def pyglet(scene: str) -> str:
    """pyglet, 2 or 3: a prairie in a batch, between two sprites."""
    library = needed("pyglet")
    gl = import_module("pyglet.gl" if library.version.startswith("2") else "pyglet.graphics.api.gl")
    window, batch, groups = library.window.Window(*SIZE), library.graphics.Batch(), library.graphics.Group
    square = library.image.SolidColorImagePattern((255, 0, 0, 255)).create_image(40, 30)
    kept = [library.sprite.Sprite(square, 40 * order, 10, batch=batch, group=groups(order)) for order in (0, 2)]
    prairie = Prairie.load(scene)
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    matrices = view_matrix(camera), projection_matrix(camera.view, SIZE[0] / SIZE[1])

    def draw() -> tuple[bytes, int]:
        window.clear()
        batch.draw()
        pixels = (gl.GLubyte * (3 * SIZE[0] * SIZE[1]))()
        gl.glReadPixels(0, 0, *SIZE, gl.GL_RGB, gl.GL_UNSIGNED_BYTE, pixels)
        seen = np.frombuffer(pixels, np.uint8).reshape(-1, 3)
        return seen.tobytes(), int((seen == (255, 0, 0)).all(axis=-1).sum())

    without, red = draw()
    group = prairie.group(batch, lambda: matrices, order=1)
    shown, front = draw()
    group.visible = False
    hidden, _ = draw()
    group.visible = True
    again, _ = draw()
    group.delete()
    gone, _ = draw()
    prairie.release()
    window.close()
    wrong = {
        "the sprites are not there": red != len(kept) * 1200, "it is not between them": front != 1200,
        "the prairie is not there": len(set(shown)) < 50, "it cannot be hidden": hidden != without,
        "it is another one": again != shown, "it cannot be taken out": gone != without,
    }  # fmt: skip
    return ", ".join(what for what, holds in wrong.items() if holds)


def moderngl_window(scene: str) -> str:
    """moderngl-window, on glfw."""
    needed("glfw")
    needed("moderngl_window")
    kind = needed("moderngl_window.context.glfw").Window
    window = kind(size=SIZE, gl_version=(3, 3), visible=False, vsync=False)
    needed("moderngl_window").activate_context(ctx=window.ctx)
    triangle, prairie = Triangle(window.ctx), Prairie.load(scene)
    told = around(prairie, triangle.clear, triangle.draw, triangle.read, window.swap_buffers)
    prairie.release()
    window.destroy()
    return told


def pygame(scene: str) -> str:
    """pygame-ce, with moderngl."""
    library = needed("pygame")
    library.display.init()
    for name, value in (("MAJOR_VERSION", 3), ("MINOR_VERSION", 3), ("PROFILE_MASK", 1), ("DEPTH_SIZE", 24)):
        kind = f"GL_CONTEXT_{name}" if "DEPTH" not in name else f"GL_{name}"
        library.display.gl_set_attribute(getattr(library, kind), value)
    library.display.set_mode(SIZE, library.OPENGL | library.DOUBLEBUF)
    triangle, prairie = Triangle(moderngl.create_context()), Prairie.load(scene)
    told = around(prairie, triangle.clear, triangle.draw, triangle.read, library.display.flip)
    prairie.release()
    library.quit()
    return told


def glfw(scene: str) -> str:
    """glfw: one prairie in windows that share and that do not, closed and opened again."""
    library = needed("glfw")
    library.init()
    for name, value in (
        ("CONTEXT_VERSION_MAJOR", 3), ("CONTEXT_VERSION_MINOR", 3), ("OPENGL_PROFILE", library.OPENGL_CORE_PROFILE),
        ("VISIBLE", 0), ("OPENGL_FORWARD_COMPAT", 1),
    ):  # fmt: skip
        library.window_hint(getattr(library, name), value)
    prairie, told = Prairie.load(scene), []
    first = library.create_window(*SIZE, "first", None, None)
    library.make_context_current(first)
    kept = Triangle(moderngl.create_context())
    for number in range(3):
        second = library.create_window(*SIZE, "second", None, first if number else None)
        library.make_context_current(second)
        triangle = Triangle(moderngl.create_context())
        for window, each in ((second, triangle), (first, kept), (second, triangle)):
            library.make_context_current(window)
            told.append(around(prairie, each.clear, each.draw, each.read, lambda: library.swap_buffers(window)))  # noqa: B023
        library.destroy_window(second)
    library.make_context_current(first)
    prairie.release()
    library.terminate()
    return ", ".join(dict.fromkeys(filter(None, told)))


def pyside(scene: str) -> str:
    """PySide6: its painter's drawing, in a framebuffer of its own as widgets have."""
    gui = needed("PySide6.QtGui")
    opengl = needed("PySide6.QtOpenGL")
    form = gui.QSurfaceFormat()
    form.setVersion(3, 3)
    form.setProfile(gui.QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    form.setDepthBufferSize(24)
    gui.QSurfaceFormat.setDefaultFormat(form)
    program = gui.QGuiApplication(sys.argv[:1])
    surface, context = gui.QOffscreenSurface(), gui.QOpenGLContext()
    surface.create()
    assert context.create()
    assert context.makeCurrent(surface)
    kind = opengl.QOpenGLFramebufferObject
    target = kind(*SIZE, kind.Attachment.CombinedDepthStencil)
    target.bind()
    calls = context.functions()
    device, prairie = opengl.QOpenGLPaintDevice(*SIZE), Prairie.load(scene)

    def clear() -> None:
        calls.glViewport(0, 0, *SIZE)
        calls.glClearColor(0.1, 0.2, 0.3, 1.0)
        calls.glClear(0x4100)

    def own() -> None:
        painter = gui.QPainter(device)
        painter.setRenderHint(gui.QPainter.RenderHint.Antialiasing)
        painter.setBrush(gui.QColor(200, 80, 40, 120))
        painter.drawEllipse(30, 20, 90, 70)
        painter.drawLine(0, 0, 150, 100)
        painter.end()

    def read() -> Picture:
        image = target.toImage().convertToFormat(gui.QImage.Format.Format_RGBA8888)
        target.bind()
        return np.frombuffer(image.constBits(), np.uint8).copy()

    told = around(prairie, clear, own, read, lambda: None)
    prairie.release()
    context.doneCurrent()
    with suppress(AttributeError):
        program.shutdown()
    return told


def main() -> None:
    """Run one of the programs and print its faults."""
    said = {
        "arcade": arcade, "moderngl-window": moderngl_window, "pygame-ce": pygame, "glfw": glfw, "PySide6": pyside,
        "pyglet": pyglet,
    }  # fmt: skip
    sys.stdout.write(json.dumps(said[sys.argv[1]](sys.argv[2])) + "\n")


if __name__ == "__main__":
    main()
