// Where soft edges of leaves are: as far behind as other leaves are like them, so that only what sticks out of a crown has them.
uniform float behind;  // [m]

vec4 stood(vec3 place) {
    vec4 at = clip * vec4(place, 1.0);
#ifdef SOFT
    vec4 back = clip * vec4(place + behind * normalize(place - eye), 1.0);
    at.z = back.z / back.w * at.w;
#endif
    return at;
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
