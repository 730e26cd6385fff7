// How a place lies to the sun: with STILL the terrain's normal (x, z) and two slow noises; without, how high the terrain
// stands before the sun, as the tangent of the angle that it is seen at. With MIRRORED that is told for what the sun is in the
// terrain's own place, and in its mirror images along x, z and both.
#include "lib/terrain.glsl"
#include "systems/light/lie.py"

in vec2 at;
out vec4 told;

uniform vec2 corner;  // where the map begins, x, z [m]

#ifdef STILL
uniform sampler2D slow;

void main() {
    vec2 place = corner + at * terrain_size, step = vec2(terrain_cell, 0.0);
    vec2 rise = vec2(height_at(place + step.xy) - height_at(place - step.xy),
                     height_at(place + step.yx) - height_at(place - step.yx)) / (2.0 * terrain_cell);
    vec3 normal = normalize(vec3(-rise.x, 1.0, -rise.y));
    told = vec4(normal.xz, 2.0 * textureLod(slow, at, 0.0).rg - 1.0);
}
#else
uniform float highest;  // ground of the terrain [m]

const float ABOVE = 0.05;  // how high over the ground the sun is looked for [m]
const float LEVEL = -0.05;  // what stands before the sun over level ground: below any sun

float before_sun(vec2 place, vec2 toward) {
    float foot = height_at(place) + ABOVE, away = FIRST * terrain_cell, most = LEVEL;
    for (int step = 0; step < STEPS; step++) {
        vec2 there = place + toward * away;
#ifdef MIRRORED
        bool ends = false;
#else
        vec2 inside = abs(there - terrain_origin - 0.5 * terrain_size);
        bool ends = any(greaterThan(inside, 0.5 * terrain_size));
#endif
        if (highest - foot < most * away || ends)
            break;
        most = max(most, (height_at(there) - foot) / away);
        away *= LONGER;
    }
    return most;
}

void main() {
    vec2 place = corner + at * terrain_size;
#ifdef MIRRORED
    const vec2 TURNED = vec2(-1.0, 1.0);
    told.rg = vec2(before_sun(place, toward_sun), before_sun(place, toward_sun * TURNED.xy));
    told.ba = vec2(before_sun(place, toward_sun * TURNED.yx), before_sun(place, toward_sun * TURNED.xx));
#else
    told = vec4(before_sun(place, toward_sun));
#endif
}
#endif
