// The twin of systems/wind/breeze.py.

const float WAVE = 7.0;

float mask(vec2 place, Wind wind) {
    return 1.0;
}

vec2 action(vec2 place, Wind wind) {
    float heading = value(wind, 0), strength = value(wind, 1), gustiness = value(wind, 2);
    vec4 wave = smooth_noise(wind, 0, place / WAVE + vec2(value(wind, 3), value(wind, 4)));
    float index = clamp(strength * (1.0 + gustiness * (wave.x + 0.5 * wave.y)), 0.0, 1.0);
    float angle = heading + 0.7 * gustiness * wave.z;
    return index * vec2(sin(angle), -cos(angle));
}
