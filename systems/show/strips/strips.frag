#include "lib/layered.glsl"
#include "lib/light.glsl"

uniform sampler2DArray atlas;  // place along the blade, cosine and sine of twice the normal's azimuth, coverage; premultiplied
#ifdef THIN
uniform sampler2DArray ranks;  // rank; premultiplied
#endif

in vec2 at;
flat in vec3 foot_color;  // pigment
flat in vec3 rise_color;
flat in vec3 mean_face;   // its pigment, of that where it faces all ways alike
flat in vec3 grain_cos;   // change of pigment with the cosine of twice the normal's azimuth
flat in vec3 grain_sin;
in float h;            // height in the canopy
flat in mat4 lit;      // light on it, bundled; layer of the texture, level of its mip-maps, factor on coverage
flat in float shown;
flat in vec4 shadow; // of a body: the square of how near the sun's ray comes to it, by powers of `on_column`; how soft its edge is
in float on_column;  // from an edge of the column to the other
#ifdef MOWN
in vec3 roots;         // place on the ground (x, z), and how high over it in calm air [m]
#if KINDS <= 4
flat in ByKind leaf_area;// by kind, of the ground's
#endif
flat in int stood_of;  // kind
flat in float fine_at; // pixels that a metre is long
flat in int is_cut;    // whether anything is, about its column
flat in float rows_at; // height of grass below which strips would show as rows [m]
#endif
#ifdef THIN
in float grows;       // rank up to which blades grow, in steps of the softness
flat in vec2 stays;   // what shows by rank: slope and start, 0 to 1
flat in float sharp;  // 1 / softness
#endif

out vec4 pixel;

const float FAINT = 0.006; // coverage that is left out: in bytes, layer upon layer, it would but be rounded up

void main() {
    float sheet = lit[3].x, level = lit[3].y, boost = lit[3].z;
    vec4 texel = layer_at(atlas, vec3(at, sheet), level);
    vec3 mean = texel.rgb / max(texel.a, 0.002);
    vec3 pigment = (foot_color + rise_color * mean.r) * (mean_face + grain_cos * (2.0 * mean.g - 1.0) + grain_sin * (2.0 * mean.b - 1.0));
    float seen = past_body(sqrt(shadow.x + on_column * (shadow.y + on_column * shadow.z)), shadow.w);
    Light light = unbundled(lit);
    light.sun *= seen;
    light.gloss *= seen;
    float covered = shown * min(texel.a * boost, 1.0);
#ifdef MOWN
    if (is_cut > 0) {
        float top = left_at(roots.xy);
#if KINDS > 4
        ByKind leaf_area = areas(grows_at(roots.xy));
#endif
        light = mown_to(top, light, stood_of, leaf_area);
        covered *= clamp((top - roots.z) * fine_at + 0.5, 0.0, 1.0);
        if (is_mown(top))
            covered *= smoothstep(0.3 * rows_at, rows_at, top);
    }
#endif
    vec3 grass = shown_of(shade(leaf_at(pigment, h), light));
#ifdef THIN
    float rank = layer_at(ranks, vec3(at, sheet), level).r / max(texel.a, 0.002);
    covered *= clamp(grows - rank * sharp, 0.0, 1.0) * clamp(stays.x * rank + stays.y, 0.0, 1.0);
#endif
    pixel = vec4(grass, 1.0) * (covered < FAINT ? 0.0 : covered);
}
