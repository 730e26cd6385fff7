// Light in a crown: transmittance of its leaves.
#include "lib/canopy.glsl"
#include "systems/trees/motion.py"

const float BELOW_REACHES = 0.4;  // part of the light from below that reaches the depth of a crown

// Displacement of a trunk at a part of its height, relative to its top's: it bends as a cantilever.
float cantilever(float high) {
    return 0.5 * high * high * (LOAD_AT_END - high);
}

// Transmittance of the crown towards the sun, from optical depth linear in the direction to it in the tree's own axes.
float sun_transmittance(vec4 shading, vec3 to_sun, float foliage) {
    return transmittance(foliage * max(dot(shading, vec4(to_sun, 1.0)), 0.0));
}

// Transmittance of the crown towards the sky all round.
float sky_transmittance(vec4 shading, float foliage) {
    return transmittance(SKY_MEETS_LESS * foliage * max(shading.w + SKY_FROM * shading.y, 0.0));
}

// Radiance of the sky and of the light from below on a face; `up` is its normal's y, -1 to 1.
vec3 hemisphere_light(vec3 sky, vec3 below, float open, float up) {
    return sky * open * (0.5 + 0.5 * up) + below * (mix(BELOW_REACHES, 1.0, open) * (0.5 - 0.5 * up));
}
