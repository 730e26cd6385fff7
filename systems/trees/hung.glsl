// What is told of a twig's card, in few bytes: numbers of 16 bits, two in one of 32.
const float IN_HALF = 65535.0;  // the greatest number of 16 bits
const float LONGEST = 2.0;  // how long an axis is at most, of the twig
const float BRIGHTEST = 64.0;  // radiance that is told at most; its root is told, as dark ones are to differ in less
const uint LOW = 65535u;
const int HIGH = 16;

uint two(vec2 parts) {
    uvec2 whole = uvec2(clamp(parts, 0.0, 1.0) * IN_HALF + 0.5);
    return whole.x | whole.y << HIGH;
}

vec2 two_of(uint told) {
    return vec2(told & LOW, told >> HIGH) / IN_HALF;
}

vec3 packed_axis(vec3 axis) {
    return 0.5 + axis * (0.5 / LONGEST);
}

vec3 axis_of(vec3 told) {
    return (told - 0.5) * (2.0 * LONGEST);
}

vec3 packed_light(vec3 light) {
    return sqrt(light / BRIGHTEST);
}

vec3 light_of(vec3 told) {
    return told * told * BRIGHTEST;
}
