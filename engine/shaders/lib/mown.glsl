// Up to which height grass is left to stand where it has been cut.
#include "lib/sown.glsl"

uniform sampler2D mown;  // over the terrain: up to which height grass is left to stand [m]; one texel where nothing has been cut

// Whether anything has been, anywhere: else nobody need look. Programs that are made for either case are told by CUT.
bool anything_is_cut() {
#ifdef CUT
    return CUT > 0;
#else
    return anything_cut > 0.5;
#endif
}

// Beyond the terrain nobody mows.
bool can_be_mown(vec2 place) {
    vec2 beside = abs(place - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size;
    return max(beside.x, beside.y) < 0.0;
}

float left_at(vec2 place) {
    return can_be_mown(place) ? textureLod(mown, (place - terrain_origin) / terrain_size, 0.0).r : tallest_grass;
}

// The mean over squares of `side` [m].
float left_about(vec2 place, float side) {
    float cell = terrain_size.x / float(textureSize(mown, 0).x), level = log2(max(side / cell, 1.0));
    return can_be_mown(place) ? textureLod(mown, (place - terrain_origin) / terrain_size, level).r : tallest_grass;
}

// Whether that is lower than the canopy of the tallest kind.
bool is_mown(float left) {
    float tallest = 0.0;
    for (int group = 0; group < GROUPS; group++)
        tallest = max(tallest, max(max(crown[group].x, crown[group].y), max(crown[group].z, crown[group].w)));
    return left < tallest;
}

// How much of each kind's leaf area is left below a height [m].
ByKind leaves_left(float top) {
    ByKind left;
    for (int group = 0; group < GROUPS; group++) {
        vec4 gone = max(1.0 - top / max(crown[group], LOWEST_CROWN), 0.0);
        left[group] = 1.0 - gone * gone;
    }
    return left;
}
