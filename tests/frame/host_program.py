"""A pyglet game that has a prairie in it: what `test_pyglet.py` runs, with a display and without one.

It prints one line of JSON: for each check what was found wrong, an empty text where nothing was. What a check draws
is compared with the same drawing by the same program without its prairie.
"""

import gc
import json
import sys
from collections.abc import Callable, Iterator
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
from tallgrass.engine.gl.homes import Homes
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
    """Return what windows ask for."""
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
        """Draw with whatever is bound, as a program does that has GL for itself."""
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
    """Return what is in the framebuffer that is bound, top row first."""
    width, height = size
    data = (gl.GLubyte * (3 * width * height))()
    gl.glPixelStorei(gl.GL_PACK_ALIGNMENT, 1)
    gl.glReadPixels(0, 0, width, height, gl.GL_RGB, gl.GL_UNSIGNED_BYTE, data)
    return np.frombuffer(bytes(data), np.uint8).reshape(height, width, 3)[::-1].astype(np.int16)


def read_depth() -> NDArray[np.float32]:
    """Return the depth of what is in the framebuffer that is bound, 1 where there is nothing."""
    width, height = SIZE
    data = (gl.GLfloat * (width * height))()
    gl.glReadPixels(0, 0, width, height, gl.GL_DEPTH_COMPONENT, gl.GL_FLOAT, data)
    return np.frombuffer(bytes(data), np.float32).reshape(height, width)


def different(one: Picture, two: Picture) -> str:
    """Say how two pictures differ."""
    if one.shape != two.shape:
        return f"{one.shape} is not {two.shape}"
    wrong = int((one != two).any(axis=-1).sum())
    return f"{wrong} of {one.shape[0] * one.shape[1]} pixels differ" if wrong else ""


def together(**said: str) -> str:
    """Say what is wrong, and where."""
    return "; ".join(f"{name.replace('_', ' ')}: {text}" for name, text in said.items() if text)


@contextmanager
def prairies(count: int = 1) -> Iterator[list[Prairie]]:
    """Prairies of the little scene, released in the end."""
    made = [Prairie(LOADED) for _ in range(count)]
    yield made
    for prairie in made:
        prairie.release()


def matrices(prairie: Prairie, size: tuple[int, int] = SIZE) -> tuple[Any, Any]:
    """Return the scene's own camera for a picture of some size."""
    camera = camera_at(prairie.scene.camera, None, prairie.height_at)
    return view_matrix(camera), projection_matrix(camera.view, size[0] / size[1])


def picture(prairie: Prairie, size: tuple[int, int] = SIZE) -> Picture:
    """Return what a prairie draws alone."""
    clear()
    prairie.draw(*matrices(prairie, size))
    return read(size)


# ---- What a game may have set, once and for all --------------------------------------------------


def nothing() -> None:
    """As GL begins."""


def depth_and_culling() -> None:
    """As pyglet's own 3D examples do."""
    gl.glEnable(gl.GL_DEPTH_TEST)
    gl.glEnable(gl.GL_CULL_FACE)


def blending() -> None:
    """A blend equation that nobody sets again."""
    gl.glEnable(gl.GL_BLEND)
    gl.glBlendEquation(gl.GL_FUNC_REVERSE_SUBTRACT)
    gl.glBlendFuncSeparate(gl.GL_DST_COLOR, gl.GL_ONE, gl.GL_ONE, gl.GL_ZERO)


def scissor() -> None:
    """A part of the picture."""
    gl.glEnable(gl.GL_SCISSOR_TEST)
    gl.glScissor(7, 9, 120, 80)


def wireframe() -> None:
    """Lines for triangles, and the other way round."""
    gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_LINE)
    gl.glFrontFace(gl.GL_CW)


def masks() -> None:
    """No depth is written, and no blue; a depth function that few use."""
    gl.glEnable(gl.GL_DEPTH_TEST)
    gl.glDepthFunc(gl.GL_ALWAYS)
    gl.glDepthMask(gl.GL_FALSE)
    gl.glColorMask(gl.GL_TRUE, gl.GL_TRUE, gl.GL_FALSE, gl.GL_TRUE)


def switches() -> None:
    """What hardly anybody leaves on."""
    for name in ("COLOR_LOGIC_OP", "POLYGON_OFFSET_FILL", "SAMPLE_ALPHA_TO_COVERAGE", "CLIP_DISTANCE0", "DEPTH_CLAMP"):
        gl.glEnable(getattr(gl, f"GL_{name}"))
    gl.glPolygonOffset(3.0, 50.0)
    gl.glLogicOp(gl.GL_COPY_INVERTED)
    gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 999)


