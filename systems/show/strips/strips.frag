// With THIN, blades are drawn by rank, and with EDGED density has edges. With SHADED bodies, shades and shadow maps cast shadows, and
// with CUT some grass is cut: those are programs of their own, as fragments would pay half as much again for what is rare. With
// DEEP, only depth is written.
#include "lib/light.glsl"

#define PASSED in
#include "systems/show/strips/passed.glsl"
#ifdef HEADS
#include "lib/stack.glsl"
#endif

uniform sampler2DArray atlas;  // place along the blade, cosine and sine (or the eye's colour) of twice the normal's azimuth, coverage; premultiplied
#ifdef THIN
uniform sampler2DArray ranks;  // rank; premultiplied
#endif

out vec4 pixel;

#ifdef DEEP
#include "systems/show/deep.glsl"

const float WHOLE_TEXELS = -1.0;  // level of the mip-maps from which on texels are the mean of several blades, or of none
#endif
const float FAINT = 0.006; // coverage that is left out: in bytes, layer upon layer, it would but be rounded up
const float LEAST_PAINT = 0.002;  // coverage of a texel that counts at least, for what it shows
const float SUNKEN = 0.3;  // height of grass from which on strips begin to show, of that below which they would show as rows

#ifdef THIN
#include "systems/show/strips/thin.glsl"
#ifdef EDGED
#include "systems/space/ground.py"

// What is left of a texel where density has edges.
float grown(float covers, float rank, float level) {
    float dense = density_at(roots.xy, int(roots.w + 0.5));
    return dense > PRESENT ? thinned(covers, dense, rank, 1.0 / span_of(dense, rise.a), level) : 0.0;
}
#else
float grown(float covers, float rank, float level) {
    return thinned(covers, roots.w, rank, rise.a, level);
}
#endif
#endif

#ifdef CUT
// How much of a strip is left where grass is cut.
float left_of(float top) {
    float left = clamp((top - roots.z) * cut.y + 0.5, 0.0, 1.0);
    return is_mown(top) ? left * smoothstep(SUNKEN * cut.z, max(cut.z, LEAST_LENGTH), top) : left;
}
#endif

void main() {
    float page = packed_extra(lit).x, level = packed_extra(lit).y, boosts = packed_extra(lit).z;
    vec4 texel = textureLod(atlas, vec3(on.xy, page), level);
#ifdef HEADS
    boosts = mix(boosts, heads, head_part(texel.r / max(texel.a, LEAST_PAINT)));
#endif
    float painted = min(texel.a * boosts, 1.0), covered = foot.a * painted;
    if (covered < FAINT) {
#ifdef DEEP
        discard;
#endif
        pixel = vec4(0.0);
        return;
    }
    vec3 mean = texel.rgb / max(texel.a, LEAST_PAINT);
    vec2 twice = 2.0 * mean.gb - 1.0;
#ifdef EYED
    vec3 base = foot.rgb + rise.rgb * mean.r, grain = 1.0 + grain_cos.rgb * twice.x;
    vec3 pigment = eyed > 0.0 ? (base + grain_sin.rgb * mean.b) * grain : base * (grain + grain_sin.rgb * twice.y);
#else
    vec3 pigment = (foot.rgb + rise.rgb * mean.r) * (1.0 + grain_cos.rgb * twice.x + grain_sin.rgb * twice.y);
#endif
    Light light = unpack_light(lit);
#ifdef SHADED
    float seen = body_visibility(sqrt(max(shadow.x + on.z * (shadow.y + on.z * shadow.z), 0.0)), shadow.w);
    if (has_casters())
        seen *= casters_visibility(spot.xyz);
    light = shadowed(light, seen, spot.w);
#elif defined(TREES)
    light = shadowed(light, trees_visibility_before(spot, past.x), past.y);
#endif
#ifdef CUT
    if (cut.w > 0.5) {
        float top = cut_height_at(roots.xy);
        light = light_when_cut(top, light, int(cut.x), leaf_areas(density_at(roots.xy)));
        covered *= left_of(top);
    }
#endif
#ifdef DEEP
    vec3 grass = vec3(0.0);
#else
    vec3 grass = tone_mapped(shade(leaf_surface(pigment, on.w), light));
#endif
#ifdef THIN
    float rank = textureLod(ranks, vec3(on.xy, page), level).r / max(texel.a, LEAST_PAINT);
    covered *= grown(painted, rank, level) / max(painted, LEAST_PAINT);
    covered *= clamp(grain_cos.a * rank + grain_sin.a, 0.0, 1.0) * clamp(aged.x * rank + aged.y, 0.0, 1.0);
#endif
#ifdef DEEP
    if (covered < least_cover(number, clamp(level - WHOLE_TEXELS, 0.0, 1.0)))
        discard;
#endif
    pixel = vec4(grass, 1.0) * (covered < FAINT ? 0.0 : covered);
}
