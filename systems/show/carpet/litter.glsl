// Litter and low leaves on the ground between plants, averaged over a pixel.
#include "systems/show/carpet/lying.glsl"
#ifdef TRODDEN
#include "systems/press/press.glsl"
#endif

const float LOW_LEAVES = 0.08;  // height of low leaves [m]: lower cuts shorten them, too
const float TRODDEN_AWAY = 0.8;  // fraction of them that is hidden where grass lies flat, which shows the ground between
const float STUBS_FROM = 0.25;  // cut height below which pale stubs show [m]
const float PALER = 0.3;  // excess of their brightness, in pigment

// Posture index of trodden grass, the largest of any kind.
float flatness_at(vec2 at) {
    float most = 0.0;
#ifdef TRODDEN
    if (trodden_at(at)) for (int kind = 0; kind < KINDS; kind++)
        most = max(most, length(pressing(at, kind)));
#endif
    return min(most, 1.0);
}

// Factors where grass is cut to `cut_height` [m] and trodden: of the brightness of litter, and of the amount of low leaves.
vec2 after_cut(float cut_height, vec2 at) {
    float kept = 1.0 - TRODDEN_AWAY * flatness_at(at);
    if (!anything_is_cut())
        return vec2(1.0, kept);
    float stubs_from = min(STUBS_FROM, tallest_grass), low = min(cut_height / min(LOW_LEAVES, tallest_grass), 1.0);
    return vec2(1.0 + PALER * low * max(1.0 - cut_height / stubs_from, 0.0), low * kept);
}

// Pigment of litter and low leaves where grass is cut to `cut_height` [m]; or that of a game's own ground. `dx` and `dy` are offsets over
// the ground to the next pixels across and up [m], `lush` the relative pigment of the understorey.
vec3 ground_pigment(vec2 at, vec2 dx, vec2 dy, float bare, vec3 lush, float cut_height) {
#ifndef PLAIN
    if (earth_side != 0.0) {
        vec2 scale = 1.0 / (earth_side > 0.0 ? vec2(earth_side) : terrain_size);
        return earth_pigment(textureGrad(earth, earth_uv(at), dx * scale, dy * scale));
    }
#endif
    return litter_pigment(litter_at(at, dx, dy, bare) * after_cut(cut_height, at), lush);
}
