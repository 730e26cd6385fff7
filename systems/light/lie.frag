// With SLOPES, the slope map: the terrain's normal (x, z) and two slow noises. Without, the horizon map: tangent of the horizon's elevation
// towards the sun. With MIRRORED, its four channels are for the terrain and its mirror images along x, z and both.
#include "lib/terrain.glsl"
#include "systems/light/lie.py"

in vec2 at;
out vec4 texel;

uniform vec2 corner;  // the map's corner (x, z) [m]

#ifdef SLOPES
uniform sampler2D slow;

void main() {
    vec2 place = corner + at * terrain_size, step = vec2(terrain_cell, 0.0);
    vec2 rise = vec2(height_at(place + step.xy) - height_at(place - step.xy),
                     height_at(place + step.yx) - height_at(place - step.yx)) / (2.0 * terrain_cell);
    vec3 normal = normalize(vec3(-rise.x, 1.0, -rise.y));
    texel = vec4(normal.xz, 2.0 * textureLod(slow, at, 0.0).rg - 1.0);
}
#else
uniform float highest;  // height of the terrain's highest ground [m]

const float ABOVE = 0.05;  // height above the ground from which the horizon is seen [m]
const float LEVEL = -0.05;  // horizon of level ground: below any sun

float horizon_toward(vec2 place, vec2 toward) {
    float eye_height = height_at(place) + ABOVE, away = FIRST * terrain_cell, horizon = LEVEL;
    for (int step = 0; step < STEPS; step++) {
        vec2 there = place + toward * away;
#ifdef MIRRORED
        bool ends = false;
#else
        vec2 inside = abs(there - terrain_origin - 0.5 * terrain_size);
        bool ends = any(greaterThan(inside, 0.5 * terrain_size));
#endif
        if (highest - eye_height < horizon * away || ends)
            break;
        horizon = max(horizon, (height_at(there) - eye_height) / away);
        away *= LONGER;
    }
    return horizon;
}

void main() {
    vec2 place = corner + at * terrain_size;
#ifdef MIRRORED
    const vec2 MIRROR = vec2(-1.0, 1.0);
    texel.rg = vec2(horizon_toward(place, toward_sun), horizon_toward(place, toward_sun * MIRROR.xy));
    texel.ba = vec2(horizon_toward(place, toward_sun * MIRROR.yx), horizon_toward(place, toward_sun * MIRROR.xx));
#else
    texel = vec4(horizon_toward(place, toward_sun));
#endif
}
#endif
