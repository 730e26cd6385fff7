// Values of a twig packed in few bytes: two numbers of 16 bits in one of 32.
const float MAX16 = 65535.0;  // greatest number of 16 bits
const float LONGEST = 2.0;  // greatest length of an axis, relative to the twig's
const float BRIGHTEST = 64.0;  // greatest radiance; its root is packed, as dark ones need finer steps
const float MAX14 = 16383.0;  // greatest number of 14 bits, which are left beside a picture's index
const int PICTURE_BITS = 2;
const uint PICTURE_MASK = 3u;
const uint LOW = 65535u;
const int HIGH = 16;

uint pack16(vec2 parts) {
    uvec2 whole = uvec2(clamp(parts, 0.0, 1.0) * MAX16 + 0.5);
    return whole.x | whole.y << HIGH;
}

vec2 unpack16(uint values) {
    return vec2(values & LOW, values >> HIGH) / MAX16;
}

vec3 packed_axis(vec3 axis) {
    return 0.5 + axis * (0.5 / LONGEST);
}

vec3 unpacked_axis(vec3 values) {
    return (values - 0.5) * (2.0 * LONGEST);
}

vec3 packed_light(vec3 light) {
    return sqrt(light / BRIGHTEST);
}

vec3 unpacked_light(vec3 values) {
    return values * values * BRIGHTEST;
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

void pack(HungCard values, out uvec4 axes, out uvec4 colors) {
    vec3 along = packed_axis(values.along), aside = packed_axis(values.aside);
    vec3 dark = packed_light(values.darkest), bright = packed_light(values.brightest);
    vec4 relief = clamp(vec4(packed_axis(values.relief.xyz), packed_axis(values.relief.www).x), 0.0, 1.0);
    axes = uvec4(pack16(along.xy), pack16(vec2(along.z, aside.x)), pack16(aside.yz), pack16(relief.xy));
    uint relief_and_picture = uint(relief.w * MAX14 + 0.5) << PICTURE_BITS | uint(values.picture);
    colors = uvec4(pack16(vec2(relief.z, 0.0)) | relief_and_picture << HIGH, pack16(dark.xy), pack16(vec2(dark.z, bright.x)), pack16(bright.yz));
}

HungCard unpack_card(uvec4 axes, uvec4 colors) {
    uint relief_and_picture = colors.x >> HIGH;
    vec2 second = unpack16(axes.y), seventh = unpack16(colors.z);
    vec2 fifth = vec2(unpack16(colors.x).x, float(relief_and_picture >> PICTURE_BITS) / MAX14);
    vec3 along = unpacked_axis(vec3(unpack16(axes.x), second.x)), aside = unpacked_axis(vec3(second.y, unpack16(axes.z)));
    vec4 relief = vec4(unpacked_axis(vec3(unpack16(axes.w), fifth.x)), unpacked_axis(fifth.yyy).x);
    vec3 dark = unpacked_light(vec3(unpack16(colors.y), seventh.x)), bright = unpacked_light(vec3(seventh.y, unpack16(colors.w)));
    return HungCard(along, aside, relief, dark, bright, float(relief_and_picture & PICTURE_MASK));
}

// Values of a twig drawn leaf by leaf.
struct HungLeaves {
    vec3 along;
    vec3 aside;
    vec3 sun;     // radiance from the sun; on faces up and down; haze in front
    vec3 above;
    vec3 below;
    vec3 haze;
    float rotation; // rotation of leaves by the wind [rad]
    int number;     // index of the twig
};

void pack(HungLeaves values, out uvec4 axes, out uvec4 light, out uvec2 haze) {
    vec3 along = packed_axis(values.along), aside = packed_axis(values.aside);
    vec3 from_sun = packed_light(values.sun), above = packed_light(values.above);
    vec3 below = packed_light(values.below), haze_light = packed_light(values.haze);
    vec2 last = vec2(packed_axis(vec3(values.rotation)).x, float(values.number) / MAX16);
    axes = uvec4(pack16(along.xy), pack16(vec2(along.z, aside.x)), pack16(aside.yz), pack16(last));
    light = uvec4(pack16(from_sun.xy), pack16(vec2(from_sun.z, above.x)), pack16(above.yz), pack16(below.xy));
    haze = uvec2(pack16(vec2(below.z, haze_light.x)), pack16(haze_light.yz));
}

HungLeaves unpack_leaves(uvec4 axes, uvec4 light, uvec2 haze) {
    vec2 second = unpack16(axes.y), sixth = unpack16(light.y), ninth = unpack16(haze.x), last = unpack16(axes.w);
    vec3 along = unpacked_axis(vec3(unpack16(axes.x), second.x)), aside = unpacked_axis(vec3(second.y, unpack16(axes.z)));
    vec3 above = unpacked_light(vec3(sixth.y, unpack16(light.z))), below = unpacked_light(vec3(unpack16(light.w), ninth.x));
    vec3 from_sun = unpacked_light(vec3(unpack16(light.x), sixth.x)), haze_light = unpacked_light(vec3(ninth.y, unpack16(haze.y)));
    return HungLeaves(along, aside, from_sun, above, below, haze_light, unpacked_axis(vec3(last.x)).x, int(last.y * MAX16 + 0.5));
}
