// How densely each kind grows, and what leaf area that is.
#include "lib/lie.glsl"
#include "lib/plots.glsl"
#include "lib/terrain.glsl"
#include "lib/trees.glsl"

uniform sampler2DArray density;  // over the terrain, four kinds in each layer: how densely each is painted to grow

const float LOWEST_CROWN = 0.01;  // height of a canopy that counts at least [m]

// Whether a game has sown or cleared anything, anywhere.
bool anything_is_sown() {
    return anything_sown > 0.5;
}

// The plot that counts at a place, at the terrain's edge that of the last cell: beyond it is what the scene declares.
Plot plot_on(vec2 place) {
    const float HALF_CELL = 0.5 * PLOT_SIDE / float(PLOT_CELLS);
    vec2 inside = place - terrain_origin;
    if (any(lessThan(inside, vec2(0.0))) || any(greaterThan(inside, terrain_size)))
        return Plot(vec2(0.0), 0, 0);
    return plot_at(terrain_origin + clamp(inside, vec2(HALF_CELL), terrain_size - HALF_CELL));
}

// How much of what would grow there the ground leaves to four kinds, which may be too steep, or a hole, or below trees.
vec4 left_by_ground(vec2 place, int group) {
    vec4 left = anything_open > 0.5 && is_hole(place) ? vec4(0.0) : vec4(1.0);
#ifdef SLOPED
    left *= clamp((steepest[group] - length(rise_at(place))) * thins[group], 0.0, 1.0);
#endif
#ifdef TREES
    left *= grass_below_trees(place);
#endif
    return left;
}

// How densely each kind grows at a place, in the mean over squares of `side` [m] where a game has sown or cleared.
ByKind grows_about(vec2 place, float side) {
    vec2 at = on_map(place);
    ByKind grows;
    for (int group = 0; group < GROUPS; group++)
        grows[group] = textureLod(density, vec3(at, float(group)), 0.0);
    if (anything_is_sown()) {
        Plot plot = plot_on(place);
        if (plot.sown > 0) for (int group = 0; group < GROUPS; group++)
            grows[group] = on_page(plot.sown + group, plot.cell, page_level(side));
    }
    for (int group = 0; group < GROUPS; group++)
        grows[group] *= left_by_ground(place, group);
    return grows;
}

ByKind grows_at(vec2 place) {
    return grows_about(place, 0.0);
}

// How densely one does.
float grows_at(vec2 place, int kind) {
    vec2 at = on_map(place);
    float grows = textureLod(density, vec3(at, float(GROUP(kind))), 0.0)[IN_GROUP(kind)];
    if (anything_is_sown()) {
        Plot plot = plot_on(place);
        if (plot.sown > 0)
            grows = on_page(plot.sown + GROUP(kind), plot.cell, 0.0)[IN_GROUP(kind)];
    }
    return grows * left_by_ground(place, GROUP(kind))[IN_GROUP(kind)];
}

// The leaf area of each kind, of the ground's.
ByKind areas(ByKind grows) {
    for (int group = 0; group < GROUPS; group++)
        grows[group] *= leaf[group];
    return grows;
}
