// The twin of systems/wind/blast.py; its sheet is the field of systems/wind/outline.py.

const float PULSE = 0.14, AT_ONCE = 1.5, SOFT_RIM = 0.45, TURN = 6.28318530717959;

// Depth inside the outline [m], and the direction outwards.
vec3 outline_at(vec2 place, Blast blast) {
    vec2 at = clamp((place - blast.corner) / blast.stride, vec2(0.0), blast.last);
    ivec2 low = ivec2(at);
    vec2 part = at - vec2(low);
    vec3 far = mix(sheet(blast.wind, 0, low).xyz, sheet(blast.wind, 0, low + ivec2(1, 0)).xyz, part.x);
    vec3 near = mix(sheet(blast.wind, 0, low + ivec2(0, 1)).xyz, sheet(blast.wind, 0, low + ivec2(1, 1)).xyz, part.x);
    return mix(far, near, part.y);
}

float mask(vec2 place, Blast blast) {
    return eased(outline_at(place, blast).x / blast.side);
}

vec2 action(vec2 place, Blast blast) {
    vec3 found = outline_at(place, blast);
    float outer = 1.0 - clamp(found.x / blast.deepest, 0.0, 1.0);
    float pulse = sin(TURN * (AT_ONCE * outer - blast.turn));
    return found.yz * blast.mean * (1.0 + PULSE * pulse) * eased((1.0 - outer) / SOFT_RIM);
}
