// The twin of systems/wind/breeze.py.

const float WAVE = 7.0, VEERS = 0.7;

float mask(vec2 place, Breeze breeze) {
    return 1.0;
}

vec2 action(vec2 place, Breeze breeze) {
    vec4 wave = smooth_noise(breeze.wind, 0, place / WAVE + breeze.shift);
    float index = clamp(breeze.strength * (1.0 + breeze.gustiness * (wave.x + 0.5 * wave.y)), 0.0, 1.0);
    float angle = breeze.heading + VEERS * breeze.gustiness * wave.z;
    return index * vec2(sin(angle), -cos(angle));
}
