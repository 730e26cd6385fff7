// Values of a twig packed in few bytes: two numbers of 16 bits in one of 32.
const float IN_HALF = 65535.0;  // greatest number of 16 bits
const float LONGEST = 2.0;  // greatest length of an axis, of the twig's
const float BRIGHTEST = 64.0;  // greatest radiance; its root is packed, as dark ones need finer steps
const float IN_REST = 16383.0;  // greatest number of 14 bits, which are left beside a picture's index
const int PICTURE_BITS = 2;
const uint PICTURE_MASK = 3u;
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

// Values of a twig on its card; card.vert describes them.
struct HungCard {
    vec3 along;
    vec3 aside;
    vec4 relief;
    vec3 darkest;
    vec3 brightest;
    float picture;
};

void pack(HungCard told, out uvec4 axes, out uvec4 colors) {
    vec3 along = packed_axis(told.along), aside = packed_axis(told.aside);
    vec3 dark = packed_light(told.darkest), bright = packed_light(told.brightest);
    vec4 relief = clamp(vec4(packed_axis(told.relief.xyz), packed_axis(told.relief.www).x), 0.0, 1.0);
    axes = uvec4(two(along.xy), two(vec2(along.z, aside.x)), two(aside.yz), two(relief.xy));
    uint both = uint(relief.w * IN_REST + 0.5) << PICTURE_BITS | uint(told.picture);
    colors = uvec4(two(vec2(relief.z, 0.0)) | both << HIGH, two(dark.xy), two(vec2(dark.z, bright.x)), two(bright.yz));
}

HungCard hung_card(uvec4 axes, uvec4 colors) {
    uint both = colors.x >> HIGH;
    vec2 second = two_of(axes.y), seventh = two_of(colors.z), fifth = vec2(two_of(colors.x).x, float(both >> PICTURE_BITS) / IN_REST);
    vec3 along = axis_of(vec3(two_of(axes.x), second.x)), aside = axis_of(vec3(second.y, two_of(axes.z)));
    vec4 relief = vec4(axis_of(vec3(two_of(axes.w), fifth.x)), axis_of(fifth.yyy).x);
    vec3 dark = light_of(vec3(two_of(colors.y), seventh.x)), bright = light_of(vec3(seventh.y, two_of(colors.w)));
    return HungCard(along, aside, relief, dark, bright, float(both & PICTURE_MASK));
}

// Values of a twig drawn leaf by leaf.
struct HungLeaves {
    vec3 along;
    vec3 aside;
    vec3 sun;     // radiance from the sun; on faces up and down; haze in front
    vec3 above;
    vec3 below;
    vec3 haze;
    float turns;  // rotation of leaves by the wind [rad]
    int number;   // index of the twig
};

void pack(HungLeaves told, out uvec4 axes, out uvec4 light, out uvec2 haze) {
    vec3 along = packed_axis(told.along), aside = packed_axis(told.aside);
    vec3 from_sun = packed_light(told.sun), above = packed_light(told.above), below = packed_light(told.below), before = packed_light(told.haze);
    vec2 own = vec2(packed_axis(vec3(told.turns)).x, float(told.number) / IN_HALF);
    axes = uvec4(two(along.xy), two(vec2(along.z, aside.x)), two(aside.yz), two(own));
    light = uvec4(two(from_sun.xy), two(vec2(from_sun.z, above.x)), two(above.yz), two(below.xy));
    haze = uvec2(two(vec2(below.z, before.x)), two(before.yz));
}

HungLeaves hung_leaves(uvec4 axes, uvec4 light, uvec2 haze) {
    vec2 second = two_of(axes.y), sixth = two_of(light.y), ninth = two_of(haze.x), own = two_of(axes.w);
    vec3 along = axis_of(vec3(two_of(axes.x), second.x)), aside = axis_of(vec3(second.y, two_of(axes.z)));
    vec3 above = light_of(vec3(sixth.y, two_of(light.z))), below = light_of(vec3(two_of(light.w), ninth.x));
    vec3 from_sun = light_of(vec3(two_of(light.x), sixth.x)), before = light_of(vec3(ninth.y, two_of(haze.y)));
    return HungLeaves(along, aside, from_sun, above, below, before, axis_of(vec3(own.x)).x, int(own.y * IN_HALF + 0.5));
}
