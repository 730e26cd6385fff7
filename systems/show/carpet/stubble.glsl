// What is seen of ground and grass where it has been cut: the mesh is too coarse for the edges of what is mown.
#include "systems/show/carpet/floor.glsl"
#include "systems/show/carpet/footprint.glsl"

// Up to which height grass is left to stand, in the mean over the pixel [m].
float left_seen(vec2 at) {
    if (!anything_is_cut())
        return tallest_grass;
    vec2 dx = dFdx(at), dy = dFdy(at);
    return cut_height_about(at, narrowed(dx, dy) * sqrt(max(dot(dx, dx), dot(dy, dy))));
}

// The radiance of the soil where grass is left to stand so high [m].
vec3 soil_between(Soil soil, vec3 at, float left) {
#ifdef TREES
    if (!anything_is_cut())
        return soil.seen - soil.sunlit * (soil.through * (1.0 - casters_visibility(at)));
#endif
    if (!anything_is_cut() && !has_casters())
        return soil.seen;
    float seen = has_casters() ? casters_visibility(at) : 1.0;
    vec2 through = transmittance(vec2(soil.extinction, OPEN_SKY) * weighted_sum(leaf_areas(density_at(at.xz)), leaf_area_left(left)));
    return soil.sunlit * (through.x * seen) + soil.skylit * through.y;
}
