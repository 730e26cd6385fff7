// The twin of systems/wind/blast.py; its sheet is the field of systems/wind/outline.py.

const float PULSE = 0.14, TURN = 6.28318530717959;

// Depth inside the outline [m], and the direction outwards.
vec3 outline_at(vec2 place, Wind wind) {
    float stride = value(wind, 2);
    vec2 away = (place - vec2(value(wind, 0), value(wind, 1))) / stride;
    vec2 at = clamp(away, vec2(0.0), vec2(value(wind, 3), value(wind, 4)));
    ivec2 low = ivec2(at);
    vec2 part = at - vec2(low), beyond = abs(away - at);
    vec3 far = mix(sheet(wind, 0, low).xyz, sheet(wind, 0, low + ivec2(1, 0)).xyz, part.x);
    vec3 near = mix(sheet(wind, 0, low + ivec2(0, 1)).xyz, sheet(wind, 0, low + ivec2(1, 1)).xyz, part.x);
    vec3 found = mix(far, near, part.y);
    return max(beyond.x, beyond.y) > 1.0 ? vec3(-stride, found.yz) : found;
}

float mask(vec2 place, Wind wind) {
    return eased(outline_at(place, wind).x / value(wind, 5));
}

vec2 action(vec2 place, Wind wind) {
    vec3 found = outline_at(place, wind);
    float outer = 1.0 - clamp(found.x / value(wind, 6), 0.0, 1.0);
    float pulse = sin(TURN * (1.5 * outer - value(wind, 8)));
    return found.yz * value(wind, 7) * (1.0 + PULSE * pulse) * eased((1.0 - outer) / 0.45);
}
