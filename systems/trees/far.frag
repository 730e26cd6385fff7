#define OF_TREES
#include "lib/light.glsl"
#include "systems/trees/crown.glsl"
#include "systems/trees/far.py"
#include "systems/trees/leaf.glsl"
#include "systems/trees/motion.py"
#include "systems/trees/shown.glsl"

uniform sampler2DArray tree_far;  // tone, wood, nothing, cover; then by how many leaves light has met, by direction and in all
uniform float moment;

in vec2 on;
in vec3 seen_at;
flat in vec4 rows_of;
flat in vec2 mixed;
flat in vec4 sun_own;
flat in vec4 sunlit;
flat in vec3 sunlit_wood;
flat in vec3 skylit;
flat in vec3 hazy;
flat in vec3 below;
flat in float lit_by;
flat in vec2 sways;
flat in vec3 bends;
flat in vec4 row_told;  // as far.vert has it
#ifdef CAST
flat in vec3 shades;  // as far.vert has it
flat in vec2 foot;
#endif

out vec4 pixel;

const vec2 SHIMMER_HERTZ = vec2(1.7, 1.3);  // how fast limbs swing, along and across a picture [Hz]
const float SHIMMER_TURNS = 15.0;  // how much their swing changes over a crown [rad]
const float SHIMMER = 0.12;  // how far they seem to swing, of how far they do, of a picture
const float HIDES_MOST = 0.96;  // of the sun's light, where leaves cover a texel wholly
const float COMES = 1.5;  // how much sooner it is all there than twigs are left to it
const float FACES_UP = 0.5;  // how far up what is seen of a crown looks, -1 to 1; wood, which is upright, does not

vec2 tile_at(vec2 number, vec2 at) {
    return (number + at) / vec2(COLUMNS, ROWS);
}

// What the pictures show together that are mixed, two in a row: with most trees, it is one of them alone.
void mix_pictures(vec2 at, out vec4 texel, out vec4 shading) {
    ivec2 first = ivec2(greaterThanEqual(mixed, vec2(1.0))), last = ivec2(greaterThan(mixed, vec2(0.0)));
    texel = shading = vec4(0.0);
    for (int row = first.y; row <= last.y; row++)
        for (int column = first.x; column <= last.x; column++) {
            vec2 place = tile_at(vec2(column == 0 ? rows_of.x : rows_of.z, row == 0 ? rows_of.y : rows_of.w), at);
            float part = (column == 0 ? 1.0 - mixed.x : mixed.x) * (row == 0 ? 1.0 - mixed.y : mixed.y);
            texel += part * textureLod(tree_far, vec3(place, 0.0), row_told.z);
            shading += part * textureLod(tree_far, vec3(place, 1.0), row_told.z);
        }
}

const vec3 APART = vec3(0.618, 0.755, 0.57);  // how far trees of a row are apart by their numbers: in height, place, and side
const vec3 ROWS_APART = vec3(7.0, 11.0, 13.0);  // and rows, by what tells them from others
const vec2 LOWER = vec2(1.0, 0.35);  // how many times as high a picture is as one of its trees, and how much more it may be

// Where a pixel is on the picture of its tree, of those that stand side by side.
vec2 on_own(vec2 at) {
    if (row_told.x <= 1.0)
        return at;
    float along = at.x * row_told.x, number = floor(along);
    vec3 own = fract(number * APART + row_told.w * ROWS_APART);
    float aside = (fract(along) - 0.5) * row_told.y * (own.z > 0.5 ? 1.0 : -1.0);
    return vec2(0.5 + aside, at.y * (LOWER.x + LOWER.y * own.x));
}

void main() {
    vec2 at = on_own(0.5 + 0.5 * on);
#ifndef CAST
    vec2 waves = sin(AROUND * (SHIMMER_HERTZ * moment + lit_by) + SHIMMER_TURNS * at.yx + vec2(0.0, 1.0));
    at += SHIMMER * sways.y * waves * at.y;
    float high = clamp((seen_at.y - bends.y) * bends.z, 0.0, 1.0);
    at.x += bends.x * (high - cantilever(high));
#endif
    at = clamp(at, TILE_EDGE, 1.0 - TILE_EDGE);
    vec4 texel, shading;
    mix_pictures(at, texel, shading);
#ifdef CAST
    texel *= float(max(abs(on.x), abs(on.y)) < 1.0);
    float leaves = -log(1.0 - HIDES_MOST * texel.a) * mix(1.0, sun_own.w, 1.0 - texel.g);
    vec2 within = max(1.0 - dot(on, on) / vec2(shades.x * shades.x, foot.x * foot.x), 0.0);
    float above = dot(vec2(shades.y, foot.y), within * within);
    pixel = vec4(leaves, mix(leaves * dot(seen_at, sun), above, shades.z), 0.0, 0.0);
#else
    float wood = texel.g / max(texel.a, LEAST_COVER);
    texel *= mix(sun_own.w, 1.0, wood);
    float cover = texel.a * clamp(sunlit.a * COMES, 0.0, 1.0);
    must_cover(cover);
    shading = unpacked_shading(shading / max(texel.a, LEAST_COVER));
    float seen = through_crown(shading, sun_own.xyz, sun_own.w);
    vec3 sky = sky_on(skylit, below, sky_through(shading, sun_own.w), FACES_UP * (1.0 - wood));
    Light light = Light(mix(sunlit.rgb, sunlit_wood, wood) * seen, sky, hazy, 0.0, 0.0, vec2(0.0));
    vec3 pigment = pigment_of(texel.r / max(texel.a, LEAST_COVER), wood);
    pixel = drawn(shade(Surface(pigment, 1.0, AMONG_LEAVES), light), cover);
#endif
}
