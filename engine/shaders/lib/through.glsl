// What comes through so much of a medium, leaves or air: its pieces hide one another by chance (Beer, 1852; of leaves, Monsi and
// Saeki, 1953). It stands here alone.
float comes_through(float depth) {
    return exp(-depth);
}

vec2 comes_through(vec2 depth) {
    return exp(-depth);
}

vec3 comes_through(vec3 depth) {
    return exp(-depth);
}

vec4 comes_through(vec4 depth) {
    return exp(-depth);
}
