"""A program without pyglet that has a prairie in it: what `test_moderngl.py` runs, with moderngl or with plain GL.

It prints one line of JSON: for each check its faults, an empty text where there are none.
"""

import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from ctypes import CFUNCTYPE, c_float, c_int, c_ubyte, c_void_p
from ctypes.util import find_library
from typing import Any

import glcontext  # type: ignore[import-untyped]
import moderngl
import numpy as np
from numpy.typing import NDArray

from tallgrass import Prairie
from tallgrass.engine.camera import camera_at, projection_matrix, view_matrix
from tallgrass.engine.gl.headless import standalone_context

Picture = NDArray[np.uint8]
Values = dict[str, tuple[float, ...]]
SIZE = (96, 64)

SWITCHES = {
    "blend": 0x0BE2, "cull face": 0x0B44, "depth test": 0x0B71, "point size": 0x8642, "logic op": 0x0BF2,
    "depth clamp": 0x864F, "polygon offset": 0x8037, "alpha to coverage": 0x809E, "coverage": 0x80A0,
    "clip distance 0": 0x3000, "clip distance 1": 0x3001, "seamless": 0x884F, "restart": 0x8F9D, "scissor": 0x0C11,
    "discard": 0x8C89, "stencil": 0x0B90, "dither": 0x0BD0, "multisample": 0x809D, "sRGB": 0x8DB9,
}  # fmt: skip
NUMBERS = {
    "blend source": 0x80C9, "blend goal": 0x80C8, "alpha source": 0x80CB, "alpha goal": 0x80CA, "equation": 0x8009,
    "alpha equation": 0x883D, "depth func": 0x0B74, "depth mask": 0x0B72, "front face": 0x0B46, "culled": 0x0B45,
    "polygons": 0x0B40, "viewport": 0x0BA2, "scissor box": 0x0C10, "program": 0x8B8D, "array": 0x85B5,
    "buffer": 0x8894, "uniform buffer": 0x8A28, "unpack buffer": 0x88EF, "pack buffer": 0x88ED, "drawn": 0x8CA6,
    "read": 0x8CAA, "renderbuffer": 0x8CA7, "unit": 0x84E0, "captured": 0x8C8F,
    "restart index": 0x8F9E, "logic": 0x0BF0,
    "provoking": 0x8E4F, "clip origin": 0x935C, "clip depth": 0x935D,
    "read buffer": 0x0C02, "stencil func": 0x0B92, "stencil mask": 0x0B98, "clear depth": 0x0B73,
    "clear colour": 0x0C22,
}  # fmt: skip
STORES = {
    0x0CF5: 2, 0x0CF2: 999, 0x0CF0: 1, 0x0CF1: 1, 0x0CF3: 2, 0x0CF4: 3, 0x806D: 1, 0x806E: 7, 0x0D05: 8, 0x0D02: 999,
    0x0D00: 1, 0x0D04: 3,
}  # fmt: skip
"""Unusual layout of texels in memory."""

ON_UNIT = {"texture": 0x8069, "texture array": 0x8C1D}


