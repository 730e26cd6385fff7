#include "lib/light.glsl"

uniform sampler2DArray atlas;  // place along the blade, face normal x and z, coverage; premultiplied
uniform sampler2DArray ranks;

in vec2 at;
in float h;
in float rate;
flat in float sheet;
in vec3 foot_color;
in vec3 rise_color;
in vec3 veil;
flat in vec3 grain_u;
flat in vec3 grain_v;
flat in float shown;
in float grows;

out vec4 pixel;

// How much of a texel stays where its kind grows thinly: its blades above the density go, sharply where the texel is
// one blade, in proportion where it is the mean of many.
float thinned(float level) {
    float rank = texture(ranks, vec3(at, sheet)).r;
    float soft = clamp(level * 0.35, 0.06, 1.0);
    return clamp((grows - rank) / soft + 0.5, 0.0, 1.0);
}

void main() {
    vec4 texel = texture(atlas, vec3(at, sheet));
    if (texel.a < 0.008)
        discard;
    vec2 normal = 2.0 * texel.gb / texel.a - 1.0;
    vec3 grass = foot_color * texel.a + rise_color * texel.r;
    grass *= (1.0 + grain_u * normal.x + grain_v * normal.y) * canopy(h, rate);
    float stays = shown;
    if (grows < 0.995) {
        vec2 step = fwidth(at) * vec2(textureSize(ranks, 0).xy);
        stays *= thinned(max(log2(max(step.x, step.y)), 0.0));
    }
    pixel = vec4(grass + veil * texel.a, texel.a) * stays;
}
