// How many leaves light meets on its way to a place in a crown, by direction and in all, as pictures have it.
#include "systems/trees/motion.py"

const vec2 SHADING = vec2(3.0, 6.0);  // by how much of light's way in the crown textures' bytes count, to either side and in all

vec4 packed_shading(vec4 shading) {
    return clamp(vec4(0.5 + 0.5 * shading.xyz / SHADING.x, shading.w / SHADING.y), 0.0, 1.0);
}

// By how much of that a ray from there meets leaves, along each axis of a tree and in all, where it has so many of its leaves.
vec4 meets_by(vec3 from, float foliage) {
    return foliage * vec4(2.0 * SHADING.x * from, SHADING.y);
}

float foliage_of(vec4 meets) {
    return meets.w / SHADING.y;
}

// How many leaves of it the sun's light meets, as `through_crown` has it, and how many the sky's does.
float sun_meets(vec4 shading, vec4 meets) {
    return max(dot(shading, meets) - 0.5 * (meets.x + meets.y + meets.z), 0.0);
}

float sky_meets(vec4 shading, vec4 meets) {
    const float UP = SKY_FROM * SHADING.x / SHADING.y;
    return SKY_MEETS_LESS * meets.w * max(shading.w + UP * (2.0 * shading.y - 1.0), 0.0);
}