def disorder() -> None:
    """All of that at once but what cuts the picture off."""
    for leave in (depth_and_culling, blending, wireframe, masks, switches):
        leave()


STATES: tuple[Callable[[], None], ...] = (
    nothing, depth_and_culling, blending, scissor, wireframe, masks, switches, disorder,
)  # fmt: skip


def tidy() -> None:
    """Set everything back to what GL begins with."""
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


# ---- The checks ----------------------------------------------------------------------------------


def frames(game: Game, prairie: Prairie | None, size: tuple[int, int] = SIZE) -> list[Picture]:
    """Return what the game's own drawing looks like before, between and after two prairies, in a second frame."""
    seen: list[Picture] = []
    draws = (game.draw_raw, game.draw_flat, game.draw_solid)
    game.bind()
    for _ in range(2):
        seen = []
        for draw in (*draws, None, *draws, None, *draws):
            clear()
            if draw is not None:
                draw()
                seen.append(read(size))
                if draw == game.draw_solid:
                    game.bind()
            elif prairie is not None:
                prairie.draw(*matrices(prairie, size))
                prairie.advance(0.03)
    return seen


def around(game: Game, leave: Callable[[], None], size: tuple[int, int] = SIZE) -> str:
    """Compare the game's own drawing around prairies with the same without any."""
    told: dict[str, str] = {}
    tidy()
    leave()
    alone = frames(game, None, size)
    tidy()
    leave()
    with prairies() as (prairie,):
        found = frames(game, prairie, size)
    tidy()
    drawn = {"raw": alone[0], "flat": alone[1], "solid": alone[2]}
    if leave in STATES[:2]:
        told |= {
            name: "next to nothing" for name, one in drawn.items() if (one != one[-1, -1]).any(axis=-1).sum() < 500
        }
    names = [f"{what} {when}" for when in ("before", "between", "after") for what in ("raw", "flat", "solid")]
    for name, one, two in zip(names, alone, found, strict=True):
        told[name] = different(one, two)
    return together(**told)


def check_pyglets_drawing(game: Game) -> str:
    """Sprites, labels, shapes, models and raw GL look alike with prairies around them, whatever was set."""
    return together(**{leave.__name__: around(game, leave) for leave in STATES})


def check_samplers(game: Game) -> str:
    """A sampler that the game left on its texture unit stays there, and off the prairie's textures."""
    with prairies() as (prairie,):
        neutral = picture(prairie)

        def leave() -> None:
            for unit in range(4):
                gl.glBindSampler(unit, game.sampler)

        leave()
        return together(prairie=different(picture(prairie), neutral), game=around(game, leave))


def check_hostile_state(game: Game) -> str:
    """The prairie itself looks alike whatever the game has set; blue alone stays where the game keeps it."""
    told = {}
    with prairies() as (prairie,):
        neutral = picture(prairie)
        clear()
        without_blue = np.concatenate([neutral[..., :2], read()[..., 2:]], axis=-1)
        for leave in STATES:
            game.bind()
            clear()
            leave()
            prairie.draw(*matrices(prairie))
            tidy()
            found = read()
            if leave is scissor:
                inside = np.zeros(found.shape[:2], np.bool_)
                inside[SIZE[1] - 89 : SIZE[1] - 9, 7:127] = True
                told["cut off"] = different(found[inside][None], neutral[inside][None])
                told["beside"] = "" if (found[~inside] == found[0, 0]).all() else "something was drawn"
            else:
                told[leave.__name__] = different(found, without_blue if leave in (masks, disorder) else neutral)
    return together(**told)


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


def check_host_framebuffer(game: Game) -> str:
    """In a framebuffer of the game's own, of a size of its own, everything is as in the window."""
    large = (2 * SIZE[0], 2 * SIZE[1])
    clear()
    window = read()
    with framebuffer(large):
        told = {name: around(game, leave, large) for name, leave in (("tidy", tidy), ("3D", depth_and_culling))}
        with prairies() as (prairie,):
            found = picture(prairie, large)
        told["prairie"] = "" if len(np.unique(found[-80:].reshape(-1, 3), axis=0)) > 500 else "it is not all there"
    return together(**told, window=different(read(), window))


