// Postures: the place of a point on a bent blade (paper, section 3.2).
#include "lib/frame.glsl"

uniform sampler2DArray postures;

// Where the point `t` of a blade of length 1 is for a bending vector: along x, up, along z.
vec3 posture(float variant, vec2 bend, float t) {
    float index = length(bend);
    vec2 heading = bend / max(index, 1e-6);
    float column = (t * terrain.w + 0.5) / (terrain.w + 1.0);
    float row = ((0.5 + 0.5 * min(index, 1.0)) * (field.z - 1.0) + 0.5) / field.z;
    vec2 spine = textureLod(postures, vec3(column, row, variant), 0.0).xy;
    return vec3(heading.x * spine.x, spine.y, heading.y * spine.x);
}
