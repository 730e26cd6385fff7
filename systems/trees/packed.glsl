// Optical depth at a place in a crown, linear in direction, as pictures pack it.
#include "systems/trees/motion.py"

const vec2 SHADING_RANGE = vec2(3.0, 6.0);  // scale of a picture's values: of the directional parts, and of the mean

vec4 packed_shading(vec4 shading) {
    return clamp(vec4(0.5 + 0.5 * shading.xyz / SHADING_RANGE.x, shading.w / SHADING_RANGE.y), 0.0, 1.0);
}

// Weights of a picture's values for the optical depth of a ray `from` a direction in the tree's axes, and in all.
vec4 depth_weights(vec3 from, float foliage) {
    return foliage * vec4(2.0 * SHADING_RANGE.x * from, SHADING_RANGE.y);
}

float foliage_of(vec4 weights) {
    return weights.w / SHADING_RANGE.y;
}

// Optical depth of the sun's light, as in `sun_transmittance`, and of the sky's.
float sun_depth(vec4 shading, vec4 weights) {
    return max(dot(shading, weights) - 0.5 * (weights.x + weights.y + weights.z), 0.0);
}

float sky_depth(vec4 shading, vec4 weights) {
    const float UP = SKY_FROM * SHADING_RANGE.x / SHADING_RANGE.y;
    return SKY_MEETS_LESS * weights.w * max(shading.w + UP * (2.0 * shading.y - 1.0), 0.0);
}
