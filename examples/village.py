"""A village at dusk: the game's own ground and houses, shadows of both on each other and on the grass, and lamps.

The game draws its ground and houses first; the prairie then lays its grass over them (`parts` without "ground"). The
shadow map, a depth texture drawn from the sun, is read by the game's own things and by the grass. Run it with
`python village.py`.
"""

from itertools import pairwise
from math import cos, sin
from typing import Any

import esper
import numpy as np
import pyglet
from numpy.typing import NDArray
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.image.buffer import Framebuffer
from pyglet.math import Mat4, Vec3

from tallgrass import Footprint, Lamp, Pose, Prairie, Road, ShadowMap

SIZE, MAP, UP = (960, 540), 2048, Vec3(0.0, 1.0, 0.0)
LANE = ((1.0, 48.0), (-1.0, 26.0), (3.0, 8.0), (-2.0, -10.0), (-12.0, -26.0), (-26.0, -38.0))
HOUSES = (  # x, z, yaw, width, depth, height
    (-10.0, 26.0, 0.1, 7.0, 6.0, 2.9), (12.0, 19.0, -0.2, 6.0, 9.0, 3.2), (-10.0, 8.0, 0.15, 6.0, 8.0, 3.0),
    (13.5, 0.0, 0.3, 8.0, 6.0, 2.8), (-14.0, -8.0, -0.3, 6.0, 6.0, 3.4), (7.0, -18.0, 0.5, 7.0, 6.0, 3.0),
    (-27.0, -20.0, 0.8, 8.0, 6.0, 3.0), (-10.0, -42.0, -0.6, 7.0, 7.0, 3.2),
)  # fmt: skip
LAMPS, POST = ((3.6, 35.0), (-3.6, 17.0), (6.2, 8.0), (-5.0, -6.0), (-8.0, -27.0)), 3.4
LANTERN, WARM = Lamp("#ffc98a", candela=120_000.0, range=24.0), np.array((1.5, 0.95, 0.5))
WALL, ROOF, PANE, IRON, SAND, TURF = (
    np.array(color) for color in (
        (0.6, 0.54, 0.46), (0.22, 0.1, 0.07), (2.0, 1.2, 0.45), (0.05, 0.05, 0.06), (0.38, 0.31, 0.21),
        (0.12, 0.13, 0.05),
    )
)  # fmt: skip

VERTEX = """#version 330 core
in vec3 place, normal, color;
uniform WindowBlock { mat4 projection; mat4 view; } window;
out vec3 world, facing, paint;
void main() {
    world = place, facing = normal, paint = color;
    gl_Position = window.projection * window.view * vec4(place, 1.0);
}"""
FRAGMENT = """#version 330 core
in vec3 world, facing, paint;
out vec4 pixel;
uniform sampler2D shades;
uniform mat4 seen_by_sun;
uniform vec3 sun, sunlight, skylight, lamplight, lamps[5];
void main() {
    vec3 at = 0.5 + 0.5 * (seen_by_sun * vec4(world, 1.0)).xyz, light = skylight * (0.7 + 0.3 * facing.y);
    float lit = 0.0;
    for (int tap = 0; tap < 9; tap++)
        lit += step(at.z - 0.001, texture(shades, at.xy + vec2(tap % 3 - 1, tap / 3 - 1) / 2048.0).r) / 9.0;
    light += sunlight * lit * max(dot(facing, sun), 0.0);
    for (int lamp = 0; lamp < 5; lamp++) {
        vec3 way = lamps[lamp] - world;
        light += lamplight * max(dot(facing, normalize(way)), 0.0) / (1.0 + dot(way, way));
    }
    pixel = vec4(sqrt(paint.r > 1.0 ? paint : paint * light), 1.0);
}"""
Rows = NDArray[np.float64]
Faces = tuple[Rows, Rows]


