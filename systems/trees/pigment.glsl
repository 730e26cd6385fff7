// Pigments of a kind of tree.
uniform vec3 dark;   // pigments: of leaves, and of bark
uniform vec3 bright;
uniform vec3 bark;
uniform vec3 young_bark;
uniform vec2 ripens; // radius of a stem on which bark begins to be as on old ones, and on which it is [m]
uniform float rough; // how deeply bark is furrowed; below 0 it has bands across

const float FURROWED_MEAN = 0.925, BANDED_MEAN = 0.88;  // how bright bark is with what it has on it, of its ground, in the mean

float bark_mean() {
    return rough < 0.0 ? BANDED_MEAN : mix(1.0, FURROWED_MEAN, rough);
}

// How old the bark of a stem is that has such a radius [m], 0 to 1.
float aged_at(float radius) {
    return clamp((radius - ripens.x) / (ripens.y - ripens.x), 0.0, 1.0);
}

// The pigment of leaves, dark to bright, or of bark so old.
vec3 pigment_of(float tone, float wood, float aged) {
    return mix(mix(dark, bright, tone), mix(young_bark, bark * bark_mean(), aged), wood);
}
