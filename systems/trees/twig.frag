// Twigs: leaf by leaf with LEAVES, else on their cards.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/pictured.glsl"

in vec2 on;
#ifdef BAKED
in vec3 facing;
in vec4 inside;
flat in float tone;
flat in float picture;

layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;

const float APART = 7.0;  // difference of the thresholds of leaves and twigs, by their random numbers
const float RIBBED = 0.8;  // as in twig.vert
#else
in float covers;
flat in vec3 shown;
flat in vec3 ribbed;

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
    float cover = inside.y > 0.5 ? inside.z : leaf, shows = inside.x * mix(RIBBED, 1.0, beside);
    second = vec4(0.5 + 0.5 * normalize(facing), 1.0);
#else
    Pictured seen = pictured(on, picture);
    float cover = seen.cover, shows = seen.tone * tone;
    second = packed_shading(inside);
#endif
    if (cover <= threshold_of(APART * (tone + inside.x)))
        discard;
    pixel = vec4(clamp(shows, 0.0, 1.0), 0.0, 0.0, 1.0);
#else
    float cover = covers < 0.0 ? leaf : covers;
    must_cover(cover);
    pixel = covered(mix(ribbed, shown, beside), cover);
#endif
}
