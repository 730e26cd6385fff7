// The twin of systems/wind/whirlwind.py.

const float EYE = 0.3, UNEVEN = 0.18;

float mask(vec2 place, Wind wind) {
    float radius = value(wind, 0);
    return rim(length(place), -radius, radius, value(wind, 1));
}

vec2 action(vec2 place, Wind wind) {
    float away = max(length(place), 1e-6), part = min(away / value(wind, 0), 1.0);
    vec2 out_there = place / away;
    // The cosine of twice the angle around, less the phase, whose cosine and sine come along.
    vec2 twice = vec2(out_there.x * out_there.x - out_there.y * out_there.y, 2.0 * out_there.x * out_there.y);
    float uneven = 1.0 - UNEVEN + UNEVEN * dot(twice, vec2(value(wind, 4), value(wind, 5)));
    float index = value(wind, 2) * (1.0 - part * part * 0.85) * uneven * eased(away / EYE);
    return value(wind, 3) * index * vec2(-out_there.y, out_there.x);
}
