// The twin of systems/wind/turbulence.py; its sheets are the tables of systems/wind/eddies.py.

const float CLOSER = 24.0;
const int FINE = 256;

float mask(vec2 place, Turbulence air) {
    return 1.0;
}

vec2 action(vec2 place, Turbulence air) {
    vec2 at = vec2(air.lie.x * place.x - air.lie.y * place.y, air.lie.y * place.x + air.lie.x * place.y);
    vec4 large = smooth_noise(air.wind, 0, at + air.shift.xy);
    vec4 small = smooth_noise(air.wind, 1, CLOSER * at + air.shift.zw, FINE);
    vec2 eddy = air.share.x * large.xy + air.share.y * large.zw + air.share.z * small.xy + air.share.w * small.zw;
    vec2 message = (1.0 + eddy.x) * air.mean + eddy.y * vec2(-air.mean.y, air.mean.x);
    return message / max(length(message), 1.0);
}