class Gl:
    """GL functions of the program's own context, by name."""

    def __init__(self, context: Any) -> None:
        self._address = context.load_opengl_function

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def call(*arguments: Any) -> Any:
            kinds = [c_void_p if hasattr(each, "_length_") else c_int for each in arguments]
            return CFUNCTYPE(c_ubyte, *kinds)(self._address(name))(*arguments)

        return call

    def number(self, name: int, *place: int) -> tuple[int, ...]:
        """Return the values of a state, at an index if it is indexed."""
        found = (c_int * 4)()
        (self.glGetIntegeri_v if place else self.glGetIntegerv)(name, *place, found)
        return tuple(found)

    def box(self, place: int) -> tuple[float, ...]:
        """Return the viewport of an index."""
        found = (c_float * 4)()
        self.glGetFloati_v(0x0BA2, place, found)
        return tuple(found)

    def values(self) -> Values:
        """Return all GL state that a prairie could change."""
        told: Values = {name: (self.glIsEnabled(number),) for name, number in SWITCHES.items()}
        told |= {name: self.number(number) for name, number in NUMBERS.items()}
        told |= {f"texels {number:#x}": self.number(number) for number in STORES}
        for output in range(8):
            told[f"attachment of {output}"] = self.number(0x8825 + output)
            told[f"mask of {output}"] = self.number(0x0C23, output)
            told[f"captured of {output}"] = self.number(0x8C8F, output) if output < 4 else ()
            told[f"blend of {output}"] = (self.glIsEnabledi(0x0BE2, output),)
        for unit in range(48):
            self.glActiveTexture(0x84C0 + unit)
            told[f"sampler on {unit}"] = self.number(0x8919)
            told |= {f"{name} on {unit}": self.number(number) for name, number in ON_UNIT.items() if unit < 32}
        for place in range(16):
            told[f"block {place}"] = self.number(0x8A28, place)
            told[f"viewport {place}"] = self.box(place)
            told[f"scissor {place}"] = (*self.number(0x0C10, place), self.glIsEnabledi(0x0C11, place))
        self.glActiveTexture(told["unit"][0])
        return told

    def hostile(self) -> None:
        """Set all GL state to unusual values."""
        for number in (0x0BE2, 0x0B44, 0x0B71, 0x8642, 0x8037, 0x809E, 0x3000, 0x864F, 0x0C11):
            self.glEnable(number)
        self.glDisable(0x884F)
        self.glBlendFuncSeparate(0x0307, 1, 1, 0x0302)
        self.glBlendEquationSeparate(0x800B, 0x8007)
        self.glDepthFunc(0x0204)
        self.glDepthMask(0)
        self.glFrontFace(0x0900)
        self.glCullFace(0x0404)
        self.glViewport(3, 2, 80, 50)
        self.glScissor(5, 4, 60, 40)
        self.glPrimitiveRestartIndex(77)
        self.glProvokingVertex(0x8E4D)
        self.glClipControl(0x8CA2, 0x935F)
        for place in (2, 15):
            self.glViewportIndexedfv(place, (c_float * 4)(0.5, place, 7.25, 9.0))
            self.glScissorIndexed(place, place, 1, 7, 9)
            self.glDisablei(0x0C11, place)
        name = (c_int * 2)()
        self.glGenTextures(2, name)
        for unit in (15, 31):
            self.glActiveTexture(0x84C0 + unit)
            self.glBindTexture(0x0DE1, name[0])
            self.glBindTexture(0x8C1A, name[1])
        self.glGenSamplers(1, name)
        for unit in (3, 32, 40, 47):
            self.glBindSampler(unit, name[0])
        self.glActiveTexture(0x84C0 + 5)
        for store, value in STORES.items():
            self.glPixelStorei(store, value)
        name = (c_int * 1)()
        self.glGenBuffers(1, name)
        self.glBindBufferBase(0x8C8E, 0, name[0])
        self.glBindBuffer(0x8A11, name[0])
        self.glColorMask(1, 0, 1, 1)

    def outputs(self) -> None:
        """Set other masks and blending for the outputs after the first."""
        self.glColorMaski(1, 0, 1, 0, 1)
        self.glColorMaski(2, 1, 0, 0, 0)
        self.glDisablei(0x0BE2, 1)


def compared(before: Values, after: Values) -> str:
    """Return in words the values that differ."""
    return "; ".join(f"{name}: {before[name]}, then {after[name]}" for name in before if before[name] != after[name])


def draw(prairie: Prairie) -> None:
    """Draw a prairie from the scene's own camera."""
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    prairie.draw(view_matrix(camera), projection_matrix(camera.view, SIZE[0] / SIZE[1]))


