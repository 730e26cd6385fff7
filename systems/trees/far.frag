#define OF_TREES
#include "lib/light.glsl"
#include "systems/trees/crown.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf.glsl"
#include "systems/trees/motion.py"
#include "systems/trees/noise.py"
#include "systems/trees/coverage.glsl"

uniform sampler2DArray tree_far;    // tone, wood, its radius, coverage
uniform sampler2DArray tree_depths; // optical depths, by direction and in the mean, with larger texels
#ifndef CAST
uniform sampler2DArray tree_cards;  // in place of twigs' cards: tileable noise
#endif

#define PASSED in
#include "systems/trees/far.glsl"

out vec4 pixel;

const float SHIMMER_TURNS = 15.0;  // change of the swing's phase over a crown [rad]
const float HIDES_MOST = 0.96;  // greatest opacity of a texel of leaves to the sun

const float COARSER_BY = log2(float(COARSER));

// Mix the pictures by these shares, two in a row: in most places, one of them alone.
void mix_pictures(vec2 at, vec2 parts, out vec4 texel, out vec4 shading) {
    ivec2 first = ivec2(greaterThanEqual(parts, vec2(1.0))), last = ivec2(greaterThan(parts, vec2(0.0)));
    texel = shading = vec4(0.0);
    for (int number = first.x + 2 * first.y; number <= last.x + 2 * last.y; number += first.x < last.x ? 1 : 2) {
        bvec2 second = bvec2(number & 1, number & 2);
        vec2 place = mix(tile_corners.xy, tile_corners.zw, second) + at / vec2(COLUMNS, ROWS), own = mix(1.0 - parts, parts, second);
        float part = own.x * own.y;
        vec4 shows = part * textureLod(tree_far, vec3(place, 0.0), motion.w);
        texel += shows;
        shading += shows.a * textureLod(tree_depths, vec3(place, 0.0), max(motion.w - COARSER_BY, 0.0));
    }
}

// Position within a picture that reads nothing of its neighbours.
vec2 inside_tile(vec2 at) {
    vec2 edge = TILE_EDGE * texel_side * vec2(aspect, 1.0);
    return clamp(at, edge, 1.0 - edge);
}

#ifdef IN_ROWS
const vec3 APART = vec3(0.618, 0.755, 0.57);  // steps of the random height, place and side from tree to tree in a row
const vec3 ROWS_APART = vec3(7.0, 11.0, 13.0);  // and from row to row
const vec2 LOWER = vec2(1.0, 0.35);  // height of a row's picture, relative to its trees': least, and range

// Position of a pixel on the picture of its tree in the row.
vec2 own_picture() {
    if (row_of_trees.x <= 1.0)
        return on.xy;
    float along = on.x * row_of_trees.x, number = floor(along);
    vec3 own = fract(number * APART + motion.x * ROWS_APART);
    float aside = (fract(along) - 0.5) * row_of_trees.y * (own.z > 0.5 ? 1.0 : -1.0);
    return vec2(0.5 + aside, on.y * (LOWER.x + LOWER.y * own.x));
}
#else
vec2 own_picture() {
    return on.xy;
}
#endif

#ifdef CAST
void main() {
    vec4 texel, shading;
    mix_pictures(inside_tile(0.5 + 0.5 * vec2(aspect, 1.0) * on.xy), mix_shares, texel, shading);
    texel *= float(max(aspect * abs(on.x), abs(on.y)) < 1.0);
    float leaves = -log(1.0 - HIDES_MOST * texel.a) * mix(1.0, foot_shade.z, 1.0 - texel.g);
    vec2 inner = max(1.0 - dot(on.xy, on.xy) / vec2(cast_shade.x * cast_shade.x, foot_shade.x * foot_shade.x), 0.0);
    float above = dot(vec2(cast_shade.y, foot_shade.y), inner * inner);
    pixel = vec4(leaves, mix(leaves * cast_shade.w, above, cast_shade.z), 0.0, 0.0);
}
#else
// Coverage by the picture itself: beyond its edge texels are empty.
float tile_cover(vec2 at) {
    vec2 inside = clamp((0.5 - abs(at - 0.5)) * picture_texels * finer_texel + TILE_EDGE, 0.0, 1.0);
    return inside.x * inside.y;
}

