// Transmittance of a medium, leaves or air, by its optical depth (Beer, 1852; for leaves, Monsi and Saeki, 1953). All shaders
// use this one.
float transmittance(float depth) {
    return exp(-depth);
}

vec2 transmittance(vec2 depth) {
    return exp(-depth);
}

vec3 transmittance(vec3 depth) {
    return exp(-depth);
}

vec4 transmittance(vec4 depth) {
    return exp(-depth);
}
