// The twin of systems/wind/whirlwind.py.

const float EYE = 0.3, UNEVEN = 0.18, FALLS = 0.85, LEAST_AWAY = 1e-6;

float mask(vec2 place, Whirlwind whirl) {
    return rim(length(place), -whirl.radius, whirl.radius, whirl.side);
}

vec2 action(vec2 place, Whirlwind whirl) {
    float away = max(length(place), LEAST_AWAY), part = min(away / whirl.radius, 1.0);
    vec2 outward = place / away;
    // Cosine of twice the angle around the middle minus the phase, by the difference formula.
    vec2 twice = vec2(outward.x * outward.x - outward.y * outward.y, 2.0 * outward.x * outward.y);
    float uneven = 1.0 - UNEVEN + UNEVEN * dot(twice, whirl.turned);
    float index = whirl.strength * (1.0 - part * part * FALLS) * uneven * eased(away / EYE);
    return whirl.sign * index * vec2(-outward.y, outward.x);
}