def box(x: float, low: float, high: float, z: float, color: Rows) -> Faces:
    """Return the four sides of a box about the middle, (4, 4, 3), and their colours, in the same shape."""
    round_it = [(-x, z), (x, z), (x, -z), (-x, -z), (-x, z)]
    sides = [[(a, low, b), (c, low, d), (c, high, d), (a, high, b)] for (a, b), (c, d) in pairwise(round_it)]
    return np.array(sides), np.tile(color, (4, 4, 1))


def both(face: list[tuple[float, float, float]], color: Rows) -> Faces:
    """Return a face, and the same one turned to the other side."""
    return np.array([face, np.array(face) * (-1.0, 1.0, -1.0)]), np.tile(color, (2, 4, 1))


def house(width: float, depth: float, height: float) -> list[Faces]:
    """Return the faces of a house: walls, lit windows, and a gable roof."""
    w, d, top, eaves, out = width / 2.0, depth / 2.0, height + 0.45 * width, height - 0.36, depth / 2.0 + 0.4
    return [
        box(w, -1.0, height, d, WALL), box(w + 0.02, 1.0, 2.0, 0.5, PANE), box(0.5, 1.0, 2.0, d + 0.02, PANE),
        both([(-w, height, d), (w, height, d), (0.0, top, d), (0.0, top, d)], WALL),
        both([(w + 0.4, eaves, out), (w + 0.4, eaves, -out), (0.0, top, -out), (0.0, top, out)], ROOF),
    ]  # fmt: skip


def ground(prairie: Prairie) -> Faces:
    """Return the faces of the ground, with sand where the lane is."""
    x, z = np.meshgrid(np.arange(-99.0, 100.0, 2.0), np.arange(-99.0, 100.0, 2.0))
    at = np.stack([x, prairie.height_at(np.stack([x, z], axis=-1).reshape(-1, 2)).reshape(x.shape), z], axis=-1)
    part = np.linspace(0.0, len(LANE) - 1.0, 120)
    lane = np.stack([np.interp(part, np.arange(len(LANE)), row) for row in np.array(LANE).T], axis=1)
    away = np.linalg.norm(at[:, :, None, ::2] - lane, axis=3).min(axis=2)
    sandy = np.clip((3.4 - away) / 1.5, 0.0, 1.0)[..., None]
    return quads(at), quads(sandy * SAND + (1.0 - sandy) * TURF)


def quads(grid: Rows) -> Rows:
    """Return the corners of a grid's cells, anticlockwise from above, (n, 4, 3)."""
    return np.stack([grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]], axis=2).reshape(-1, 4, 3)


