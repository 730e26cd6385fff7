"""The game: what it draws, and how its pictures are read and compared."""

import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyglet
from numpy.typing import NDArray
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.image.buffer import Framebuffer, Renderbuffer
from pyglet.math import Mat4, Vec3
from pyglet.model import MaterialGroup

from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.engine.declared.quality import LodName
from tallgrass.engine.scene import read_scene
from tallgrass.systems.prairie import Prairie

Picture = NDArray[np.int16]
SIZE = (160, 120)
LOADED = read_scene(Path(sys.argv[1]))

CONFIG: dict[str, Any] = {
    "debug": True, "double_buffer": True, "depth_size": 24, "major_version": 3, "minor_version": 3,
    "red_size": 8, "green_size": 8, "blue_size": 8, "alpha_size": 8,
}  # fmt: skip
"""A debug context, and 8 bits of each colour, of which headless ones have fewer if nobody asks."""

RAW = """#version 330 core
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -0.5, gl_VertexID == 2 ? 3.0 : -0.5, 0.2, 1.0); }"""
TEXTURED = """#version 330 core
uniform sampler2D texels;
layout(std140) uniform WindowBlock { mat4 projection; mat4 view; } window;
out vec4 color;
void main() { color = texture(texels, gl_FragCoord.xy / 97.0) * (0.5 + window.projection[0][0]); }"""


def configured() -> gl.Config:
    """Return the configuration of windows."""
    config: Any = gl.Config  # its stand-in for type checkers is abstract
    return config(**CONFIG)  # type: ignore[no-any-return]


def new(function: str) -> int:
    """Return a new GL object of the game's own."""
    name = (gl.GLuint * 1)()
    getattr(gl, function)(1, name)
    return int(name[0])


