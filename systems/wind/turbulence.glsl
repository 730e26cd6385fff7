// The twin of systems/wind/turbulence.py; its sheets are the tables of systems/wind/eddies.py.

const float FINER = 8.0;

float mask(vec2 place, Wind wind) {
    return 1.0;
}

vec2 action(vec2 place, Wind wind) {
    vec2 ahead = vec2(value(wind, 0), value(wind, 1)), lie = vec2(value(wind, 2), value(wind, 3));
    vec2 at = vec2(lie.x * place.x - lie.y * place.y, lie.y * place.x + lie.x * place.y);
    vec4 large = smooth_noise(wind, 0, at + vec2(value(wind, 4), value(wind, 5)));
    vec4 small = smooth_noise(wind, 1, FINER * at + vec2(value(wind, 6), value(wind, 7)));
    vec2 eddy = value(wind, 8) * large.xy + value(wind, 9) * large.zw;
    eddy += value(wind, 10) * small.xy + value(wind, 11) * small.zw;
    vec2 message = (1.0 + eddy.x) * ahead + eddy.y * vec2(-ahead.y, ahead.x);
    return message / max(length(message), 1.0);
}
