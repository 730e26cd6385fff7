// Ground and grass where it has been cut, by pixel, as the mesh is too coarse for the edges of what is mown.
#include "systems/show/carpet/floor.glsl"
#include "systems/show/carpet/footprint.glsl"

// Height to which grass is cut, averaged over the pixel [m].
float cut_height_seen(vec2 at) {
    if (!anything_is_cut())
        return tallest_grass;
    vec2 dx = dFdx(at), dy = dFdy(at);
    return cut_height_about(at, narrowed(dx, dy) * sqrt(max(dot(dx, dx), dot(dy, dy))));
}

// Visibility of the sun behind trees, shades and shadow maps at a place near that of the pixel, `place`.
float casters_visibility_near(vec3 at) {
#if defined(TREES) && defined(SUNWARD_BY_VERTEX)
    return games_visibility(at) * trees_visibility_off(at - place);
#else
    return casters_visibility(at);
#endif
}

// Radiance of the soil where grass is cut to `cut_height` [m].
vec3 soil_radiance(Soil soil, vec3 at, float cut_height) {
#ifdef TREES
    if (!anything_is_cut())
        return soil.seen - soil.sunlit * (soil.through * (1.0 - casters_visibility_near(at)));
#endif
    if (!anything_is_cut() && !has_casters())
        return soil.seen;
    float seen = has_casters() ? casters_visibility_near(at) : 1.0;
    vec2 through = transmittance(vec2(soil.extinction, OPEN_SKY) * weighted_sum(leaf_areas(density_at(at.xz)), leaf_area_left(cut_height)));
    return soil.sunlit * (through.x * seen) + soil.skylit * through.y;
}
