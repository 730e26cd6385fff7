"""A meadow on another planet: the sky is the game's own, with a ringed world, a moon and stars.

The game draws its sky first and leaves the part `sky` out of the prairie. So that grass is lit by that sky and fades
into it, the light's keys `zenith` and `horizon` are the sky's colours, and the sun stands where both have it. The left
and right arrow keys turn the view. Run it with `python planet.py`.
"""

from math import cos, radians, sin

import numpy as np
import pyglet
from pyglet import gl
from pyglet.graphics.shader import Shader, ShaderProgram
from pyglet.math import Mat4, Vec3
from pyglet.window import key

from tallgrass import Prairie

SIZE, UP = (960, 540), Vec3(0.0, 1.0, 0.0)
SUN, WORLD, MOON = (-62.0, 13.0), (9.0, 15.0), (-26.0, 19.0)  # azimuths and elevations [degrees]
ZENITH, HORIZON = "#1d2a44", "#d9957a"
SCENE = {
    "tallgrass": 2,
    "seed": 11,
    "terrain": {"noise": "rolling", "seed": 9, "size": (300, 300), "feature": 90, "scale": 12},
    "grass": {
        "blue": {"height": (0.35, 0.7), "width": 0.02, "root": "#14343a", "tip": "#4fa3a0", "variety": 0.25},
        "ember": {
            "plant": "flower", "height": (0.5, 0.9), "tip": "#ff7a3c", "root": "#5a2030", "plants": 6,
            "head": {"size": (0.04, 0.06)},
        },
    },
    "wind": [{"kind": "breeze", "direction": 40, "strength": 0.3}],
    "light": {
        "azimuth": SUN[0], "elevation": SUN[1], "sun": "#ffd0a8", "zenith": ZENITH, "horizon": HORIZON, "haze": 700,
        "ground": "#3a2430",
    },
}  # fmt: skip

VERTEX = """#version 330 core
in vec2 corner;
uniform mat4 ahead;
out vec3 ray;
void main() {
    ray = (ahead * vec4(corner, 1.0, 1.0)).xyz;
    gl_Position = vec4(corner, 0.0, 1.0);
}"""
FRAGMENT = """#version 330 core
in vec3 ray;
out vec4 pixel;
uniform vec3 sun, world, moon, zenith, horizon;
float noise(vec3 at) {
    vec3 cell = floor(at), part = fract(at);
    part *= part * (3.0 - 2.0 * part);
    float value = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        vec3 way = vec3(corner & 1, corner >> 1 & 1, corner >> 2);
        vec3 weight = mix(1.0 - part, part, way);
        value += weight.x * weight.y * weight.z * fract(sin(dot(cell + way, vec3(12.9, 78.2, 37.7))) * 43758.5);
    }
    return value;
}
// A ball in the sky: its light where a line of sight meets it, and how much of the sky it hides.
vec4 ball(vec3 toward, vec3 middle, float size, vec3 bands) {
    float along = dot(toward, middle), near = along * along - 1.0 + size * size;
    if (near < 0.0 || along < 0.0) return vec4(0.0);
    vec3 normal = (toward * (along - sqrt(near)) - middle) / size;
    float day = max(dot(normal, sun), 0.0), edge = smoothstep(0.0, 0.04, near / (size * size));
    float storm = noise(normal * vec3(3.0, 14.0, 3.0) + 4.0 * noise(normal * 4.0));
    vec3 color = mix(bands, bands.bgr * 0.6 + 0.25, storm);
    return vec4(color * (0.02 + 1.1 * day), edge);
}
void main() {
    vec3 toward = normalize(ray);
    float low = pow(1.0 - max(toward.y, 0.0), 6.0), glow = pow(max(dot(toward, sun), 0.0), 24.0);
    vec3 air = mix(zenith, horizon, low) + vec3(0.9, 0.45, 0.2) * glow * (0.25 + low);
    float star = step(0.9985, noise(floor(toward * 240.0) + 0.5)) * (1.0 - low);
    vec3 color = star * vec3(0.8, 0.85, 1.0);
    vec4 seen = ball(toward, world, 0.15, vec3(0.75, 0.5, 0.35));
    color = mix(color, seen.rgb, seen.a);
    vec3 side = normalize(cross(vec3(0.45, 1.0, 0.25), world)), up = cross(world, side);
    vec2 off = vec2(dot(toward, side), 4.0 * dot(toward, up)) / 0.15;
    float wide = length(off), grooves = 0.4 + 0.6 * noise(vec3(30.0 * wide, 0.0, 0.0));
    float ring = smoothstep(1.3, 1.4, wide) * smoothstep(2.3, 2.1, wide) * grooves * step(0.0, dot(toward, world));
    if (seen.a < 1.0 || off.y < 0.0) color = mix(color, vec3(0.8, 0.68, 0.55), 0.75 * ring);
    seen = ball(toward, moon, 0.035, vec3(0.55, 0.5, 0.48));
    color = mix(color, seen.rgb, seen.a);
    color = max(color * (1.0 - 0.6 * low), 0.0) + air;
    color += vec3(8.0, 6.0, 4.0) * smoothstep(0.9995, 0.9998, dot(toward, sun));
    float grit = fract(sin(dot(gl_FragCoord.xy, vec2(12.9, 78.2))) * 43758.5) / 255.0;
    pixel = vec4(color / (1.0 + 0.25 * color) + grit, 1.0);
}"""