class Game:
    """A game with sprites, text, shapes, models, and GL of its own that is bound once and then left so."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, resizable=True, config=configured())
        self.flat, self.solid = pyglet.graphics.Batch(), pyglet.graphics.Batch()
        texels = np.random.default_rng(3).integers(0, 256, (16, 16, 4), np.uint8)
        image = pyglet.image.ImageData(16, 16, "RGBA", texels.tobytes())
        self.sprites = [pyglet.sprite.Sprite(image, 10 + 40 * k, 20, batch=self.flat) for k in range(3)]
        self.sprites[1].scale_x, self.sprites[1].scale, self.sprites[2].rotation = -1.0, 2.0, 30.0
        self.text = pyglet.text.Label("Prairie", 20, 90, font_size=14, batch=self.flat)
        self.shapes = [
            pyglet.shapes.Circle(100, 70, 25, color=(200, 80, 40, 120), batch=self.flat),
            pyglet.shapes.Star(130, 30, 20, 8, 5, color=(20, 80, 240, 255), batch=self.flat),
        ]
        program = ShaderProgram(
            Shader(MaterialGroup.default_vert_src, "vertex"), Shader(MaterialGroup.default_frag_src, "fragment")
        )
        cube: Any = pyglet.model.Cube
        sphere: Any = pyglet.model.Sphere
        self.models = [
            cube(1.2, 1.2, 1.2, (1.0, 0.5, 0.2, 1.0), batch=self.solid, program=program),
            sphere(0.8, 12, 12, (0.2, 0.6, 1.0, 1.0), batch=self.solid, program=program),
        ]
        turned = Mat4.from_rotation(0.5, Vec3(0.3, 1.0, 0.0))
        self.models[0].matrix = Mat4.from_translation(Vec3(-0.7, 0.0, -4.0)) @ turned
        self.models[1].matrix = Mat4.from_translation(Vec3(0.2, 0.2, -4.4))
        self.raw = ShaderProgram(Shader(RAW, "vertex"), Shader(TEXTURED, "fragment"))
        self.array, self.texture = new("glGenVertexArrays"), image.create_texture(pyglet.image.Texture)
        self.sampler = new("glGenSamplers")
        gl.glSamplerParameteri(self.sampler, gl.GL_TEXTURE_MIN_FILTER, gl.GL_NEAREST)
        gl.glSamplerParameteri(self.sampler, gl.GL_TEXTURE_MAG_FILTER, gl.GL_NEAREST)

    def bind(self) -> None:
        """Bind what the raw drawing needs, once and for all."""
        gl.glBindVertexArray(self.array)
        gl.glActiveTexture(gl.GL_TEXTURE0 + 3)
        gl.glBindTexture(gl.GL_TEXTURE_2D, self.texture.id)
        self.raw["texels"] = 3
        gl.glUseProgram(self.raw.id)

    def draw_raw(self) -> None:
        """Draw with the bound objects, as a program that has GL to itself."""
        gl.glDrawArrays(gl.GL_TRIANGLES, 0, 3)

    def draw_flat(self) -> None:
        """Draw in 2D."""
        self.flat.draw()

    def draw_solid(self) -> None:
        """Draw in 3D, as a game with a camera of its own."""
        flat = self.window.projection
        self.window.projection = Mat4.perspective_projection(4 / 3, 0.1, 100.0, 45.0)
        self.solid.draw()
        self.window.projection = flat


def clear() -> None:
    """Clear all of colour and depth, whatever is masked or cut off."""
    color, depth, cut = (gl.GLint * 4)(), (gl.GLint * 1)(), gl.glIsEnabled(gl.GL_SCISSOR_TEST)
    gl.glGetIntegerv(gl.GL_COLOR_WRITEMASK, color)
    gl.glGetIntegerv(gl.GL_DEPTH_WRITEMASK, depth)
    gl.glColorMask(*(gl.GL_TRUE,) * 4)
    gl.glDepthMask(gl.GL_TRUE)
    gl.glDisable(gl.GL_SCISSOR_TEST)
    gl.glClearColor(0.1, 0.2, 0.3, 1.0)
    gl.glClear(gl.GL_COLOR_BUFFER_BIT | gl.GL_DEPTH_BUFFER_BIT)
    gl.glColorMask(*color)
    gl.glDepthMask(*depth)
    if cut:
        gl.glEnable(gl.GL_SCISSOR_TEST)


def read(size: tuple[int, int] = SIZE) -> Picture:
    """Return the picture in the bound framebuffer, top row first."""
    width, height = size
    data = (gl.GLubyte * (3 * width * height))()
    gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
    gl.glReadPixels(0, 0, width, height, gl.GL_RGB, gl.GL_UNSIGNED_BYTE, data)
    return np.frombuffer(bytes(data), np.uint8).reshape(height, width, 3)[::-1].astype(np.int16)


def read_depth() -> NDArray[np.float32]:
    """Return the depth in the bound framebuffer, 1 where nothing is drawn."""
    width, height = SIZE
    data = (gl.GLfloat * (width * height))()
    gl.glReadPixels(0, 0, width, height, gl.GL_DEPTH_COMPONENT, gl.GL_FLOAT, data)
    return np.frombuffer(bytes(data), np.float32).reshape(height, width)


def different(one: Picture, two: Picture) -> str:
    """Return the difference of two pictures in words, empty where they are equal."""
    if one.shape != two.shape:
        return f"{one.shape} is not {two.shape}"
    wrong = int((one != two).any(axis=-1).sum())
    return f"{wrong} of {one.shape[0] * one.shape[1]} pixels differ" if wrong else ""


def together(**said: str) -> str:
    """Return all faults with their places, in one text."""
    return "; ".join(f"{name.replace('_', ' ')}: {text}" for name, text in said.items() if text)


@contextmanager
def prairies(count: int = 1, lod: LodName = "auto") -> Iterator[list[Prairie]]:
    """Prairies of the little scene, released in the end."""
    made = [Prairie(LOADED, live=False, lod=lod) for _ in range(count)]
    yield made
    for prairie in made:
        prairie.release()


def matrices(prairie: Prairie, size: tuple[int, int] = SIZE) -> tuple[Any, Any]:
    """Return the scene's own camera for a picture of some size."""
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    return view_matrix(camera), projection_matrix(camera.view, size[0] / size[1])


def picture(prairie: Prairie, size: tuple[int, int] = SIZE) -> Picture:
    """Return the picture of a prairie alone."""
    clear()
    prairie.draw(*matrices(prairie, size))
    return read(size)


@contextmanager
def framebuffer(size: tuple[int, int], *, colors: bool = True) -> Iterator[None]:
    """Draw into the whole of a framebuffer of the game's own; without `colors` it has depth alone."""
    target = Framebuffer()
    color = pyglet.image.Texture.create(*size)
    depth = Renderbuffer(*size, gl.GL_DEPTH_COMPONENT24)
    if colors:
        target.attach_texture(color)
    target.attach_renderbuffer(depth, attachment=gl.GL_DEPTH_ATTACHMENT)
    target.bind()
    gl.glViewport(0, 0, *size)
    yield
    target.unbind()
    gl.glViewport(0, 0, *SIZE)
    target.delete()
    depth.delete()
    color.delete()


def objects() -> dict[str, int]:
    """Return the number of GL objects of each kind."""
    gc.collect()
    assert gl.current_context is not None
    gl.current_context.set_current()  # pyglet deletes here what was collected elsewhere
    kinds = ("Buffer", "Texture", "VertexArray", "Program", "Shader", "Framebuffer", "Renderbuffer", "Sampler")
    return {kind: sum(map(bool, map(getattr(gl, f"glIs{kind}"), range(1, 1500)))) for kind in kinds}


def grown(before: dict[str, int]) -> str:
    """Return in words the changes in the numbers of objects."""
    now = objects()
    return ", ".join(f"{now[kind] - before[kind]} of {kind}" for kind in now if now[kind] != before[kind])
