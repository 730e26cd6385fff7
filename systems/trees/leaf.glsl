// Leaves: outlines and light.
#include "lib/least.glsl"
#include "systems/trees/habit.py"
#include "systems/trees/leaf_light.glsl"
#include "systems/trees/pigment.glsl"
#include "systems/trees/coverage.glsl"

uniform int form;

// Outlines: powers of the distance from the foot and from the tip; width, relative to the quad's.
const vec3 OVATE_OUTLINE = vec3(0.55, 0.8, 1.95), LOBED_OUTLINE = vec3(0.55, 0.35, 1.38);
const vec2 LOBES = vec2(0.2, 26.0);  // depth of lobes; their frequency [rad]
const vec2 DELTOID_FOOT = vec2(-0.02, 0.2), DELTOID_TIP = vec2(0.85, 1.12);  // where it widens; as of outlines, without the foot
const float LANCE_FOOT = 0.8;  // power of the distance from the foot, in a sine

float leaf_outline(float along, vec3 shape) {
    return shape.z * pow(along, shape.x) * pow(1.0 - along, shape.y);
}

// Half the width of a leaf at a part of its length, relative to its quad's.
float half_width(float along) {
    if (form == LANCE)
        return sin(PI * pow(along, LANCE_FOOT));
    if (form == DELTOID)
        return smoothstep(DELTOID_FOOT.x, DELTOID_FOOT.y, along) * pow(1.0 - along, DELTOID_TIP.x) * DELTOID_TIP.y;
    if (form == LOBED)
        return leaf_outline(along, LOBED_OUTLINE) * (1.0 - LOBES.x + LOBES.x * cos(along * LOBES.y));
    return leaf_outline(along, OVATE_OUTLINE);
}

const float TUFT_NEEDLES = 3.5;  // to either side of the middle of a tuft
const float TUFT_FOOT = 0.25;  // width at its foot, relative to that at its tip
const float TUFT_ROUNDED = 0.18;  // shortening of its outermost needles
const float NEEDLE_TAPERS = 0.2;  // narrowing of needles towards their tip, relative to their spacing
const vec2 NEEDLES_BLUR = vec2(0.8, 0.45);  // pixel size from which needles blur, relative to their spacing; coverage when blurred

// Coverage by needles, which fan out from their foot.
float needles_cover(vec2 on) {
    float fan = on.x / (TUFT_FOOT + (1.0 - TUFT_FOOT) * on.y), each = abs(fract(fan * TUFT_NEEDLES) - 0.5) * 2.0;
    float needle = each - 0.5 - NEEDLE_TAPERS * on.y, short_of = 1.0 - TUFT_ROUNDED * abs(fan) - on.y;
#ifdef SAMPLED
    return step(0.0, min(needle, short_of)) * step(abs(fan), 1.0);
#else
    float soft = max(fwidth(fan) * (2.0 * TUFT_NEEDLES), LEAST_WIDTH);
    float ends = clamp(short_of / max(fwidth(on.y), LEAST_WIDTH) + 0.5, 0.0, 1.0);
    float cover = mix(clamp(needle / soft + 0.5, 0.0, 1.0), NEEDLES_BLUR.y, clamp(soft - NEEDLES_BLUR.x, 0.0, 1.0));
    return cover * ends * step(abs(fan), 1.0);
#endif
}

// Coverage by a leaf at a position on its quad: across from -1 to 1, along from 0 to 1. A sample is in or out: an edge as wide as a
// sample would reach beyond the quad of a narrower leaf, and such leaves would hide too little.
float leaf_cover(vec2 on) {
    if (form == NEEDLES)
        return needles_cover(on);
    float inside = half_width(clamp(on.y, LEAST_PART, 1.0 - LEAST_PART)) - abs(on.x);
#ifdef SAMPLED
    return step(0.0, inside);
#else
    return sharpened(inside, 0.0, LEAST_WIDTH);
#endif
}
