// Leaves: their outlines, and how they send light.
#include "lib/least.glsl"
#include "systems/trees/habit.py"
#include "systems/trees/leaf_sends.glsl"
#include "systems/trees/pigment.glsl"
#include "systems/trees/shown.glsl"

uniform int form;

// Outlines: powers of the way from the foot and of that from the tip; how broad a leaf is, of its quad.
const vec3 OVATE_OUTLINE = vec3(0.55, 0.8, 1.95), LOBED_OUTLINE = vec3(0.55, 0.35, 1.38);
const vec2 LOBES = vec2(0.2, 26.0);  // how deeply lobes are cut; how fast they follow one another [rad]
const vec2 DELTOID_FOOT = vec2(-0.02, 0.2), DELTOID_TIP = vec2(0.85, 1.12);  // where it widens; as of outlines, without the foot
const float LANCE_FOOT = 0.8;  // a sine, over this power of the way

float outline(float along, vec3 shape) {
    return shape.z * pow(along, shape.x) * pow(1.0 - along, shape.y);
}

// Half the width of a leaf at a part of its length, of its quad's.
float half_width(float along) {
    if (form == LANCE)
        return sin(PI * pow(along, LANCE_FOOT));
    if (form == DELTOID)
        return smoothstep(DELTOID_FOOT.x, DELTOID_FOOT.y, along) * pow(1.0 - along, DELTOID_TIP.x) * DELTOID_TIP.y;
    if (form == LOBED)
        return outline(along, LOBED_OUTLINE) * (1.0 - LOBES.x + LOBES.x * cos(along * LOBES.y));
    return outline(along, OVATE_OUTLINE);
}

const float TUFT_NEEDLES = 3.5;  // to either side of the middle of a tuft
const float TUFT_FOOT = 0.25;  // how broad it is at its foot, of its tip
const float TUFT_ROUNDED = 0.18;  // how much shorter its outermost needles are
const float NEEDLE_TAPERS = 0.2;  // how much narrower they are at their tip, of the way from one to the next
const vec2 NEEDLES_BLUR = vec2(0.8, 0.45);  // pixel from which on they blur, of the way from one to its gap; coverage of such

// How much of a pixel is needles, which part from their foot.
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

// How much of a pixel is leaf, at a place on its quad: across from -1 to 1, and along from 0 to 1. A sample is on it or not: edges as
// wide as a sample would go beyond the quad of a leaf that is narrower, and such leaves would hide too little.
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
