#include "lib/light.glsl"

uniform sampler2DArray atlas;  // place along the blade, normal across the strip, rank, coverage; premultiplied

in vec2 at;
in float h;
flat in float lifted;
flat in vec3 foot_color;
flat in vec3 rise_color;
flat in vec3 grain;
flat in float sheet;
flat in float hidden;
flat in float shown;
flat in float boost;  // of coverage
#ifdef THIN
in float grows;
flat in float below;  // rank up to which blades show, or negative: from which on
#endif

out vec4 pixel;

#ifdef THIN
// How much of a texel stays where its kind grows thinly, and where only blades of some ranks show: the others go,
// sharply where the texel is one blade, in proportion where it is the mean of many.
float thinned(float rank) {
    vec2 step = fwidth(at) * vec2(textureSize(atlas, 0).xy);
    float soft = clamp(0.35 * log2(max(max(step.x, step.y), 1.0)), 0.06, 1.0);
    float dense = grows > 0.995 ? 1.0 : clamp((grows - rank) / soft + 0.5, 0.0, 1.0);
    // The span must reach from below all ranks to above them, softness included.
    float edge = mix(-0.5 * soft, 1.0 + 0.5 * soft, abs(below));
    float over = clamp((edge - rank) / soft + 0.5, 0.0, 1.0);
    return dense * (below < 0.0 ? 1.0 - over : over);
}
#endif

void main() {
    vec4 texel = texture(atlas, vec3(at, sheet));
    if (texel.a < 0.008)
        discard;
    texel *= min(boost, 1.0 / texel.a);
    vec3 grass = foot_color * texel.a + rise_color * texel.r;
    grass *= (1.0 + grain * (2.0 * texel.g / texel.a - 1.0)) * canopy(h, lifted);
#ifdef THIN
    float stays = shown * thinned(texel.b / texel.a);
#else
    float stays = shown;
#endif
    pixel = vec4(mix(grass, haze.rgb * texel.a, hidden), texel.a) * stays;
}
