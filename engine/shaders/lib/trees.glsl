// What trees leave of the light: of the sun's along its rays, and of the sky's from above. Programs of scenes without trees know
// nothing of them: those of others are told TREES.
#ifdef TREES
#include "lib/frame.glsl"

// Side by side, near by, far off and seen from above: how many leaves a ray meets, and that times how far on it is towards the sun [m].
uniform sampler2D tree_shade;

const float STANDS_BEFORE = 2.0;  // over which way towards the sun a crown begins to shade what stands before it [m]
const float MAP_RIM = 0.46;  // how far from the middle a map counts, of its side
const float RIM_FADES = 0.06;  // and over which part of it the farther one is faded out
const float SKY_LEVEL = 3.0;  // of the map seen from above, whose texels are 2 m: so broad is the sky that a place sees
const float SKY_MEETS = 0.75;  // how many leaves the sky's light meets, which comes from all sides, of those straight above

vec2 shade_in(vec2 at, float tile, float level) {
    return textureLod(tree_shade, vec2((clamp(at.x, 0.001, 0.999) + tile) / 3.0, at.y), level).rg;
}

// Of the leaves on the sun's ray past a place, those that stand before it, farther on than `beyond` [m].
float leaves_before(vec3 place, float beyond) {
    vec2 at = vec2(dot(place, trees_across), dot(place, trees_up));
    vec2 near_at = (at - trees_middle.xy) / trees_sides.x, far_at = (at - trees_middle.zw) / trees_sides.y;
    float near_out = max(abs(near_at.x), abs(near_at.y)), far_out = max(abs(far_at.x), abs(far_at.y));
    vec2 met = near_out < MAP_RIM ? shade_in(0.5 + near_at, 0.0, 0.0) : far_out < MAP_RIM ? shade_in(0.5 + far_at, 1.0, 0.0) : vec2(0.0);
    float mean = met.y / max(met.x, 1e-3), own = dot(place, sun) + beyond;
    float fades = near_out < MAP_RIM ? 1.0 : 1.0 - smoothstep(MAP_RIM - RIM_FADES, MAP_RIM, far_out);
    return met.x * fades * smoothstep(-0.25 * STANDS_BEFORE, STANDS_BEFORE, mean - own);
}

// How much of the sun is seen past trees from what stands among them, and from a tree whose crown goes on so far towards it [m].
float past_trees(vec3 place) {
    return exp(-leaves_before(place, 0.0));
}

float past_others(vec3 place, float beyond) {
    return exp(-leaves_before(place, beyond));
}

// How much of the sky is left above a place.
float sky_past_trees(vec3 place) {
    vec2 at = (place.xz - trees_sky.xy) / trees_sky.z;
    if (max(abs(at.x), abs(at.y)) > MAP_RIM)
        return 1.0;
    return exp(-SKY_MEETS * shade_in(0.5 + at, 2.0, SKY_LEVEL).x);
}
#endif
