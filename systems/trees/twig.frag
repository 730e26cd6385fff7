// Twigs: leaf by leaf with LEAVES, else on their cards.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/coverage.glsl"
#include "systems/trees/card_texel.glsl"

in vec2 on;
#ifdef BAKED
in vec3 facing;
in vec4 inside;
flat in float tone;
flat in float picture;

layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;

const float APART = 7.0;  // difference of the thresholds of leaves and twigs, by their random numbers
#else
in float stem_cover;
flat in vec3 leaf_colour;
flat in vec3 midrib_colour;

out vec4 pixel;
#endif

const float VEIN = 0.05;  // width of a leaf's midrib

void main() {
    float beside = smoothstep(0.0, VEIN, abs(on.x));
#ifdef LEAVES
    float leaf = leaf_cover(on);  // called in all pixels, as it takes derivatives
#endif
#ifdef BAKED
#ifdef LEAVES
    bool stem = inside.y > 0.5;
    float cover = stem ? inside.z : leaf, ribbed = mix(RIBBED, 1.0, beside), shows = inside.x * ribbed, brightest = stem ? 0.0 : ribbed;
    second = vec4(0.5 + 0.5 * normalize(facing), 1.0);
#else
    CardTexel seen = card_texel(on, picture);
    float cover = seen.cover, shows = seen.tone * tone, brightest = 0.0;
    second = packed_shading(inside);
#endif
    if (cover <= threshold_of(APART * (tone + inside.x)))
        discard;
    pixel = vec4(clamp(shows, 0.0, 1.0), brightest, 0.0, 1.0);  // tone, and the tone if all leaves had a tone of 1
#else
    float cover = stem_cover < 0.0 ? leaf : stem_cover;
    discard_uncovered(cover);
    pixel = blend_colour(mix(midrib_colour, leaf_colour, beside), cover);
#endif
}
