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
