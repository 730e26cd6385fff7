// What lines of sight meet of grass that the wind bends, beside what they meet of it at rest (Carpet.bent of grow.py).
#include "lib/canopy.glsl"
#include "systems/show/carpet/grow.py"

uniform sampler2DArray bents;  // by kind: in columns posture indices from -1, towards the eye, to 1; in rows slopes

const float UPRIGHT = 1e-6;  // posture index that a direction is told of at least
const float STEEPER = log(STEEPEST / FLATTEST);  // from the first row to the last, in logarithms of slope

vec3 bents_at(int kind, float index, float away, float slope) {
    vec2 size = vec2(textureSize(bents, 0).xy), column = ((0.5 + 0.5 * vec2(-index, index)) * (size.x - 1.0) + 0.5) / size.x;
    float row = (log(clamp(slope, FLATTEST, STEEPEST) / FLATTEST) / STEEPER * (size.y - 1.0) + 0.5) / size.y;
    vec4 towards = textureLod(bents, vec3(column.x, row, kind), 0.0);
    return mix(towards, textureLod(bents, vec3(column.y, row, kind), 0.0), away).xyz;
}

// How many more leaves a line of sight meets where `bend` bends a kind, and by which factors the places along blades and the
// heights change that it meets them at. It runs along `heading` and has this slope to the ground, and its pitch to grass that
// stands upright; `as_dense` is the slope at which it would meet as much of the kind at rest, growing densely on level ground.
vec3 bent_to(int kind, vec2 bend, vec2 heading, float slope, float pitch, float as_dense) {
    float index = length(bend), away = 0.5 + 0.5 * dot(bend, heading) / max(index, UPRIGHT);
    pitch = max(pitch, FLATTEST);
    float leaves = bents_at(kind, index, away, pitch / lodged(bend)).x * pitch / max(slope, LOWEST);
    return vec3(leaves, bents_at(kind, index, away, as_dense).yz);
}
