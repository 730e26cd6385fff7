// Up to which height grass is left to stand where it has been cut.
#include "lib/sown.glsl"

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

// The mean over squares of `side` [m].
float left_about(vec2 place, float side) {
    Plot plot = plot_at(place);
    if (plot.mown == 0 || !can_be_mown(place))
        return tallest_grass;
    return tallest_grass * number_in(on_page(plot.mown, plot.cell, page_level(side)).rg) / TWO_BYTES;
}

float left_at(vec2 place) {
    return left_about(place, 0.0);
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