class Game:
    """A program that draws a triangle with moderngl, in framebuffers of its own."""

    def __init__(self) -> None:
        self.ctx = standalone_context()
        self.gl = Gl(self.ctx.mglo._context)  # noqa: SLF001
        self.program = self.ctx.program(
            vertex_shader="""#version 330
            void main() { gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 0.2, 1); }""",
            fragment_shader="""#version 330
            layout(location = 0) out vec4 one;
            layout(location = 1) out vec4 two;
            void main() { one = vec4(0.6, 0.7, 0.8, 0.5); two = gl_FragCoord / 97.0; }""",
        )
        self.triangle = self.ctx.vertex_array(self.program, [])
        self.prairie = Prairie.load(sys.argv[1], ctx=self.ctx, live=False)

    @contextmanager
    def target(self, colors: int) -> Iterator[moderngl.Framebuffer]:
        """Return a framebuffer with a number of colour attachments, and depth."""
        made = [self.ctx.texture(SIZE, 4) for _ in range(colors)]
        depth = self.ctx.depth_texture(SIZE)
        target = self.ctx.framebuffer(made, depth)
        target.use()
        target.clear(0.1, 0.2, 0.3, 0.4)
        yield target
        target.release()
        for texture in (depth, *made):
            texture.release()

    def seen(self, target: moderngl.Framebuffer) -> list[Picture]:
        """Return the contents of all attachments, depth last."""
        colors = [np.frombuffer(target.read(components=4, attachment=each), np.uint8) for each in self.colors(target)]
        assert isinstance(target.depth_attachment, moderngl.Texture)
        return [*colors, np.frombuffer(target.depth_attachment.read(), np.uint8)]

    def colors(self, target: moderngl.Framebuffer) -> range:
        """Return the numbers of the attachments."""
        return range(len(target.color_attachments or ()))

    def left(self, colors: int, leave: Callable[[], None], *, prairie: bool) -> tuple[str, list[Picture]]:
        """Set a state, draw the triangle, perhaps after a prairie; return the changes of state, and the picture."""
        with self.target(colors) as target:
            leave()
            before = self.gl.values()
            if prairie:
                draw(self.prairie)
            told = compared(before, self.gl.values())
            with self.ctx.scope(target, self.ctx.BLEND):
                pass  # moderngl brings back what it remembers
            told = told or ("" if self.gl.glIsEnabled(0x0B71) == before["depth test"][0] else "moderngl remembers less")
            self.tidy(target)
            target.clear(0.1, 0.2, 0.3, 0.4)
            leave()
            self.triangle.render(moderngl.TRIANGLES, 3)
            self.tidy(target)
            return told, self.seen(target)

    def tidy(self, target: moderngl.Framebuffer) -> None:
        """Restore GL's default masks and tests."""
        self.ctx.enable_only(moderngl.NOTHING)
        for number in (0x8037, 0x809E, 0x3000, 0x864F, 0x0C11, 0x0BF2):
            self.gl.glDisable(number)
        for store in STORES:
            self.gl.glPixelStorei(store, 4 if store in (0x0CF5, 0x0D05) else 0)
        self.ctx.front_face = "ccw"
        self.gl.glColorMask(1, 1, 1, 1)
        self.gl.glProvokingVertex(0x8E4E)
        self.gl.glClipControl(0x8CA1, 0x935E)
        target.viewport = (0, 0, *SIZE)
        target.use()

    def enabled(self) -> None:
        """Enable switches once, with moderngl."""
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE | moderngl.BLEND)
        self.ctx.blend_func, self.ctx.depth_func = (moderngl.ONE, moderngl.ONE), ">="
        self.ctx.front_face = "cw"

    def one_of_two(self) -> None:
        """Set all GL state to unusual values, with the second attachment as the second output alone."""
        self.gl.hostile()
        self.gl.outputs()
        self.gl.glDrawBuffers(2, (c_int * 2)(0, 0x8CE1))


def check_state(game: Game) -> str:
    """All GL state is as before, value by value, and so is the program's own triangle."""
    told = []
    for colors in (1, 2, 0):
        for leave in (lambda: None, game.enabled, game.gl.hostile, game.gl.outputs, game.one_of_two):
            if colors == 2 or leave != game.one_of_two:
                _, alone = game.left(colors, leave, prairie=False)
                said, found = game.left(colors, leave, prairie=True)
                same = all(np.array_equal(one, two) for one, two in zip(alone, found, strict=True))
                told += [f"{leave.__name__} of {colors}: {said or 'another picture'}"] * bool(said or not same)
    return " / ".join(told)


def check_attachments(game: Game) -> str:
    """Of two attachments the first gets the usual picture and the second stays; a framebuffer of depth works, too."""
    pictures = {}
    for colors in (1, 2, 0):
        with game.target(colors) as target:
            empty = game.seen(target)
            draw(game.prairie)
            pictures[colors] = game.seen(target)
    (color, depth), (first, second, depth_too), (depth_alone,) = (pictures[colors] for colors in (1, 2, 0))
    right = {
        "something": not np.array_equal(depth, empty[-1]) and len(np.unique(color)) > 50,
        "first": np.array_equal(first, color),
        "second": len(np.unique(second.reshape(-1, 4), axis=0)) == 1,
        "depth": np.array_equal(depth_too, depth),
        "depth alone": np.array_equal(depth_alone, depth),
    }
    return ", ".join(name for name, is_right in right.items() if not is_right)


def check_output(game: Game) -> str:
    """The prairie goes to the program's first output, whichever attachment that is."""
    with game.target(2) as target:
        game.gl.glDrawBuffers(1, (c_int * 1)(0x8CE1))
        draw(game.prairie)
        first, second, _ = game.seen(target)
    return "" if len(np.unique(first)) == 4 and len(np.unique(second)) > 50 else "another attachment was drawn"


