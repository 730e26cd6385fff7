// The twin of systems/wind/gust.py.

float mask(vec2 place, Gust gust) {
    vec2 along = gust.ahead_behind;
    return rim(place.x, -0.5 * gust.width, 0.5 * gust.width, gust.side) * rim(place.y, along.x, along.y, gust.end);
}

const vec2 BENDS = vec2(4.1, 1.7);  // scale of the two waves of the front [m/rad]
const float LOWER = 0.6;  // height of the second, of the first

float lag(float across, Gust gust) {
    float wave = dot(sin(across / BENDS + gust.waves), vec2(1.0, LOWER));
    return gust.ragged * (0.5 + 0.5 * wave / (1.0 + LOWER));
}

vec2 action(vec2 place, Gust gust) {
    float elapsed = (place.y - lag(place.x, gust)) / gust.speed;
    float index = after_start(gust.wind, elapsed) + after_stop(gust.wind, elapsed - gust.hold) - 1.0;
    float fade = clamp((gust.hold + gust.tail - elapsed) / (0.5 * gust.tail), 0.0, 1.0);
    return vec2(0.0, clamp(-gust.strength * index * fade, -1.0, 1.0));
}
