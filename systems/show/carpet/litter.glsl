// What lies on the ground between plants, litter and low leaves, in the mean over a pixel.
#include "systems/show/carpet/lying.glsl"
#ifdef TRODDEN
#include "systems/press/press.glsl"
#endif

const float LOW_LEAVES = 0.08;  // height that low leaves come to [m]: what is cut lower takes of them, too
const float TRODDEN_AWAY = 0.8;  // how many of them are hidden where grass lies flat: the ground between comes out
const float STUBS_FROM = 0.25;  // height [m] below which what a cut leaves shows more of the stubs, which are pale
const float PALER = 0.3;  // how much brighter their pigment is

// How far grass lies there that is trodden, of the posture index: the most of any kind.
float flatness_at(vec2 at) {
    float most = 0.0;
#ifdef TRODDEN
    if (trodden_at(at)) for (int kind = 0; kind < KINDS; kind++)
        most = max(most, length(pressing(at, kind)));
#endif
    return min(most, 1.0);
}

// What becomes of what lies there where grass is left to stand so high [m] and is trodden: how bright its pigment is, of what
// it was, and how much is left of low leaves.
vec2 after(float left, vec2 at) {
    float kept = 1.0 - TRODDEN_AWAY * flatness_at(at);
    if (!anything_is_cut())
        return vec2(1.0, kept);
    float stubs_from = min(STUBS_FROM, tallest_grass), low = min(left / min(LOW_LEAVES, tallest_grass), 1.0);
    return vec2(1.0 + PALER * low * max(1.0 - left / stubs_from, 0.0), low * kept);
}

// The pigment of what lies there, of that of the ground between low leaves, where grass is left to stand so high [m]; or that of
// a game's own ground. To the next pixel across and up it is so far over the ground [m].
vec3 pigment_lying(vec2 at, vec2 dx, vec2 dy, float bare, vec3 lush, float left) {
#ifndef PLAIN
    if (earth_side != 0.0) {
        vec2 scale = 1.0 / (earth_side > 0.0 ? vec2(earth_side) : terrain_size);
        return earth_pigment(textureGrad(earth, earth_uv(at), dx * scale, dy * scale));
    }
#endif
    return litter_pigment(lying_seen(at, dx, dy, bare) * after(left, at), lush);
}
