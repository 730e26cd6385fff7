// Changes of what lines of sight meet in bent grass, relative to grass at rest (Carpet.bent of grow.py).
#include "lib/canopy.glsl"
#include "systems/show/carpet/grow.py"

uniform sampler2DArray bents;  // layers: kinds; columns: posture indices from -1, towards the eye, to 1; rows: slopes

const float UPRIGHT = 1e-6;  // least posture index that has a direction
const float STEEPER = log(STEEPEST / FLATTEST);  // logarithm of the ratio of the last row's slope to the first's

// Entry of the table for a posture index, where `away` is the weight of bending away from the eye.
vec3 bent_entry(int kind, float index, float away, float slope) {
    vec2 size = vec2(textureSize(bents, 0).xy), column = ((0.5 + 0.5 * vec2(-index, index)) * (size.x - 1.0) + 0.5) / size.x;
    float row = (log(clamp(slope, FLATTEST, STEEPEST) / FLATTEST) / STEEPER * (size.y - 1.0) + 0.5) / size.y;
    vec4 towards = textureLod(bents, vec3(column.x, row, kind), 0.0);
    vec4 from = textureLod(bents, vec3(column.y, row, kind), 0.0);
    vec3 along = mix(towards.xyz, from.xyz, away);
    float with = 2.0 * away - 1.0, aside = 1.0 - with * with;  // cosine of the angle from the line of sight; square of its sine
    return vec3(along.x + aside * from.w, along.yz * (1.0 + aside * towards.w));
}

// Additional leaves that a line of sight meets in a kind with this bending, and factors of the places along blades and the heights at
// which it meets them. It runs along `heading`, at this slope to the ground and this pitch to upright grass; `as_dense` is the slope at
// which it would meet as much of the kind at rest, growing densely on level ground.
vec3 bent_change(int kind, vec2 bend, vec2 heading, float slope, float pitch, float as_dense) {
    float index = length(bend), away = 0.5 + 0.5 * dot(bend, heading) / max(index, UPRIGHT);
    pitch = max(pitch, FLATTEST);
    float leaves = bent_entry(kind, index, away, pitch / lodged(bend)).x * pitch / max(slope, LOWEST);
    return vec3(leaves, bent_entry(kind, index, away, as_dense).yz);
}