class Game:
    """The window, the prairie, and the village that stands in it."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="A village at dusk", resizable=True)
        x, z = np.meshgrid(np.linspace(-100.0, 100.0, 101), np.linspace(-100.0, 100.0, 101))
        grass = {"height": (0.3, 0.65), "width": 0.014, "root": "#46562a", "tip": "#b9b06a"}
        hollow = 0.5 * np.sin(0.06 * x) - 4.0 * np.cos(np.pi * np.clip(np.hypot(x, z) / 40.0 - 1.1, 0.0, 1.0))
        light = {"azimuth": -75.0, "elevation": 3.8, "clouds": 0.35, "exposure": -0.8}
        self.prairie = Prairie.load(
            {"tallgrass": 2, "terrain": {"heights": hollow, "cell": 2.0}, "grass": {"meadow": grass}, "light": light},
            preset="medium",
        )
        self.prairie.clear(Road(LANE, width=3.6), soft=0.8)
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.mesh = self.built()
        self.shades = self.see_by_sun()
        self.window.push_handlers(self.on_draw)

    def put(self, faces: Faces, x: float, z: float, yaw: float = 0.0) -> Faces:
        """Return faces moved to a place on the ground, and turned."""
        s, c, y = sin(yaw), cos(yaw), float(self.prairie.height_at([(x, z)])[0])
        return faces[0] @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]) + (x, y, z), faces[1]

    def built(self) -> Any:
        """Return ground, houses and lamps as one list of triangles; no grass grows where a house stands."""
        parts, bulbs = [ground(self.prairie)], []
        for x, z, yaw, width, depth, height in HOUSES:
            w, d = width / 2.0, depth / 2.0
            self.prairie.clear(Footprint(corners=((-w, -d), (w, -d), (w, d), (-w, d))), pose=Pose(x, z, yaw))
            parts += [self.put(part, x, z, yaw) for part in house(width, depth, height)]
        for x, z in LAMPS:
            lamp = box(0.05, 0.0, POST, 0.05, IRON), box(0.14, POST - 0.15, POST + 0.2, 0.14, PANE)
            parts += [self.put(part, x, z) for part in lamp]
            bulbs.append((x, float(self.prairie.height_at([(x, z)])[0]) + POST, z))
            esper.create_entity(LANTERN, Pose(x, z, y=bulbs[-1][1]))
        sun = self.prairie.sun
        self.program["lamps"], self.program["sun"] = bulbs, sun.direction
        self.program["sunlight"], self.program["skylight"] = sun.colour, sun.sky
        self.program["lamplight"] = tuple(WARM * LANTERN.candela * sun.candela)
        faces, colors = (np.concatenate(each) for each in zip(*parts, strict=True))
        normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
        normal /= np.linalg.norm(normal, axis=1)[:, None]
        place, color = (each[:, (0, 1, 2, 0, 2, 3)].reshape(-1, 3) for each in (faces, colors))
        rows = {"place": place, "normal": np.repeat(normal, 6, axis=0), "color": color}
        given: dict[str, Any] = {name: ("f", row.ravel().tolist()) for name, row in rows.items()}
        return self.program.vertex_list(len(place), gl.GL_TRIANGLES, **given)

    def draw_mesh(self, view: Mat4, projection: Mat4) -> None:
        """Draw the game's own things."""
        self.window.view, self.window.projection = view, projection
        self.program.use()
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.mesh.draw(gl.GL_TRIANGLES)
        gl.glDisable(gl.GL_DEPTH_TEST)

    def see_by_sun(self) -> pyglet.image.Texture:
        """Draw the view from the sun into a depth texture, and return it."""
        depth = gl.GL_DEPTH_COMPONENT
        shades = pyglet.image.Texture.create(MAP, MAP, internalformat=gl.GL_DEPTH_COMPONENT24, fmt=depth)
        target = Framebuffer()
        target.attach_texture(shades, attachment=gl.GL_DEPTH_ATTACHMENT)
        target.bind()
        gl.glDrawBuffer(gl.GL_NONE)
        gl.glViewport(0, 0, MAP, MAP)
        gl.glClear(gl.GL_DEPTH_BUFFER_BIT)
        view = Mat4.look_at(Vec3(*self.prairie.sun.direction) * 120.0, Vec3(), UP)
        projection = Mat4.orthogonal_projection(-70, 70, -30, 30, 1, 260)
        self.draw_mesh(view, projection)
        target.unbind()
        gl.glViewport(0, 0, *self.window.get_framebuffer_size())
        self.program["seen_by_sun"] = projection @ view
        self.prairie.shadows([ShadowMap(shades, projection @ view, bias=0.2)])
        return shades

    def on_draw(self) -> None:
        """Draw ground and houses, then sky and grass."""
        eye = Vec3(2.0, float(self.prairie.height_at([(2.0, 41.0)])[0]) + 2.4, 41.0)
        view = Mat4.look_at(eye, eye + Vec3(-0.07, -0.05, -1.0), UP)
        projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 50.0)
        self.window.clear()
        gl.glBindTexture(gl.GL_TEXTURE_2D, self.shades.id)
        self.draw_mesh(view, projection)
        self.prairie.draw(view, projection, parts=("sky", "grass", "beyond"))


def main() -> None:
    """Show the village until the window is closed."""
    game = Game()
    pyglet.clock.schedule_interval(game.prairie.advance, 1 / 60)
    pyglet.app.run()
    game.prairie.release()


if __name__ == "__main__":
    main()  # so that the game goes before Python ends, when pyglet could not forget its handlers any more
