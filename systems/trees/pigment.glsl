// Pigments of a kind of tree.
#include "systems/trees/told.py"

const float FURROWED_MEAN = 0.925, BANDED_MEAN = 0.88;  // how bright bark is with what it has on it, of its ground, in the mean

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
