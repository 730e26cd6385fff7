// Values of a twig packed in few bytes: several numbers in one of 32 bits.
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

// Numbers of at most `most` on either side of 0, in 11, 11 and 10 bits.
const vec3 MAX11 = vec3(2047.0, 2047.0, 1023.0);
const uvec3 MASK11 = uvec3(2047u, 2047u, 1023u), AT11 = uvec3(0u, 11u, 22u);

uint pack11(vec3 values, float most) {
    uvec3 whole = uvec3(clamp(0.5 + values * (0.5 / most), 0.0, 1.0) * MAX11 + 0.5) << AT11;
    return whole.x | whole.y | whole.z;
}

vec3 unpack11(uint values, float most) {
    return vec3(uvec3(values) >> AT11 & MASK11) * (2.0 * most / MAX11) - most;
}

// Light in one number with a shared exponent, as of the format RGB9_E5.
const uvec3 AT9 = uvec3(0u, 9u, 18u);
const uint MASK9 = 511u;
const float MAX9 = 511.0, EXPONENT_BIAS = 24.0;
const int EXPONENT_AT = 27;
const float DARKEST_PACKED = 6e-8;

uint pack_shared(vec3 light) {
    float power = ceil(log2(max(max(light.x, max(light.y, light.z)), DARKEST_PACKED)));
    uvec3 whole = uvec3(light * exp2(-power) * MAX9 + 0.5) << AT9;
    return whole.x | whole.y | whole.z | uint(power + EXPONENT_BIAS) << EXPONENT_AT;
}

vec3 unpack_shared(uint values) {
    return vec3(uvec3(values) >> AT9 & MASK9) * (exp2(float(values >> EXPONENT_AT) - EXPONENT_BIAS) / MAX9);
}

// Offset from `hung_from` in two numbers: three of 19 bits, and the power of two that they are relative to.
const float MAX19 = 524287.0, POWER_BIAS = 64.0, LEAST_OFFSET = 1e-3;
const uint MASK19 = 524287u;
const ivec4 AT19 = ivec4(19, 13, 6, 25);  // shifts of y, of y's rest, of z and of the power

uvec2 pack_offset(vec3 offset) {
    vec3 sides = abs(offset);
    float power = ceil(log2(max(max(sides.x, max(sides.y, sides.z)), LEAST_OFFSET)));
    uvec3 whole = uvec3((0.5 + 0.5 * offset * exp2(-power)) * MAX19 + 0.5);
    return uvec2(whole.x | whole.y << AT19.x, whole.y >> AT19.y | whole.z << AT19.z | uint(power + POWER_BIAS) << AT19.w);
}

vec3 unpack_offset(uvec2 values) {
    vec3 whole = vec3(uvec3(values.x, values.x >> AT19.x | values.y << AT19.y, values.y >> AT19.z) & MASK19);
    return (whole * (2.0 / MAX19) - 1.0) * exp2(float(values.y >> AT19.w) - POWER_BIAS);
}

// Values of a twig on its card, in 32 bytes; card.vert describes them.
struct HungCard {
    vec3 offset;   // of its foot from `hung_from` [m]
    float size;      // its length, 0 where it is left out [m]
    vec3 along;
    vec3 aside;
    vec4 relief;
    vec3 darkest;
    vec3 brightest;
    float picture;
};

const float LONGEST_CARD = 64.0;  // greatest length of a twig [m]; its root is packed
const float FLUTTERING = 1.25;  // greatest length of an axis, with its leaves' rotation, relative to the twig's

void pack(HungCard values, out uvec4 place, out uvec4 look) {
    uint constant = uint(packed_axis(values.relief.www).x * MAX14 + 0.5) << PICTURE_BITS | uint(values.picture);
    uint rest = pack16(vec2(sqrt(values.size / LONGEST_CARD), 0.0)) | constant << HIGH;
    place = uvec4(pack_offset(values.offset), pack11(values.along, FLUTTERING), pack11(values.aside, FLUTTERING));
    look = uvec4(rest, pack11(values.relief.xyz, LONGEST), pack_shared(values.darkest), pack_shared(values.brightest));
}

HungCard unpack_card(uvec4 place, uvec4 look) {
    uint constant = look.x >> HIGH;
    float root_of_size = unpack16(look.x).x, everywhere = unpacked_axis(vec3(constant >> PICTURE_BITS) / MAX14).x;
    vec3 along = unpack11(place.z, FLUTTERING), aside = unpack11(place.w, FLUTTERING);
    return HungCard(
        unpack_offset(place.xy), root_of_size * root_of_size * LONGEST_CARD, along, aside, vec4(unpack11(look.y, LONGEST), everywhere),
        unpack_shared(look.z), unpack_shared(look.w), float(constant & PICTURE_MASK));
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