// Position on the picture before the wind displaced it.
vec2 undisplaced(vec2 at) {
    vec2 aside = motion.y * at.y * sin(limb_phases + SHIMMER_TURNS * at.yx);
    float high = clamp(on.z, 0.0, 1.0);
    aside.x += motion.z * (high - cantilever(high));
    return at + vec2(aspect, 1.0) * aside;
}

const float CLUMP = 7.0;       // width of a clump of leaves [texels]
const mat2 CLUMPS = mat2(0.857, 0.515, -0.515, 0.857) / CLUMP;  // matrix from texels to noise: it lies askew, so that cells are cut both ways
const float CLUMPS_FINER = log2(CLUMP / NOISE_FINER);  // levels by which texels of noise are larger than a picture's
const float EVENLY = 1.6;      // contrast of noise, whose values lie about the middle: equally many clumps give way at each step

// Random number from 0 to 1 of a clump of leaves.
float clump_random(vec2 at) {
    vec2 cell = CLUMPS / NOISE_CELLS * (at * picture_texels) + motion.x;
    float noise = textureLod(tree_cards, vec3(cell, 0.0), max(motion.w - CLUMPS_FINER, 0.0)).r;
    return clamp(0.5 - 0.5 * EVENLY + EVENLY * noise, 0.0, 1.0);
}

// Share of the second picture in a clump: they give way one after another, as two views blended are a blur.
vec2 clump_shares(float clump) {
    return clamp(clump_progress.xy - clump_progress.z * clump, 0.0, 1.0);
}

const float BARE = 0.15;  // coverage by the stems that missing clumps hid, relative to the clumps'

const float UNCLUMPED = 2.5;  // leaves behind the first of a clump that is seen, relative to the optical depth: 1 / CLUMPING

// Share of a clump that is left where a tree has few leaves: of many behind one another, one is seen.
float clump_left(float clump, vec4 shading) {
    float depth = max(UNCLUMPED * sun_depth(shading, ray_weights), LEAST_PART);
    float left = (1.0 - transmittance(foliage_of(sun_weights) * depth)) / (1.0 - transmittance(depth));
    return clamp((1.0 + clump_progress.z) * left - clump_progress.z * clump, 0.0, 1.0);
}

void main() {
    vec4 texel, shading;
    vec2 at = undisplaced(own_picture());
    float clump = clump_random(at);
    mix_pictures(inside_tile(at), clump_shares(clump), texel, shading);
    float whole = 1.0 / max(texel.a, LEAST_COVER), own = tile_cover(at);
    shading *= whole;
    float missing = 1.0 - clump_left(clump, shading), leaves = own * (texel.a - texel.g);
    float stems = own * texel.g + BARE * missing * leaves, all = leaves * (1.0 - missing) + stems;
    float cover = 1.0 - pow(max(1.0 - all, 0.0), sun_radiance.a);  // twigs that are still drawn cover the rest
    float wood = stems / max(all, LEAST_COVER);
    discard_uncovered(cover);
    float seen = transmittance(sun_depth(shading, sun_weights)), open = transmittance(sky_depth(shading, sun_weights));
    vec3 sky = hemisphere_light(sky_radiance.rgb, below, open, sky_radiance.a * (1.0 - wood));
    Light light = Light((sun_radiance.rgb + wood_gain.rgb * wood) * seen, sky, haze_colour, 0.0, 0.0, vec2(0.0));
    float aged = bark_age(wood_gain.a * texel.b / max(texel.g, LEAST_COVER));
    float tone = texel.r * whole, worn = mix(1.0, 2.0 * tone, wood * rugged);  // of bark too: 0.5 is the mean
    vec3 pigment = pigment_of(tone, wood, soil_tone(on.z * grass_scale) * worn * mix(young_bark, old_pigment, aged));
    pixel = output_colour(shade(Surface(pigment, 1.0, LEAF_SCATTERING), light), cover);
}
#endif
