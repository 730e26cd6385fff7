// Density and leaf area of each kind of grass.
#include "lib/lie.glsl"
#include "lib/plots.glsl"
#include "lib/terrain.glsl"
#include "lib/trees.glsl"

uniform sampler2DArray density;  // over the terrain, four kinds in each layer: painted density

const float LOWEST_CROWN = 0.01;  // least height of a canopy [m]

// Whether a game has sown or cleared anything, anywhere.
bool anything_is_sown() {
    return anything_sown > 0.5;
}

// The plot at a place, clamped to the terrain's outermost cells; none beyond, where the scene's own density holds.
Plot sown_plot(vec2 place) {
    const float HALF_CELL = 0.5 * PLOT_SIDE / float(PLOT_CELLS);
    vec2 inside = place - terrain_origin;
    if (any(lessThan(inside, vec2(0.0))) || any(greaterThan(inside, terrain_size)))
        return Plot(vec2(0.0), 0, 0);
    return plot_at(terrain_origin + clamp(inside, vec2(HALF_CELL), terrain_size - HALF_CELL));
}

// Part of the density of four kinds that slope, holes and trees leave.
vec4 density_left(vec2 place, int group) {
    vec4 left = anything_open > 0.5 && is_hole(place) ? vec4(0.0) : vec4(1.0);
#ifdef SLOPED
    left *= clamp((steepest[group] - length(gradient_at(place))) * thins[group], 0.0, 1.0);
#endif
#ifdef TREES
    left *= grass_below_trees(place);
#endif
    return left;
}

// Density of each kind at a place; where a game has sown or cleared, the mean over squares of `side` [m].
ByKind density_about(vec2 place, float side) {
    vec2 at = on_terrain_map(place);
    ByKind densities;
    for (int group = 0; group < GROUPS; group++)
        densities[group] = textureLod(density, vec3(at, float(group)), 0.0);
    if (anything_is_sown()) {
        Plot plot = sown_plot(place);
        if (plot.sown > 0) for (int group = 0; group < GROUPS; group++)
            densities[group] = page_texel(plot.sown + group, plot.cell, page_mip(side));
    }
    for (int group = 0; group < GROUPS; group++)
        densities[group] *= density_left(place, group);
    return densities;
}

ByKind density_at(vec2 place) {
    return density_about(place, 0.0);
}

// Density of one kind.
float density_at(vec2 place, int kind) {
    vec2 at = on_terrain_map(place);
    float dense = textureLod(density, vec3(at, float(GROUP(kind))), 0.0)[IN_GROUP(kind)];
    if (anything_is_sown()) {
        Plot plot = sown_plot(place);
        if (plot.sown > 0)
            dense = page_texel(plot.sown + GROUP(kind), plot.cell, 0.0)[IN_GROUP(kind)];
    }
    return dense * density_left(place, GROUP(kind))[IN_GROUP(kind)];
}

// Leaf area index of each kind.
ByKind leaf_areas(ByKind densities) {
    for (int group = 0; group < GROUPS; group++)
        densities[group] *= leaf[group];
    return densities;
}
