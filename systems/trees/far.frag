#define OF_TREES
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/far.py"
#include "systems/trees/motion.py"

uniform sampler2DArray tree_far;  // tone, wood, nothing, cover; then by how many leaves light has met, by direction and in all
uniform float moment;

in vec2 on;
in vec3 seen_at;
flat in vec4 rows_of;
flat in vec2 mixed;
flat in vec4 sun_own;
flat in vec4 sunlit;
flat in vec3 skylit;
flat in vec3 hazy;
flat in vec3 below;
flat in float lit_by;
flat in vec2 sways;

out vec4 pixel;

const vec2 SHADING = vec2(3.0, 6.0);  // as of twigs
const float SHIMMERS = 5.0;  // how often limbs' swing changes over a crown

vec2 tile_at(vec2 number, vec2 at) {
    return (number + at) / vec2(COLUMNS, ROWS);
}

vec4 row_texel(float row, vec2 at, float layer) {
    vec4 texel = vec4(0.0);
    if (mixed.x < 1.0)
        texel = (1.0 - mixed.x) * texture(tree_far, vec3(tile_at(vec2(rows_of.x, row), at), layer));
    return mixed.x > 0.0 ? texel + mixed.x * texture(tree_far, vec3(tile_at(vec2(rows_of.z, row), at), layer)) : texel;
}

vec4 mixed_texel(vec2 at, float layer) {
    vec4 texel = mixed.y < 1.0 ? row_texel(rows_of.y, at, layer) : vec4(0.0);
    return mixed.y > 0.0 ? mix(texel, row_texel(rows_of.w, at, layer), mixed.y) : texel;
}

void main() {
    vec2 at = 0.5 + 0.5 * on;
#ifndef CAST
    vec2 waves = sin(6.2831853 * (vec2(1.7, 1.3) * moment + lit_by) + SHIMMERS * at.yx * 3.0 + vec2(0.0, 1.0));
    at += 0.12 * sways.y * waves * at.y;
#endif
    at = clamp(at, TILE_EDGE, 1.0 - TILE_EDGE);
    vec4 texel = mixed_texel(at, 0.0);
#ifdef CAST
    float leaves = -log(max(1.0 - 0.96 * texel.a, 0.02)) * mix(1.0, sun_own.w, 1.0 - texel.g);
    pixel = vec4(leaves, leaves * dot(seen_at, sun), 0.0, 0.0);
#else
    float wood = texel.g / max(texel.a, 0.01);
    texel *= mix(sun_own.w, 1.0, wood);  // of few leaves, those are left that stand densest
    float edge = mix(1.0, 0.42, clamp(sunlit.a * 1.5, 0.0, 1.0));
    float cover = clamp((texel.a - edge) / max(fwidth(texel.a), 0.04) + 0.5, 0.0, 1.0);
    vec4 met = mixed_texel(at, 1.0) / max(texel.a, 0.01);
    must_cover(cover);
    vec4 shading = vec4((2.0 * met.xyz - 1.0) * SHADING.x, met.w * SHADING.y);
    float seen = through_leaves(sun_own.w * max(dot(shading, vec4(sun_own.xyz, 1.0)), 0.0));
    float open = through_leaves(SKY_MEETS_LESS * sun_own.w * max(shading.w + SKY_FROM * shading.y, 0.0));
    vec3 ray = normalize(seen_at - eye);
    float facing = dot(ray, sun), back = 0.5 - 0.5 * facing, against = 1.0 - back;
    vec3 sends = mix(back * sqrt(back) + against * sqrt(against) * LEAF_THROUGH, vec3(0.6 * back), wood);
    vec3 sky = skylit * open * 0.75 + below * (0.25 * mix(0.4, 1.0, open));
    Light light = Light(sunlit.rgb * (seen * sends), sky, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(pigment_of(texel.r / max(texel.a, 0.01), wood), 1.0, AMONG_LEAVES), light), cover);
#endif
}
