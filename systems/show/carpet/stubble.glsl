// What is seen of ground and grass where it has been cut: the mesh is too coarse for the edges of what is mown.
#include "systems/show/carpet/floor.glsl"
#include "systems/show/carpet/footprint.glsl"

// Up to which height grass is left to stand, in the mean over the pixel [m].
float left_seen(vec2 at) {
    if (!anything_is_cut())
        return tallest_grass;
    vec2 dx = dFdx(at) / terrain_size, dy = dFdy(at) / terrain_size;
    float fine = narrowed(dx * terrain_size, dy * terrain_size);
    float here = textureGrad(mown, (at - terrain_origin) / terrain_size, dx * fine, dy * fine).r;
    return can_be_mown(at) ? here : tallest_grass;
}

// The radiance of the soil where grass is left to stand so high [m].
vec3 soil_between(Soil soil, vec2 at, float left) {
    if (!anything_is_cut())
        return soil.seen;
    vec2 through = through_leaves(vec2(soil.way, OPEN_SKY) * weighed(areas(grows_at(at)), leaves_left(left)));
    return soil.sunlit * through.x + soil.skylit * through.y;
}
