// Pigments of a kind of tree.
#include "systems/trees/parameter.py"

const float FURROWED_MEAN = 0.925, BANDED_MEAN = 0.88;  // mean brightness of furrowed and banded bark, relative to its ground
const vec2 SOILED = vec2(0.3, 2.8);  // heights between which soil and moss on bark end, relative to the grass's, with noise added
const float SOIL_TONE = 0.62;  // brightness of bark below them, relative to clean bark
const float RIBBED = 0.8;  // tone of a leaf's midrib, relative to the leaf's

// Brightness of bark under soil and moss at a height, relative to the grass's.
float soil_tone(float height) {
    return mix(SOIL_TONE, 1.0, smoothstep(SOILED.x, SOILED.y, height));
}

float bark_mean() {
    return rough < 0.0 ? BANDED_MEAN : mix(1.0, FURROWED_MEAN, rough);
}

// Age of the bark of a stem of a radius [m], 0 to 1.
float bark_age(float radius) {
    return clamp((radius - ripens.x) * ripens.y, 0.0, 1.0);
}

// Mean pigment of old bark.
vec3 old_bark_mean() {
    return bark * bark_mean();
}

// Pigment of leaves, from dark to bright, or of bark.
vec3 pigment_of(float tone, float wood, vec3 on_stem) {
    return mix(mix(dark, bright, tone), on_stem, wood);
}

vec3 pigment_of(float tone, float wood, float aged) {
    return pigment_of(tone, wood, mix(young_bark, old_bark_mean(), aged));
}
