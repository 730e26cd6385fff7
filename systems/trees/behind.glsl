// Where soft edges of leaves are: as far behind as other leaves are like them, so that only what sticks out of a crown has them.
const float BEHIND = 1.5;  // [m]

vec4 stood(vec3 place) {
    vec4 at = clip * vec4(place, 1.0);
#ifdef SOFT
    vec4 behind = clip * vec4(place + BEHIND * normalize(place - eye), 1.0);
    at.z = behind.z / behind.w * at.w;
#endif
    return at;
}
