// A fragment of a strip. THIN: blades are missing by their rank. EDGED: the density has edges. SHADED: bodies, shades and shadow
// maps cast shadows. CUT: some grass is cut. DEEP: only depth is written. These are programs of their own, as they are rare, and
// would make each fragment half as dear again.
#include "lib/light.glsl"

#define PASSED in
#include "systems/show/strips/passed.glsl"
#ifdef HEADS
#include "lib/stack.glsl"
#endif

uniform sampler2DArray atlas;  // `texels` of grow.py: tone, cosine and sine (or the eye's part), coverage; premultiplied
#ifdef THIN
uniform sampler2DArray ranks;  // rank, premultiplied
#endif

out vec4 pixel;

#ifdef DEEP
#include "systems/show/deep.glsl"

const float WHOLE_TEXELS = -1.0;  // mip level from which on texels are means of several blades
#endif
const float FAINT = 0.006; // coverage below which nothing is drawn: many such layers would be rounded up in bytes
const float LEAST_PAINT = 0.002;  // lower limit of a texel's coverage, as a divisor
const float SUNKEN = 0.3;  // height of grass at which strips begin to show, of the height below which they would show as rows

#ifdef THIN
#include "systems/show/strips/thin.glsl"
#ifdef EDGED
#include "systems/space/ground.py"

// Coverage of a texel at the density of its place.
float at_density(float covers, float rank, float level) {
    float dense = density_at(roots.xy, int(roots.w + 0.5));
    return dense > PRESENT ? thinned(covers, dense, rank, 1.0 / rank_span(dense, pigment_change.a), level) : 0.0;
}
#else
float at_density(float covers, float rank, float level) {
    return thinned(covers, roots.w, rank, pigment_change.a, level);
}
#endif
#endif

#ifdef CUT
// Part of a strip that shows below the height `top` at which grass is cut. It fades where short strips would show as rows.
float part_below(float top) {
    float below = clamp((top - roots.z) * cut.y + 0.5, 0.0, 1.0);
    return is_mown(top) ? below * smoothstep(SUNKEN * cut.z, max(cut.z, LEAST_LENGTH), top) : below;
}
#endif

void main() {
    float page = packed_extra(lit).x, level = packed_extra(lit).y, boost = packed_extra(lit).z;
    vec4 texel = textureLod(atlas, vec3(uv.xy, page), level);
#ifdef HEADS
    boost += heads.x * head_part(texel.r / max(texel.a, LEAST_PAINT));
#endif
    float painted = min(texel.a * boost, 1.0), opacity = root_pigment.a;
    if (opacity * painted < FAINT) {
#ifdef DEEP
        discard;
#endif
        pixel = vec4(0.0);
        return;
    }
    vec3 mean = texel.rgb / max(texel.a, LEAST_PAINT);
    vec2 twice = 2.0 * mean.gb - 1.0;
#ifdef EYED
    vec3 base = root_pigment.rgb + pigment_change.rgb * mean.r, grain = 1.0 + grain_cos.rgb * twice.x;
    vec3 pigment = eyed > 0.0 ? (base + grain_sin.rgb * mean.b) * grain : base * (grain + grain_sin.rgb * twice.y);
#else
    vec3 pigment = (root_pigment.rgb + pigment_change.rgb * mean.r) * (1.0 + grain_cos.rgb * twice.x + grain_sin.rgb * twice.y);
#endif
    Light light = unpack_light(lit);
    float passes = 1.0;  // part of the light of sun and lamps that trees let through
#ifdef SHADED
    float seen = body_visibility(sqrt(max(shadow.x + uv.z * (shadow.y + uv.z * shadow.z), 0.0)), shadow.w);
    if (has_casters())
        seen *= casters_visibility(spot.xyz);
    light = shadowed(light, seen, spot.w);
#elif defined(TREES)
    passes = mix(1.0, trees_visibility_before(spot, past.x), past.y);
#endif
#ifdef CUT
    if (cut.w > 0.5) {
        float top = cut_height_at(roots.xy);
        light = light_when_cut(top, light, int(cut.x), leaf_areas(density_at(roots.xy)));
        opacity *= part_below(top);
    }
#endif
#ifdef DEEP
    vec3 grass = vec3(0.0);
#else
    vec3 grass = tone_mapped(shade(leaf_surface(pigment, uv.w), light, passes));
#endif
#ifdef THIN
    float rank = textureLod(ranks, vec3(uv.xy, page), level).r / max(texel.a, LEAST_PAINT);
#ifdef HEADS
    painted = at_density(painted, rank, level - heads.y);
#else
    painted = at_density(painted, rank, level);
#endif
    opacity *= clamp(grain_cos.a * rank + grain_sin.a, 0.0, 1.0) * clamp(form_fade.x * rank + form_fade.y, 0.0, 1.0);
#endif
    float covered = opacity * painted;
#ifdef DEEP
    if (covered < depth_threshold(number, clamp(level - WHOLE_TEXELS, 0.0, 1.0)))
        discard;
#endif
    pixel = vec4(grass, 1.0) * (covered < FAINT ? 0.0 : covered);
}
