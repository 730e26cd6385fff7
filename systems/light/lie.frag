// How a place lies to the sun: the sine of the sun's elevation over its slope, and how much of the sun's disc is seen past
// the terrain. Two slow noises are handed on.
#include "lib/terrain.glsl"

uniform sampler2D slow;
uniform float highest;  // ground of the terrain [m]

in vec2 at;
out vec4 told;

const int STEPS = 40;
const float SOFT = 0.02;  // half the width of a shadow's edge, of the distance from what casts it; the sun's alone is 0.005

float sun_past(vec3 place) {
    float seen = 1.0, away = 1.2 * terrain.z, level = length(sun.xz), rise = max(sun.y, 0.01) / max(level, 1e-4);
    vec2 ahead = sun.xz / max(level, 1e-4);
    for (int step = 0; step < STEPS; step++) {
        float over = place.y + away * rise;
        vec2 there = place.xz + ahead * away;
        vec2 inside = abs(there - terrain.xy - 0.5 * field.xy);
        if (over > highest || any(greaterThan(inside, 0.5 * field.xy)))
            break;
        seen = min(seen, 0.5 + 0.5 * (over - height_at(there)) / (SOFT * away));
        away *= 1.15;
    }
    return smoothstep(0.0, 1.0, clamp(seen, 0.0, 1.0));
}

void main() {
    vec2 place = terrain.xy + at * field.xy, step = vec2(terrain.z, 0.0);
    vec2 rise = vec2(height_at(place + step.xy) - height_at(place - step.xy),
                     height_at(place + step.yx) - height_at(place - step.yx)) / (2.0 * terrain.z);
    vec3 normal = normalize(vec3(-rise.x, 1.0, -rise.y));
    vec3 ground = vec3(place.x, height_at(place) + 0.05, place.y);
    told = vec4(max(dot(normal, sun.xyz), 0.0), sun_past(ground), textureLod(slow, at, 0.0).rg);
}
