"""A lake that mirrors its reeds: the prairie is drawn twice, once as the water sees it, and the water between.

The mirrored picture is another viewer. Its projection has an oblique near plane, the water's own (Lengyel, 2005), so
that the lake's bed is not in it. The water is opaque and drawn before the prairie, so reeds stand in it. The arrow keys
turn the view, Escape ends. Run it with `python lake.py`.
"""

from math import cos, radians, sin

import numpy as np
import pyglet
from numpy.typing import NDArray
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.image.buffer import Framebuffer, Renderbuffer
from pyglet.math import Mat4, Vec3
from pyglet.window import key

from tallgrass import Prairie

SIZE, CELL, UP = (960, 540), 1.0, Vec3(0.0, 1.0, 0.0)
MIRRORED = Mat4.from_scale(Vec3(1.0, -1.0, 1.0))  # the water is at y = 0
EYE = (-4.0, 1.5, 41.5)

VERTEX = """#version 330 core
in vec2 place;
uniform WindowBlock { mat4 projection; mat4 view; } window;
out vec3 seen;
void main() {
    seen = vec3(place.x, 0.0, place.y);
    gl_Position = window.projection * window.view * vec4(seen, 1.0);
}"""
FRAGMENT = """#version 330 core
in vec3 seen;
out vec4 pixel;
uniform sampler2D mirrored;
uniform vec3 eye;
uniform float time;
uniform float wind;
vec2 waves(vec2 at) {
    vec2 slope = vec2(0.0);
    for (int wave = 0; wave < 9; wave++) {
        float turn = 2.4 * float(wave * wave), many = 1.6 * pow(1.45, float(wave));
        vec2 way = vec2(cos(turn), sin(turn));
        slope += way * cos(many * dot(way, at) - time * sqrt(9.8 * many) + turn) / 9.0;
    }
    return slope;
}
void main() {
    vec3 toward = eye - seen;
    float far = length(toward);
    vec2 slope = waves(seen.xz) * (0.02 + 0.12 * wind) / (1.0 + 0.05 * far);
    float up = max(toward.y / far + slope.x, 0.0);
    float fresnel = 0.02 + 0.98 * pow(1.0 - up, 5.0);
    vec2 moved = vec2(0.2 * slope.x, 0.5 * abs(slope.y));  // never into the near bank
    vec2 at = gl_FragCoord.xy / vec2(textureSize(mirrored, 0)) + moved;
    pixel = vec4(mix(vec3(0.05, 0.09, 0.07), texture(mirrored, clamp(at, 0.002, 0.998)).rgb, fresnel), 1.0);
}"""


def land() -> dict[str, object]:
    """Return the scene: a lake in a meadow, with reeds where its water is shallow."""
    x, z = np.meshgrid(np.arange(-110.0, 110.5, CELL), np.arange(-110.0, 110.5, CELL))
    angle = np.arctan2(z, x)
    shore = 38.0 + 7.0 * np.sin(2.0 * angle + 0.5) + 3.5 * np.sin(5.0 * angle)
    away = np.hypot(x, z) - shore
    heights = np.where(away < 0.0, 0.16, 0.06) * away + 0.5 * np.sin(x * 0.07) * np.clip(away / 20.0, 0.0, 1.0)
    shallow = np.exp(-(((heights + 0.22) / 0.28) ** 2))
    many = shallow * (np.sin(x * 0.21) + np.sin(z * 0.17 + 1.0) > -0.3) * (z < shore)
    reed = {"height": (1.2, 2.0), "width": 0.022, "stiffness": 1.4, "profile": "fold", "clumping": 0.7}
    plume = {"form": "plume", "size": (0.2, 0.32), "share": 0.3}
    meadow = {"height": (0.2, 0.45), "width": 0.014}
    return {
        "tallgrass": 2,
        "terrain": {"heights": np.maximum(heights, -3.0).astype(np.float32), "cell": CELL},
        "grass": {
            "reed": {**reed, "head": plume, "root": "#5f6f38", "tip": "#b9a377", "place": {"map": many}},
            "meadow": {**meadow, "place": {"map": np.clip(heights / 0.3, 0.0, 1.0)}},
        },
        "wind": [{"kind": "breeze", "direction": 70, "strength": 0.3, "gustiness": 0.7}],
        "light": {"hour": 17.6, "clouds": 0.3},
    }


def cut_off(projection: Mat4, view: Mat4) -> NDArray[np.float64]:
    """Return a projection whose near plane is the water's surface in a mirrored view: all below it is clipped."""
    made, see = (np.array(matrix).reshape(4, 4).T for matrix in (projection, view))
    plane = np.array([0.0, 1.0, 0.0, -0.02]) @ np.linalg.inv(see)
    corner = np.linalg.inv(made) @ [np.sign(plane[0]), np.sign(plane[1]), 1.0, 1.0]
    made[2] = plane * (2.0 / (plane @ corner)) - made[3]
    return made


class Game:
    """The window, the prairie, and the lake."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="A lake")
        self.prairie = Prairie.load(land(), preset="medium")
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        corners = (-60.0, -60.0, 60.0, -60.0, -60.0, 60.0, 60.0, 60.0)
        self.water = self.program.vertex_list(4, gl.GL_TRIANGLE_STRIP, place=("f", corners))
        width, height = self.window.get_framebuffer_size()
        self.mirrored = pyglet.image.Texture.create(width, height)
        self.target = Framebuffer()
        self.target.attach_texture(self.mirrored)
        depth = Renderbuffer(width, height, gl.GL_DEPTH_COMPONENT24)
        self.target.attach_renderbuffer(depth, attachment=gl.GL_DEPTH_ATTACHMENT)
        self.yaw, self.eye = radians(4.0), Vec3(*EYE)
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)

    def update(self, dt: float) -> None:
        """Advance the time by `dt` [s]."""
        self.prairie.advance(dt)
        self.yaw += 0.6 * dt * (self.keys[key.RIGHT] - self.keys[key.LEFT])

    def draw_mirrored(self, view: Mat4, projection: Mat4) -> None:
        """Draw the mirrored view into a texture."""
        self.target.bind()
        gl.glClear(gl.GL_COLOR_BUFFER_BIT | gl.GL_DEPTH_BUFFER_BIT)
        self.prairie.draw(view @ MIRRORED, cut_off(projection, view @ MIRRORED), viewer="mirror")
        self.target.unbind()

    def on_draw(self) -> None:
        """Draw the mirrored picture, the water with it, and then the prairie."""
        ahead = Vec3(sin(self.yaw), -0.07, -cos(self.yaw))
        view = Mat4.look_at(self.eye, self.eye + ahead, UP)
        projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 45.0)
        self.draw_mirrored(view, projection)
        self.window.clear()
        self.window.view, self.window.projection = view, projection
        gl.glEnable(gl.GL_DEPTH_TEST)
        self.program.use()
        self.program["eye"], self.program["time"] = tuple(self.eye), self.prairie.time
        self.program["wind"] = float(np.hypot(*self.prairie.wind_at([(0.0, 0.0)])[0]))
        gl.glBindTexture(gl.GL_TEXTURE_2D, self.mirrored.id)
        self.water.draw(gl.GL_TRIANGLE_STRIP)
        gl.glDisable(gl.GL_DEPTH_TEST)
        self.prairie.draw(view, projection)


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
