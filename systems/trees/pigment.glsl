// Pigments of a kind of tree.
uniform vec3 dark;   // pigments: of leaves, and of bark
uniform vec3 bright;
uniform vec3 bark;
uniform float rough; // how deeply bark is furrowed; below 0 it has bands across

const float FURROWED_MEAN = 0.925, BANDED_MEAN = 0.88;  // how bright bark is with what it has on it, of its ground, in the mean

float bark_mean() {
    return rough < 0.0 ? BANDED_MEAN : mix(1.0, FURROWED_MEAN, rough);
}

// The pigment of leaves, dark to bright, or of bark.
vec3 pigment_of(float tone, float wood) {
    return mix(mix(dark, bright, tone), bark * bark_mean(), wood);
}
