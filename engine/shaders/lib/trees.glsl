// What trees leave of the light: of the sun's along its rays, and of the sky's from above. Programs of scenes without trees know
// nothing of them: those of others are told TREES.
#include "lib/through.glsl"
#ifdef TREES
#include "lib/frame.glsl"
#include "engine/terrain/crowns.py"
#include "systems/trees/crown.py"
#include "systems/trees/shade.py"

// Side by side, near by and far off: how many leaves a ray meets, and that times how far on it is towards the sun [m]. Seen from
// above: how many leaves the sky's light meets, in the mean over all the sky that grass sees.
uniform sampler2D tree_shade;

const vec2 TILE_SPAN = vec2(0.001, 0.999);  // part of a map that is read, across: beside it, taps would reach another map
const vec2 STANDS_BEFORE = vec2(-0.5, 2.0);  // how much farther towards the sun leaves begin to shade a place, and all do [m]
const float MAP_RIM = 0.46;  // how far from the middle a map counts, of its side
const float RIM_FADES = 0.06;  // and over which part of it the farther one is faded out

const vec2 SWINGS_APART = vec2(0.11, 0.07);  // how many turns trees are apart in their swing on a metre of ground

// How far the wind has blown the leaves aside that shade a place (x, z) [m]: the map has them as they are in calm air.
vec2 shade_sways(vec3 place) {
    vec2 waves = sin(A_TURN * (trees_tones + dot(place.xz, SWINGS_APART) * SHADE_TONES_APART));
    return trees_aside * (SHADE_LEANS + 0.5 * SHADE_SWINGS * (waves.x + waves.y));
}

vec2 on_maps(vec2 at, float map) {
    return vec2((clamp(at.x, TILE_SPAN.x, TILE_SPAN.y) + map) * (1.0 / SHADE_MAPS), at.y);
}

vec2 shade_in(vec2 at, float map) {
    return textureLod(tree_shade, on_maps(at, map), 0.0).rg;
}

// Where a place lies on the plane of the maps of the sun [m]; they go across level.
vec2 across_sun(vec3 place) {
    return vec2(dot(place.xz, trees_across.xz), dot(place, trees_up));
}

// Where the maps tell of the sun's ray past a place (x, y), and how far along it the place is [m]. In `counts` is how much that does;
// it is told of a place, for it and all near by, and so is which of the maps tells of them. Beyond both, nothing counts.
vec3 on_ray(vec3 place, vec3 about, out float counts) {
    vec2 sways = across_sun(vec3(shade_sways(about), 0.0).xzy), calm = across_sun(place) - sways, middle = across_sun(about) - sways;
    vec2 near_out = abs(middle - trees_middle.xy), far_out = abs(middle - trees_middle.zw);
    counts = 1.0 - smoothstep(MAP_RIM - RIM_FADES, MAP_RIM, max(far_out.x, far_out.y) * trees_spans.y);
    bool near = max(near_out.x, near_out.y) * trees_spans.x < MAP_RIM;
    vec2 at = near ? (calm - trees_middle.xy) * trees_spans.x : (calm - trees_middle.zw) * trees_spans.y;
    return vec3((at.x + 0.5 + (near ? 0.0 : 1.0)) * (1.0 / SHADE_MAPS), at.y + 0.5, dot(place, sun));
}

// How much of the sun is seen past trees that stand before a place that `on_ray` gave.
float past_trees(vec3 ray, float counts) {
    vec2 met = textureLod(tree_shade, ray.xy, 0.0).rg;
    float mean = met.y / max(met.x, LEAST_PART);
    return comes_through(met.x * counts * smoothstep(STANDS_BEFORE.x, STANDS_BEFORE.y, mean - ray.z));
}

// How much of what is met past such a place stands before it. Where nothing is, all that is met near by is taken to.
float stands_before(vec3 ray) {
    vec2 met = textureLod(tree_shade, ray.xy, 0.0).rg;
    return met.x > LEAST_PART ? smoothstep(STANDS_BEFORE.x, STANDS_BEFORE.y, met.y / met.x - ray.z) : 1.0;
}

// How much of the sun is seen past trees from there, if so much of what they tell counts and stands before it.
float past_trees_before(vec2 at, float counts) {
    return comes_through(textureLod(tree_shade, at, 0.0).r * counts);
}

// How much of the sun is seen past trees, but for a crown that the place is in and that goes on so far towards it [m].
float past_trees_beyond(vec3 place, float beyond) {
    float counts;
    vec3 ray = on_ray(place, place, counts);
    return past_trees(vec3(ray.xy, ray.z + beyond), counts);
}

// How many leaves are met above a place of the ground, over all the sky that is seen from it.
float trees_above(vec2 place) {
    vec2 at = (place - trees_sky.xy) * trees_sky.z;
    float out_by = max(abs(at.x), abs(at.y));
    return out_by < MAP_RIM ? shade_in(0.5 + at, 2.0).y * (1.0 - smoothstep(MAP_RIM - RIM_FADES, MAP_RIM, out_by)) : 0.0;
}

// How much of the sky is left above a place.
float sky_past_trees(vec3 place) {
    return comes_through(trees_above(place.xz));
}

// How much grass grows there, of that in the open.
float grass_below_trees(vec2 place) {
    return mix(1.0, comes_through(trees_above(place)), 1.0 - SHADE_KEEPS);
}
#endif