def direction(azimuth: float, elevation: float) -> tuple[float, float, float]:
    """Return a direction in the sky from its azimuth and elevation [degrees]."""
    turn, up = radians(azimuth), radians(elevation)
    return cos(up) * sin(turn), sin(up), -cos(up) * cos(turn)


class Game:
    """The window, the prairie and its sky."""

    def __init__(self) -> None:
        self.window = pyglet.window.Window(*SIZE, caption="Another planet", resizable=True)
        self.prairie = Prairie.load(SCENE, preset="medium")
        self.program = ShaderProgram(Shader(VERTEX, "vertex"), Shader(FRAGMENT, "fragment"))
        self.sky = self.program.vertex_list(3, gl.GL_TRIANGLES, corner=("f", (-1.0, -1.0, 3.0, -1.0, -1.0, 3.0)))
        for name, place in (("sun", SUN), ("world", WORLD), ("moon", MOON)):
            self.program[name] = direction(*place)
        for name, color in (("zenith", ZENITH), ("horizon", HORIZON)):
            self.program[name] = tuple(int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5))
        self.yaw = radians(-8.0)
        self.eye = Vec3(10.0, float(self.prairie.height_at([(10.0, 60.0)])[0]) + 1.7, 60.0)
        self.keys = key.KeyStateHandler()
        self.window.push_handlers(self.keys, self.on_draw)

    def update(self, dt: float) -> None:
        """Advance the time by `dt` [s]."""
        self.prairie.advance(dt)
        self.yaw += 0.8 * dt * (self.keys[key.RIGHT] - self.keys[key.LEFT])

    def on_draw(self) -> None:
        """Draw the sky, and the rest of the prairie before it."""
        ahead = Vec3(sin(self.yaw), 0.06, -cos(self.yaw))
        view = Mat4.look_at(self.eye, self.eye + ahead, UP)
        projection = Mat4.perspective_projection(self.window.aspect_ratio, 0.1, 2000.0, 50.0)
        turned = np.array(Mat4.look_at(Vec3(), ahead, UP)).reshape(4, 4).T  # without the eye's place
        inverse = np.linalg.inv(np.array(projection).reshape(4, 4).T @ turned)
        self.window.clear()
        self.program.use()
        self.program["ahead"] = inverse.T.ravel().tolist()
        self.sky.draw(gl.GL_TRIANGLES)
        self.prairie.draw(view, projection, parts=("ground", "grass", "beyond"))


if __name__ == "__main__":
    game = Game()
    pyglet.clock.schedule_interval(game.update, 1 / 60)
    pyglet.app.run()
    game.prairie.release()
