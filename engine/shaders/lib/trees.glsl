// Shadows of trees: transmittance of their crowns for sunlight and for the sky's light. Programs for scenes with trees are compiled
// with TREES.
#include "lib/through.glsl"
#ifdef TREES
#include "lib/frame.glsl"
#include "engine/terrain/crowns.py"
#include "systems/trees/crown.py"
#include "systems/trees/shade.py"

// Three maps side by side. Two look along the sun's rays, for trees near by and far off: the optical depth, and that times its mean
// distance towards the sun [m]. One looks down: the optical depth of crowns, averaged over the sky that grass sees.
uniform sampler2D tree_shade;

const vec2 TILE_SPAN = vec2(0.001, 0.999);  // part of a map that is read, across: taps outside would reach the next map
const vec2 STANDS_BEFORE = vec2(-0.5, 2.0);  // mean distance of leaves towards the sun from which on they begin to shade, and fully do [m]
const float MAP_RIM = 0.46;  // distance from the middle up to which a map is used, as a part of its side
const float RIM_FADES = 0.06;  // part of its side over which the far map fades out

const vec2 SWINGS_APART = vec2(0.11, 0.07);  // change of the phase of trees' swing along x and z [turns/m]

// Offset by the wind of the leaves that shade a place (x, z) [m]; the maps are drawn for calm air.
vec2 shade_sway(vec3 place) {
    vec2 waves = sin(A_TURN * (trees_tones + dot(place.xz, SWINGS_APART) * SHADE_TONES_APART));
    return trees_aside * (SHADE_LEANS + 0.5 * SHADE_SWINGS * (waves.x + waves.y));
}

vec2 on_tile(vec2 at, float map) {
    return vec2((clamp(at.x, TILE_SPAN.x, TILE_SPAN.y) + map) * (1.0 / SHADE_MAPS), at.y);
}

vec2 shade_in(vec2 at, float map) {
    return textureLod(tree_shade, on_tile(at, map), 0.0).rg;
}

// A place projected along the sun's rays onto the plane of its maps [m]; their x axis is level.
vec2 on_sun_plane(vec3 place) {
    return vec2(dot(place.xz, trees_across.xz), dot(place, trees_up));
}

// A place on that plane, moved against the sway of the leaves that shade its neighbourhood `about`, and its distance towards the sun [m].
vec3 sunward_of(vec3 place, vec3 about) {
    return vec3(on_sun_plane(place) - on_sun_plane(vec3(shade_sway(about), 0.0).xzy), dot(place, sun));
}

// Texture coordinates of a place on that plane, on the near and on the far map.
vec2 on_near_map(vec2 at) {
    return at * trees_near.xy + trees_near.zw;
}

vec2 on_far_map(vec2 at) {
    return at * trees_far.xy + trees_far.zw;
}

// Distance of texture coordinates from the middle of a map, as a part of its side.
float off_middle(vec2 on_map, float map) {
    vec2 off = abs(on_map * vec2(SHADE_MAPS, 1.0) - vec2(map + 0.5, 0.5));
    return max(off.x, off.y);
}

// Texture coordinates of a place on that plane, on the sun's map that a whole neighbourhood `about` reads.
vec2 on_sun_map(vec2 at, vec2 about) {
    return off_middle(on_near_map(about), 0.0) < MAP_RIM ? on_near_map(at) : on_far_map(at);
}

// The same for a place in space, and its distance towards the sun as z [m]. `counts` is the weight of what is read there, 0 beyond both
// maps.
vec3 on_sun_map(vec3 place, vec3 about, out float counts) {
    vec3 calm = sunward_of(place, about);
    vec2 middle = sunward_of(about, about).xy;
    counts = 1.0 - smoothstep(MAP_RIM - RIM_FADES, MAP_RIM, off_middle(on_far_map(middle), 1.0));
    return vec3(on_sun_map(calm.xy, middle), calm.z);
}

// Visibility of the sun behind the trees in front of a place of `on_sun_map`.
float trees_visibility(vec3 ray, float counts) {
    vec2 met = textureLod(tree_shade, ray.xy, 0.0).rg;
    float mean = met.y / max(met.x, LEAST_PART);
    return transmittance(met.x * counts * smoothstep(STANDS_BEFORE.x, STANDS_BEFORE.y, mean - ray.z));
}

const float DEPTH_HALVES = log2(exp(1.0));  // of light by an optical depth of 1

// Halvings of the sun's light on such a ray by the trees in front of the place, for each 1 of the optical depth there; where the map
// shows none, they count as all in front.
float halvings_before(vec3 ray, float counts) {
    vec2 met = textureLod(tree_shade, ray.xy, 0.0).rg;
    float before = met.x > LEAST_PART ? smoothstep(STANDS_BEFORE.x, STANDS_BEFORE.y, met.y / met.x - ray.z) : 1.0;
    return DEPTH_HALVES * counts * before;
}

// Visibility of the sun behind trees, by these halvings.
float trees_visibility_before(vec2 at, float halvings) {
    return exp2(-halvings * textureLod(tree_shade, at, 0.0).r);
}

#ifdef SUNWARD_BY_VERTEX
in vec3 sunward;  // from trees_sunward

// Visibility of the sun behind trees, `off` the place of the pixel [m]. Vertices have computed most of it: it is linear but for the sway,
// which changes by centimetres from one to the next.
float trees_visibility_off(vec3 off) {
    return trees_visibility_before(on_sun_map(sunward.xy + on_sun_plane(off), sunward.xy), sunward.z);
}
#endif

// Visibility of the sun behind trees other than the one the place is in, whose crown goes on for `beyond` towards the sun [m].
float trees_visibility_beyond(vec3 place, float beyond) {
    float counts;
    vec3 ray = on_sun_map(place, place, counts);
    return trees_visibility(vec3(ray.xy, ray.z + beyond), counts);
}

// What vertices compute for trees_visibility_off: the place on the sun's plane, and halvings of its light by the trees in front.
vec3 trees_sunward(vec3 place) {
    float counts;
    vec3 ray = on_sun_map(place, place, counts);
    return vec3(sunward_of(place, place).xy, halvings_before(ray, counts));
}

// Optical depth of crowns above a place of the ground, averaged over the sky.
float tree_depth_above(vec2 place) {
    vec2 at = (place - trees_sky.xy) * trees_sky.z;
    float out_by = max(abs(at.x), abs(at.y));
    return out_by < MAP_RIM ? shade_in(0.5 + at, 2.0).y * (1.0 - smoothstep(MAP_RIM - RIM_FADES, MAP_RIM, out_by)) : 0.0;
}

// Transmittance of crowns above a place for the sky's light.
float sky_visibility(vec3 place) {
    return transmittance(tree_depth_above(place.xz));
}

// Density of grass under trees, as a part of that in the open.
float grass_below_trees(vec2 place) {
    return mix(1.0, transmittance(tree_depth_above(place)), 1.0 - SHADE_KEEPS);
}
#endif
