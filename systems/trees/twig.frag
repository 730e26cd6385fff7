#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"

uniform sampler2DArray tree_cards;  // tone, wood, nothing, cover; the normal in the card's own axes, and cover

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

const float SHARP = 0.5;  // coverage at which a card's edge lies
const float VEIN = 0.05, RIBBED = 0.8;  // how broad a leaf's midrib is, and how much of its tone others have
const vec2 SHADING = vec2(3.0, 6.0);  // by how much of light's way in the crown textures' bytes count, to either side and in all

// The coverage of a card or an impostor, with an edge that is a pixel wide however large it is.
float sharpened(float cover) {
    return clamp((cover - SHARP) / max(fwidth(cover), 0.02) + 0.5, 0.0, 1.0);
}

void main() {
    float tone, wood = 0.0, cover;
    vec3 normal = normalize(facing);
#ifdef LEAVES
    wood = inside.y;
    float leaf = leaf_cover(on);
    cover = wood > 0.5 ? 1.0 : leaf;
    tone = inside.x * mix(1.0, RIBBED, 1.0 - smoothstep(0.0, VEIN, abs(on.x)));
#else
    vec2 at = vec2(0.5 + 0.5 * on.x, on.y);
    vec4 texel = texture(tree_cards, vec3(at, 0.0)), lie = texture(tree_cards, vec3(at, 1.0));
    cover = sharpened(texel.a);
    tone = texel.r / max(texel.a, 0.01) * across_card.w;
    wood = texel.g / max(texel.a, 0.01);
    vec3 turned_by = 2.0 * lie.rgb / max(lie.a, 0.01) - 1.0;
    normal = normalize(turned_by.x * across_card.xyz + turned_by.y * along_card + turned_by.z * normal);
#endif
#ifdef BAKED
    if (cover < 0.5)
        discard;
    pixel = vec4(clamp(tone, 0.0, 1.0), wood, 0.0, 1.0);
#ifdef LEAVES
    second = vec4(0.5 + 0.5 * normal, 1.0);
#else
    second = clamp(vec4(0.5 + 0.5 * inside.xyz / SHADING.x, inside.w / SHADING.y), 0.0, 1.0);
#endif
#else
    must_cover(cover);
    vec3 ray = normalize(seen_at - eye);
    Light light = Light(sunlit * leaf_sends(normal, ray), skylit, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(pigment_of(tone, wood), 1.0, AMONG_LEAVES), light), cover);
#endif
}
