// The twin of systems/wind/gust.py.

float mask(vec2 place, Wind wind) {
    float across = rim(place.x, value(wind, 0), value(wind, 1), value(wind, 2));
    return across * rim(place.y, value(wind, 3), value(wind, 4), value(wind, 5));
}

float lag(float across, Wind wind) {
    float wave = sin(across / 4.1 + value(wind, 11)) + sin(across / 1.7 + value(wind, 12)) * 0.6;
    return value(wind, 10) * (0.5 + wave / 3.2);
}

vec2 action(vec2 place, Wind wind) {
    float speed = value(wind, 6), hold = value(wind, 7), tail = value(wind, 8), strength = value(wind, 9);
    float elapsed = (place.y - lag(place.x, wind)) / speed;
    float index = after_start(wind, elapsed) + after_stop(wind, elapsed - hold) - 1.0;
    float left = clamp((hold + tail - elapsed) / (0.5 * tail), 0.0, 1.0);
    return vec2(0.0, clamp(-strength * index * left, -1.0, 1.0));
}