def check_anaglyph(game: Game) -> str:
    """A prairie drawn through a red and then a cyan mask is the picture without masks."""
    with game.target(1) as target:
        draw(game.prairie)
        whole, _ = game.seen(target)
        target.clear()
        for mask in ((1, 0, 0, 1), (0, 1, 1, 1)):
            game.gl.glClear(0x0100)
            game.gl.glColorMask(*mask)
            draw(game.prairie)
        game.gl.glColorMask(1, 1, 1, 1)
        found, _ = game.seen(target)
    return "" if np.array_equal(found.reshape(-1, 4)[:, :3], whole.reshape(-1, 4)[:, :3]) else "colours are missing"


def check_samplers(game: Game) -> str:
    """Sampler objects that a program left on any unit do not change how textures are read."""
    name = (c_int * 1)()
    game.gl.glGenSamplers(1, name)
    with game.target(1) as target:
        draw(game.prairie)
        alone, _ = game.seen(target)
        for unit in range(48):
            game.gl.glBindSampler(unit, name[0])
        target.clear()
        draw(game.prairie)
        found, _ = game.seen(target)
        left = [unit for unit in range(48) if game.gl.values()[f"sampler on {unit}"][0] != name[0]]
        for unit in range(48):
            game.gl.glBindSampler(unit, 0)
    return f"{left or ''}" if np.array_equal(found, alone) else "another picture"


def check_clip_space(game: Game) -> str:
    """In a clip space that is upside down, with depth from 0 to 1, prairie and triangle have the same picture."""
    pictures = []
    turned = np.diag([1.0, -1.0, 1.0, 1.0])
    nearer = np.eye(4)
    nearer[2, 2:] = 0.5
    with game.target(1) as target:
        for clip, control in ((np.eye(4), (0x8CA1, 0x935E)), (nearer @ turned, (0x8CA2, 0x935F))):
            game.gl.glClipControl(*control)
            target.clear()
            camera = camera_at(game.prairie.scene.camera, None, game.prairie.height_at)
            game.prairie.draw(view_matrix(camera), clip @ projection_matrix(camera.view, SIZE[0] / SIZE[1]))
            told = game.gl.number(0x935C)[0], game.gl.number(0x935D)[0]
            pictures.append(game.seen(target)[0].astype(int))
            if told != control:
                return f"{told} was {control}"
        game.gl.glClipControl(0x8CA1, 0x935E)
    unlike = float((np.abs(pictures[1] - pictures[0]) > 12).mean())
    return "" if unlike < 0.01 else f"{unlike:.0%} are unlike"


def check_release(game: Game) -> str:
    """All GL state is as before after another prairie has been released."""
    with game.target(1) as target:
        prairie = Prairie.load(sys.argv[1], ctx=game.ctx, live=False)
        draw(prairie)
        game.gl.hostile()
        before = game.gl.values()
        prairie.release()
        told = compared(before, game.gl.values())
        game.tidy(target)
        return told


def check_released(game: Game) -> str:
    """After a framebuffer was deleted, a prairie can be drawn in the next one."""
    with game.target(1):
        draw(game.prairie)
    with game.target(1) as target:
        draw(game.prairie)
        return "" if len(np.unique(game.seen(target)[0])) > 50 else "nothing was drawn"


def bare() -> str:
    """Draw with plain GL in a context that moderngl does not know yet: its state stays, from the first frame on."""
    libraries = {"libgl": find_library("GL"), "libegl": find_library("EGL")}
    context = glcontext.get_backend_by_name("egl")(mode="standalone", glversion=330, **libraries)
    gl, name = Gl(context), (c_int * 1)()
    gl.glGenFramebuffers(1, name)
    gl.glBindFramebuffer(0x8D40, name[0])
    for attachment, kind in ((0x8CE0, 0x8058), (0x8D00, 0x81A6)):
        gl.glGenTextures(1, name)
        gl.glBindTexture(0x0DE1, name[0])
        gl.glTexStorage2D(0x0DE1, 1, kind, *SIZE)
        gl.glFramebufferTexture2D(0x8D40, attachment, 0x0DE1, name[0], 0)
    gl.hostile()
    before, prairie, told = gl.values(), Prairie.load(sys.argv[1], live=False), []
    for number in range(2):
        draw(prairie)
        said = compared(before, gl.values())
        told += [f"frame {number}: {said}"] * bool(said)
    return " / ".join(told)


def main() -> None:
    """Run all checks and print their faults."""
    if sys.argv[2] == "bare":
        found = {"bare": bare()}
    else:
        game = Game()
        found = {name.removeprefix("check_"): run(game) for name, run in globals().items() if name.startswith("check_")}
    found["pyglet"] = "it was loaded" if "pyglet" in sys.modules else ""
    sys.stdout.write(json.dumps(found))


if __name__ == "__main__":
    main()
