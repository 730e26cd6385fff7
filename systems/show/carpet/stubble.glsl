// What is seen of ground and grass where it has been cut: the mesh is too coarse for the edges of what is mown.
#include "systems/show/carpet/floor.glsl"
#include "systems/show/carpet/footprint.glsl"

// Up to which height grass is left to stand, in the mean over the pixel [m].
float left_seen(vec2 at) {
    if (!anything_is_cut())
        return tallest_grass;
    vec2 dx = dFdx(at), dy = dFdy(at);
    return left_about(at, narrowed(dx, dy) * sqrt(max(dot(dx, dx), dot(dy, dy))));
}

// The radiance of the soil where grass is left to stand so high [m].
vec3 soil_between(Soil soil, vec3 at, float left) {
#ifdef TREES
    if (!anything_is_cut())
        return soil.seen - soil.sunlit * (soil.through * (1.0 - past_casters(at)));
#endif
    if (!anything_is_cut() && !any_casters())
        return soil.seen;
    float seen = any_casters() ? past_casters(at) : 1.0;
    vec2 through = comes_through(vec2(soil.way, OPEN_SKY) * weighed(areas(grows_at(at.xz)), leaves_left(left)));
    return soil.sunlit * (through.x * seen) + soil.skylit * through.y;
}
