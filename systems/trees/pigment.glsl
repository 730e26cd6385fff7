// Pigments of a kind of tree.
#include "systems/trees/parameter.py"

const float FURROWED_MEAN = 0.925, BANDED_MEAN = 0.88;  // how bright bark is with what it has on it, of its ground, in the mean
const vec2 SOILED = vec2(0.3, 2.8);  // heights between which soil and moss on bark end, of the grass's, and with noise of it
const float SOIL_TONE = 0.62;  // how bright bark is below them, of what it is

// How much of bark is left of soil and moss where it stands so high, of the grass there.
float soiled_at(float height) {
    return mix(SOIL_TONE, 1.0, smoothstep(SOILED.x, SOILED.y, height));
}

float bark_mean() {
    return rough < 0.0 ? BANDED_MEAN : mix(1.0, FURROWED_MEAN, rough);
}

// How old the bark of a stem is that has such a radius [m], 0 to 1.
float aged_at(float radius) {
    return clamp((radius - ripens.x) * ripens.y, 0.0, 1.0);
}

// The pigment of old bark in the mean.
vec3 old_bark_mean() {
    return bark * bark_mean();
}

// The pigment of leaves, dark to bright, or of bark.
vec3 pigment_of(float tone, float wood, vec3 on_stem) {
    return mix(mix(dark, bright, tone), on_stem, wood);
}

vec3 pigment_of(float tone, float wood, float aged) {
    return pigment_of(tone, wood, mix(young_bark, old_bark_mean(), aged));
}
