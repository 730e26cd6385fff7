// Cut grass: the height that it is left at.
#include "lib/sown.glsl"

// Whether any grass has been cut. Programs compiled for one case have CUT as 0 or 1.
bool anything_is_cut() {
#ifdef CUT
    return CUT > 0;
#else
    return anything_cut > 0.5;
#endif
}

// Whether a place is on the terrain: grass beyond is never cut.
bool can_be_mown(vec2 place) {
    vec2 beside = abs(place - terrain_origin - 0.5 * terrain_size) - 0.5 * terrain_size;
    return max(beside.x, beside.y) < 0.0;
}

// Mean height that grass is left at over squares of `side` [m].
float cut_height_about(vec2 place, float side) {
    Plot plot = plot_at(place);
    if (plot.mown == 0 || !can_be_mown(place))
        return tallest_grass;
    return tallest_grass * packed_number(page_texel(plot.mown, plot.cell, page_mip(side)).rg) / TWO_BYTES;
}

float cut_height_at(vec2 place) {
    return cut_height_about(place, 0.0);
}

// Whether a height is below the canopy of the tallest kind.
bool is_mown(float left) {
    float tallest = 0.0;
    for (int group = 0; group < GROUPS; group++)
        tallest = max(tallest, max(max(crown[group].x, crown[group].y), max(crown[group].z, crown[group].w)));
    return left < tallest;
}

// Part of each kind's leaf area below a height [m].
ByKind leaf_area_left(float top) {
    ByKind left;
    for (int group = 0; group < GROUPS; group++) {
        vec4 gone = max(1.0 - top / max(crown[group], LOWEST_CROWN), 0.0);
        left[group] = 1.0 - gone * gone;
    }
    return left;
}
