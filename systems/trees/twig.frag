#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/pictured.glsl"

in vec2 on;
in vec3 facing;
in vec3 seen_at;
in vec3 sunlit;
in vec3 skylit;
in vec3 hazy;
in vec4 inside;
flat in vec4 across_card;
flat in vec3 along_card;

#ifdef BAKED
layout(location = 0) out vec4 pixel;
layout(location = 1) out vec4 second;
#else
out vec4 pixel;
#endif

const float VEIN = 0.05, RIBBED = 0.8;  // how broad a leaf's midrib is, and how much of its tone others have

#ifdef BAKED
const vec4 BAYER = vec4(0.125, 0.625, 0.875, 0.375);  // thresholds of two by two pixels, which are one in the end
const float APART = 7.0;  // how many times as much as their tones twigs' thresholds differ

// Coverage from which on a pixel is drawn: those of a texel have different ones, and each twig has its own order of them.
float threshold() {
#ifdef LEAVES
    return 0.5;
#else
    ivec2 pixel_at = ivec2(gl_FragCoord.xy) & 1;
    return fract(BAYER[2 * pixel_at.y + pixel_at.x] + APART * across_card.w);
#endif
}
#endif

void main() {
    float tone, wood = 0.0, cover;
    vec3 normal = normalize(facing);
#ifdef LEAVES
    float leaf = leaf_cover(on);  // asked by all pixels: it looks at their neighbours
    cover = inside.y > 0.5 ? inside.z : leaf;  // stems are green, as the darkest of leaves
    tone = inside.x * mix(1.0, RIBBED, 1.0 - smoothstep(0.0, VEIN, abs(on.x)));
#else
    Pictured leaf = pictured(on);
    cover = leaf.cover;
    tone = leaf.tone * across_card.w;
    wood = leaf.wood;
    normal = normalize(leaf.lies.x * across_card.xyz + leaf.lies.y * along_card + leaf.lies.z * normal);
#endif
#ifdef BAKED
    if (cover <= threshold())
        discard;
    pixel = vec4(clamp(tone, 0.0, 1.0), wood, 0.0, 1.0);
#ifdef LEAVES
    second = vec4(0.5 + 0.5 * normal, 1.0);
#else
    second = packed_shading(inside);
#endif
#else
    must_cover(cover);
    vec3 ray = normalize(seen_at - eye);
    Light light = Light(sunlit * leaf_sends(normal, ray), skylit, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(pigment_of(tone, wood), 1.0, AMONG_LEAVES), light), cover);
#endif
}
