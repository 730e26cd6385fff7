// Depth of soft edges: leaves up to `behind` deeper have the same colour, so only what sticks out of a crown needs soft edges.
uniform float behind;  // [m]

// Clip position of a place with the depth of one `off` behind it [m].
vec4 pushed_back(vec3 place, float off) {
    vec4 at = clip * vec4(place, 1.0), back = clip * vec4(place + off * normalize(place - eye), 1.0);
    at.z = back.z / back.w * at.w;
    return at;
}

vec4 clip_position(vec3 place) {
#ifdef SOFT
    return pushed_back(place, behind);
#else
    return clip * vec4(place, 1.0);
#endif
}

// Length of leaves up to which hardly any pixel is all leaf [pixels]. Of longer ones, edges a pixel wide are a part that falls as
// their length rises.
const float ALL_EDGES = 4.0;

// Clip position of wood among leaves of a length [pixels]; `leafy` is 1 where leaves surround it. Thin stems are as far behind as the
// soft edges of leaves, or as far as these are a part of them, so that leaves in front hide as much. They are no farther behind than
// high over the ground, which would hide them.
vec4 clip_position_among_leaves(vec3 place, float leafy, float leaf, float high) {
#ifdef SAMPLED
    return clip * vec4(place, 1.0);
#else
    return pushed_back(place, min(behind * leafy * min(ALL_EDGES / leaf, 1.0), max(high, 0.0)));
#endif
}

// Depth offset of soft edges, relative to the usual depths: opaque pixels hide their own soft ones before these are shaded. It is a few
// steps of 24 bits.
const float JUST_BEHIND = 4e-7;

vec4 just_behind(vec4 at) {
#ifdef SOFT
    at.z += depth_offset(JUST_BEHIND) * at.w;
#endif
    return at;
}