def check_attachments(_: Game) -> str:
    """In a framebuffer with two attachments the prairie is in the first; in one with depth alone its depth is there."""
    with prairies() as (prairie,):
        window = picture(prairie)
        depths = []
        with framebuffer(SIZE):
            second = pyglet.image.Texture.create(*SIZE)
            place = gl.GL_COLOR_ATTACHMENT1
            gl.glFramebufferTexture2D(gl.GL_FRAMEBUFFER, place, gl.GL_TEXTURE_2D, second.id, 0)
            gl.glDrawBuffers(2, (gl.GLenum * 2)(gl.GL_COLOR_ATTACHMENT0, place))
            found = picture(prairie)
            depths.append(read_depth())
            gl.glReadBuffer(place)
            beside = read()
        for attachment in range(2):
            with framebuffer(SIZE, colors=False):
                clear()
                if attachment:
                    prairie.draw(*matrices(prairie))
                depths.append(read_depth())
        second.delete()
    return together(
        first="" if (found != window).any(axis=-1).mean() < 0.005 else "it is another picture",
        second="" if (beside == beside[0, 0]).all() else "something was drawn",
        depth="" if np.array_equal(depths[0], depths[2]) else "it differs",
        empty="" if (depths[1] == 1.0).all() and (depths[2] < 1.0).any() else "there is none",
    )


def resize(game: Game, size: tuple[int, int]) -> None:
    """Resize the window, and let the display follow."""
    game.window.set_size(*size)
    for _ in range(3):
        game.window.dispatch_events()
        game.window.dispatch_event("_on_internal_resize", *size)
        game.window.switch_to()
        game.window.flip()


def check_resize(game: Game) -> str:
    """After a resize the prairie fills the window, as in one that always had that size."""
    if pyglet.options.headless:
        return ""  # there, what a window draws into keeps its size
    size = (220, 90)
    with prairies() as (prairie,):
        picture(prairie)
        resize(game, size)
        found, told = picture(prairie, size), around(game, tidy, size)
    with prairies() as (prairie,):
        expected = picture(prairie, size)
    with framebuffer(size), prairies() as (prairie,):
        elsewhere = picture(prairie, size)
    resize(game, SIZE)
    near = "" if (found != elsewhere).any(axis=-1).mean() < 0.005 else "it is another one"
    return together(prairie=different(found, expected), size=near, game=told)


def check_no_pixels(_: Game) -> str:
    """In a window without any pixels nothing is drawn, and nothing goes wrong."""
    with prairies() as (prairie,):
        for width, height in ((0, 0), (0, 50), (50, 0)):
            gl.glViewport(0, 0, width, height)
            prairie.draw(*matrices(prairie))
        gl.glViewport(0, 0, *SIZE)
        drawn = "" if prairie.painter is None else "something was made ready"
        return together(drawn=drawn, after=different(picture(prairie), picture(prairie)))


def check_batch(_: Game) -> str:
    """In a batch the prairie is drawn in its turn; it can be hidden, taken out, and released there."""
    batch = pyglet.graphics.Batch()
    square = pyglet.image.SolidColorImagePattern((255, 0, 0, 255)).create_image(40, 30)
    orders = {order: pyglet.graphics.Group(order) for order in (0, 2)}
    sprites = {
        order: pyglet.sprite.Sprite(square, 40 * order, 10, batch=batch, group=orders[order]) for order in (0, 2)
    }

    def draw() -> Picture:
        clear()
        batch.draw()
        return read()

    without = draw()
    red = (without == (255, 0, 0)).all(axis=-1)
    behind, front = red & (np.arange(SIZE[0]) < 60), red & (np.arange(SIZE[0]) > 60)
    with prairies() as (prairie,):
        expected = picture(prairie)
        group = prairie.group(batch, lambda: matrices(prairie), order=1)
        found = draw()
        told = {
            "behind": different(found[~front][None], expected[~front][None]),
            "in front": different(found[front][None], without[front][None]),
            "red": "" if behind.any() and front.any() else "the sprites are not seen",
        }
        group.visible = False
        told["hidden"] = different(draw(), without)
        group.visible = True
        told["shown"] = different(draw(), found)
        inside = pyglet.graphics.Group(0, parent=group)
        sprites[0].group = inside
        told["inside"] = "" if (draw() == (255, 0, 0)).all(axis=-1)[behind].all() else "it is not over the prairie"
        sprites[0].group = orders[0]
        group.delete()
        told["taken out"] = different(draw(), without)
        other, again = Prairie(LOADED), Prairie(LOADED)
        for order, extra in ((1, other), (3, again)):
            extra.group(batch, lambda extra=extra: matrices(extra), order=order)  # type: ignore[misc]
        draw()
        again.release()
        told["one of two"] = different(draw(), found)
        other.release()
        told["released"] = different(draw(), without)
    return together(**told)


