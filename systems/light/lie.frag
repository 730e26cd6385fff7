// How a place lies to the sun: with STILL the terrain's normal (x, z) and two slow noises; without, how high the terrain
// stands before the sun, as the tangent of the angle that it is seen at.
#include "lib/terrain.glsl"

in vec2 at;
out vec4 told;

#ifdef STILL
uniform sampler2D slow;

void main() {
    vec2 place = terrain.xy + at * field.xy, step = vec2(terrain.z, 0.0);
    vec2 rise = vec2(height_at(place + step.xy) - height_at(place - step.xy),
                     height_at(place + step.yx) - height_at(place - step.yx)) / (2.0 * terrain.z);
    vec3 normal = normalize(vec3(-rise.x, 1.0, -rise.y));
    told = vec4(normal.xz, 2.0 * textureLod(slow, at, 0.0).rg - 1.0);
}
#else
uniform vec2 rows;      // the first that is drawn, and how many are, of all
uniform float highest;  // ground of the terrain [m]

const int STEPS = 40;
const float LEVEL = -0.05;  // what stands before the sun over level ground: below any sun

void main() {
    vec2 place = terrain.xy + vec2(at.x, rows.x + rows.y * at.y) * field.xy;
    float foot = height_at(place) + 0.05, away = 1.2 * terrain.z, most = LEVEL;
    for (int step = 0; step < STEPS; step++) {
        vec2 there = place + drift.zw * away;
        vec2 inside = abs(there - terrain.xy - 0.5 * field.xy);
        if (highest - foot < most * away || any(greaterThan(inside, 0.5 * field.xy)))
            break;
        most = max(most, (height_at(there) - foot) / away);
        away *= 1.15;
    }
    told = vec4(most);
}
#endif
