// Light inside of a crown: what its leaves let through.
#include "lib/canopy.glsl"
#include "systems/trees/motion.py"

const float LOAD_AT_END = 3.0;  // of a cantilever, whose line is (3 x² - x³) / 2
const float LAWN_REACHES = 0.4;  // of the light from below, what comes to the depth of a crown

// How far aside a trunk is at a part of its height, of how far its top is: it bends as a cantilever does.
float cantilever(float high) {
    return 0.5 * high * high * (LOAD_AT_END - high);
}

// How much of the sun comes through the crown where so many leaves are met, by the direction to it, in the tree's own axes, and a
// constant; it has so many of its leaves.
float through_crown(vec4 shading, vec3 to_sun, float foliage) {
    return comes_through(foliage * max(dot(shading, vec4(to_sun, 1.0)), 0.0));
}

// How much of the sky is seen from there, which lies above all round.
float sky_through(vec4 shading, float foliage) {
    return comes_through(SKY_MEETS_LESS * foliage * max(shading.w + SKY_FROM * shading.y, 0.0));
}

// The light of the sky and from below on a face there that looks so far up, -1 to 1.
vec3 sky_on(vec3 sky, vec3 below, float open, float up) {
    return sky * open * (0.5 + 0.5 * up) + below * (mix(LAWN_REACHES, 1.0, open) * (0.5 - 0.5 * up));
}
