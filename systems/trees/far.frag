#define OF_TREES
#include "lib/light.glsl"
#include "systems/trees/crown.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf.glsl"
#include "systems/trees/motion.py"
#include "systems/trees/noise.py"
#include "systems/trees/shown.glsl"

uniform sampler2DArray tree_far;  // tone, wood, its radius, coverage
uniform sampler2DArray tree_met;  // optical depths, by direction and in the mean, with larger texels
#ifndef CAST
uniform sampler2DArray tree_cards;  // in place of twigs' cards: tileable noise
#endif

in vec3 on;            // outputs of far.vert
flat in vec4 tiles;
flat in vec2 mixed;
flat in vec2 row_told;
flat in float texel_side;
#ifdef CAST
flat in vec4 shades;   // outputs of far.vert
flat in vec3 foot;
#else
flat in vec4 meets;
flat in vec4 behind_meets;
in vec4 sunlit;
in vec4 wooden;
flat in vec4 skylit;
flat in vec3 below;
flat in vec3 hazy;
flat in vec3 old_bark;
flat in vec2 sides;
flat in vec2 waves;
flat in vec3 gives;
flat in float grasses;
#endif
flat in vec4 told;

out vec4 pixel;

const float SHIMMER_TURNS = 15.0;  // change of the swing's phase over a crown [rad]
const float HIDES_MOST = 0.96;  // greatest opacity of a texel of leaves to the sun

const float COARSER_BY = log2(float(COARSER));

// Mix the pictures by these shares, two in a row: in most places, one of them alone.
void mix_pictures(vec2 at, vec2 parts, out vec4 texel, out vec4 shading) {
    ivec2 first = ivec2(greaterThanEqual(parts, vec2(1.0))), last = ivec2(greaterThan(parts, vec2(0.0)));
    texel = shading = vec4(0.0);
    for (int row = first.y; row <= last.y; row++)
        for (int column = first.x; column <= last.x; column++) {
            vec2 place = vec2(column == 0 ? tiles.x : tiles.z, row == 0 ? tiles.y : tiles.w) + at / vec2(COLUMNS, ROWS);
            float part = (column == 0 ? 1.0 - parts.x : parts.x) * (row == 0 ? 1.0 - parts.y : parts.y);
            vec4 shows = part * textureLod(tree_far, vec3(place, 0.0), told.w);
            texel += shows;
            shading += shows.a * textureLod(tree_met, vec3(place, 0.0), max(told.w - COARSER_BY, 0.0));
        }
}

// Position within a picture that reads nothing of its neighbours.
vec2 within(vec2 at) {
    vec2 edge = TILE_EDGE * texel_side * vec2(slim, 1.0);
    return clamp(at, edge, 1.0 - edge);
}

// Coverage by the picture itself: beyond its edge texels are empty.
float own_of(vec2 at) {
    vec2 inside = clamp((0.5 - abs(at - 0.5)) / (texel_side * vec2(slim, 1.0)) + TILE_EDGE, 0.0, 1.0);
    return inside.x * inside.y;
}

#ifdef IN_ROWS
const vec3 APART = vec3(0.618, 0.755, 0.57);  // steps of the random height, place and side from tree to tree in a row
const vec3 ROWS_APART = vec3(7.0, 11.0, 13.0);  // and from row to row
const vec2 LOWER = vec2(1.0, 0.35);  // height of a row's picture, of its trees' least, and range of it

// Position of a pixel on the picture of its tree in the row.
vec2 on_own() {
    if (row_told.x <= 1.0)
        return on.xy;
    float along = on.x * row_told.x, number = floor(along);
    vec3 own = fract(number * APART + told.x * ROWS_APART);
    float aside = (fract(along) - 0.5) * row_told.y * (own.z > 0.5 ? 1.0 : -1.0);
    return vec2(0.5 + aside, on.y * (LOWER.x + LOWER.y * own.x));
}
#else
vec2 on_own() {
    return on.xy;
}
#endif