def objects() -> dict[str, int]:
    """Return how many GL objects of each kind there are."""
    gc.collect()
    assert gl.current_context is not None
    gl.current_context.set_current()  # pyglet deletes here what was collected elsewhere
    kinds = ("Buffer", "Texture", "VertexArray", "Program", "Shader", "Framebuffer", "Renderbuffer", "Sampler")
    return {kind: sum(map(bool, map(getattr(gl, f"glIs{kind}"), range(1, 1500)))) for kind in kinds}


def grown(before: dict[str, int]) -> str:
    """Say what there is more of than before."""
    now = objects()
    return ", ".join(f"{now[kind] - before[kind]} of {kind}" for kind in now if now[kind] != before[kind])


def check_two_windows(game: Game) -> str:
    """One prairie is drawn in two windows, each with objects of its own, and leaves nothing in either."""
    other = pyglet.window.Window(*SIZE, config=configured())
    tidy()
    before = []
    for window in (other, game.window):
        window.switch_to()
        before.append(objects())
    told = {}
    with prairies() as (prairie,):
        expected = picture(prairie)
        for number, window in enumerate((other, game.window, other)):
            window.switch_to()
            told[f"window {number}"] = different(picture(prairie), expected)
        game.window.switch_to()
        told["game"] = around(game, depth_and_culling)
    if pyglet.gl.current_context is not game.window.context:
        told["current"] = "another window is current after the release"
    for number, window in enumerate((other, game.window)):
        window.switch_to()
        told[f"left in {number}"] = grown(before[number])
    other.close()
    game.window.switch_to()
    return together(**told)


def check_window_made_again(game: Game) -> str:
    """A window is closed and another one opened: the prairie is drawn again, and nothing of the first stays."""
    told = {}
    with prairies() as (prairie,):
        expected = picture(prairie)
        before = objects()
        for number in range(3):
            window = pyglet.window.Window(*SIZE, config=configured())
            told[f"window {number}"] = different(picture(prairie), expected)
            window.close()
        homes: Homes[Any] = prairie._assembly.screen._painters  # noqa: SLF001
        told["painters"] = "" if len(homes) <= 2 else f"there are {len(homes)}"
        game.window.switch_to()
    empty = {kind: count for kind, count in objects().items() if count > before[kind]}
    return together(**told, objects=str(empty) if empty else "")


def resident() -> float:
    """Return the memory that this process holds [MB], 0 where the system does not say."""
    told = Path("/proc/self/statm")
    return int(told.read_text().split()[1]) * 4096 / 1e6 if told.exists() else 0.0


def check_rounds(_: Game) -> str:
    """Load and release a prairie many times: GL objects and memory do not grow."""
    rounds = int(sys.argv[2])
    memory, before = [], objects()
    for _round in range(rounds):
        with prairies() as (prairie,):
            picture(prairie)
        memory.append(resident())
    growth = memory[-1] - memory[rounds // 3]
    sys.stderr.write(f"{rounds} rounds: {memory[rounds // 3]:.1f} MB after a third, {memory[-1]:.1f} MB\n")
    told = "" if growth < 8.0 + 0.01 * rounds else f"{growth:.1f} MB more after {rounds} rounds"
    return together(objects=grown(before), memory=told)


def check_no_window() -> str:
    """Where only pyglet's hidden window is, one sentence says so."""
    said = ""
    with prairies() as (prairie,):
        try:
            prairie.draw(*matrices(prairie))
        except RuntimeError as error:
            said = str(error)
    return "" if said.startswith("there is no window yet: create the window") and "\n" not in said else f"said {said!r}"


def main() -> None:
    """Run all checks and print what they say."""
    found = {"no_window": check_no_window()}
    game = Game()
    for name, run in list(globals().items()):
        if name.startswith("check_") and run is not check_no_window:
            tidy()
            found[name.removeprefix("check_")] = run(game)
    sys.stdout.write(json.dumps({"version": "{}.{}".format(*gl.gl_info.get_version()), **found}))


if __name__ == "__main__":
    main()
