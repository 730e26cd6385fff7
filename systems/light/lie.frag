// How a place lies to the sun: with STILL the terrain's normal (x, z) and two slow noises; without, how high the terrain
// stands before the sun, as the tangent of the angle that it is seen at.
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

void main() {
    vec2 place = corner + at * terrain_size;
    float foot = height_at(place) + ABOVE, away = FIRST * terrain_cell, most = LEVEL;
    for (int step = 0; step < STEPS; step++) {
        vec2 there = place + toward_sun * away;
        vec2 inside = abs(there - terrain_origin - 0.5 * terrain_size);
        if (highest - foot < most * away || any(greaterThan(inside, 0.5 * terrain_size)))
            break;
        most = max(most, (height_at(there) - foot) / away);
        away *= LONGER;
    }
    told = vec4(most);
}
#endif