#ifdef CAST
void main() {
    vec4 texel, shading;
    mix_pictures(within(0.5 + 0.5 * vec2(slim, 1.0) * on.xy), mixed, texel, shading);
    texel *= float(max(slim * abs(on.x), abs(on.y)) < 1.0);
    float leaves = -log(1.0 - HIDES_MOST * texel.a) * mix(1.0, foot.z, 1.0 - texel.g);
    vec2 inner = max(1.0 - dot(on.xy, on.xy) / vec2(shades.x * shades.x, foot.x * foot.x), 0.0);
    float above = dot(vec2(shades.y, foot.y), inner * inner);
    pixel = vec4(leaves, mix(leaves * shades.w, above, shades.z), 0.0, 0.0);
}
#else
// Position on the picture before the wind displaced it.
vec2 blown_from(vec2 at) {
    vec2 aside = told.y * at.y * sin(waves + SHIMMER_TURNS * at.yx);
    float high = clamp(on.z, 0.0, 1.0);
    aside.x += told.z * (high - cantilever(high));
    return at + vec2(slim, 1.0) * aside;
}

const float PLAINER = 2.0;     // loss of bark's detail with each coarser level, which is read sharper than pixels are,
const float PLAIN_FROM = 0.5;  // from this level on: there, pictures have 180 texels up
const float CLUMP = 7.0;       // width of a clump of leaves [texels]
const mat2 CLUMPS = mat2(0.857, 0.515, -0.515, 0.857) / CLUMP;  // matrix from texels to noise: it lies askew, so that cells are cut both ways
const float CLUMPS_FINER = log2(CLUMP / NOISE_FINER);  // levels by which texels of noise are larger than a picture's
const float EVENLY = 1.6;      // contrast of noise, whose values lie about the middle: equally many clumps give way at each step

// Random number from 0 to 1 of a clump of leaves.
float clump_at(vec2 at) {
    vec2 cell = CLUMPS / NOISE_CELLS * (at * sides) + told.x;
    float noise = textureLod(tree_cards, vec3(cell, 0.0), max(told.w - CLUMPS_FINER, 0.0)).r;
    return clamp(0.5 - 0.5 * EVENLY + EVENLY * noise, 0.0, 1.0);
}

// Share of the second picture in a clump: they give way one after another, as two views blended are a blur.
vec2 gives_way(float clump) {
    return clamp(gives.xy - gives.z * clump, 0.0, 1.0);
}

const float BARE = 0.15;  // coverage by stems where clumps are gone that hid them, of the clumps'

const float UNCLUMPED = 2.5;  // leaves behind the first of a clump that is seen, of the optical depth: 1 / CLUMPING

// Share of a clump that is left where a tree has few leaves: of many behind one another, one is seen.
float left_of(float clump, vec4 shading) {
    float meets_all = max(UNCLUMPED * sun_meets(shading, behind_meets), LEAST_PART);
    float left = (1.0 - transmittance(foliage_of(meets) * meets_all)) / (1.0 - transmittance(meets_all));
    return clamp((1.0 + gives.z) * left - gives.z * clump, 0.0, 1.0);
}

void main() {
    vec4 texel, shading;
    vec2 at = blown_from(on_own());
    float clump = clump_at(at);
    mix_pictures(within(at), gives_way(clump), texel, shading);
    float own = own_of(at);
    texel *= own;
    shading *= own;
    float whole = 1.0 / max(texel.a, LEAST_COVER);
    shading *= whole;
    float gone = 1.0 - left_of(clump, shading);
    float leaves = texel.a - texel.g, stems = texel.g + BARE * gone * leaves, all = leaves * (1.0 - gone) + stems;
    float cover = 1.0 - pow(max(1.0 - all, 0.0), sunlit.a), wood = stems / max(all, LEAST_COVER);  // twigs that are still drawn cover the rest
    must_cover(cover);
    float seen = transmittance(sun_meets(shading, meets)), open = transmittance(sky_meets(shading, meets));
    vec3 sky = sky_on(skylit.rgb, below, open, skylit.a * (1.0 - wood));
    Light light = Light((sunlit.rgb + wooden.rgb * wood) * seen, sky, hazy, 0.0, 0.0, vec2(0.0));
    float aged = aged_at(wooden.a * texel.b / max(texel.g, LEAST_COVER));
    float tone = texel.r * whole, plain = PLAINER * max(told.w - PLAIN_FROM, 0.0);
    float worn = mix(1.0, 2.0 * tone, wood / (1.0 + plain));  // of bark too: 0.5 is the mean
    vec3 pigment = pigment_of(tone, wood, soiled_at(on.z * grasses) * worn * mix(young_bark, old_bark, aged));
    pixel = drawn(shade(Surface(pigment, 1.0, LEAF_SCATTERING), light), cover);
}
#endif
