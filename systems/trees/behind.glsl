// Where soft edges of leaves are: as far behind as other leaves are like them, so that only what sticks out of a crown has them.
uniform float behind;  // [m]

// Where a place is in the picture, as deep as one that is so far behind it [m].
vec4 as_deep(vec3 place, float off) {
    vec4 at = clip * vec4(place, 1.0), back = clip * vec4(place + off * normalize(place - eye), 1.0);
    at.z = back.z / back.w * at.w;
    return at;
}

vec4 stood(vec3 place) {
#ifdef SOFT
    return as_deep(place, behind);
#else
    return clip * vec4(place, 1.0);
#endif
}

// Length of leaves up to which hardly any pixel is all leaf, and edges are most of them [pixels]: of longer ones, edges that are a
// pixel wide are a part that falls as their length rises.
const float ALL_EDGES = 4.0;

// Where wood is among leaves that are so long [pixels], as far as any stand about it. Thin stems are as far behind as the soft edges
// of leaves, or as far as these are a part of them: so as much as is in front of stems hides them. They are no farther behind than
// high over the ground, which would hide them.
vec4 stood_among_leaves(vec3 place, float leafy, float leaf, float high) {
#ifdef SAMPLED
    return clip * vec4(place, 1.0);
#else
    return as_deep(place, min(behind * leafy * min(ALL_EDGES / leaf, 1.0), max(high, 0.0)));
#endif
}

// How much deeper, of the usual depths, lie the soft edges of what is drawn as it is: what is opaque there hides what would be
// left out of them, before pixels are asked. It is a few steps of 24 bits.
const float JUST_BEHIND = 4e-7;

vec4 just_behind(vec4 at) {
#ifdef SOFT
    at.z += farther_by(JUST_BEHIND) * at.w;
#endif
    return at;
}
