// Optical depth at a place in a crown, linear in direction, as pictures pack it.
#include "systems/trees/motion.py"

const vec2 SHADING = vec2(3.0, 6.0);  // scale of a picture's values: of the directional parts, and of the mean

vec4 packed_shading(vec4 shading) {
    return clamp(vec4(0.5 + 0.5 * shading.xyz / SHADING.x, shading.w / SHADING.y), 0.0, 1.0);
}

// Weights of a picture's values for the optical depth of a ray `from` a direction in the tree's axes, and in all.
vec4 meets_by(vec3 from, float foliage) {
    return foliage * vec4(2.0 * SHADING.x * from, SHADING.y);
}

float foliage_of(vec4 meets) {
    return meets.w / SHADING.y;
}

// Optical depth of the sun's light, as in `through_crown`, and of the sky's.
float sun_meets(vec4 shading, vec4 meets) {
    return max(dot(shading, meets) - 0.5 * (meets.x + meets.y + meets.z), 0.0);
}

float sky_meets(vec4 shading, vec4 meets) {
    const float UP = SKY_FROM * SHADING.x / SHADING.y;
    return SKY_MEETS_LESS * meets.w * max(shading.w + UP * (2.0 * shading.y - 1.0), 0.0);
}
