// A twig on its card: its mean colour, brighter or darker by the normals of its leaves.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/coverage.glsl"
#include "systems/trees/card_texel.glsl"

in vec2 on;
flat in float picture;
flat in vec4 relief;
flat in vec3 darkest;
flat in vec3 brightest;

out vec4 pixel;

void main() {
    CardTexel leaf = card_texel(on, picture);
    float own = step(max(abs(on.x), abs(2.0 * on.y - 1.0)), 1.0), cover = own * leaf.cover;  // its outline may reach beyond the card
    discard_uncovered(cover);
    float brighter = dot(leaf.normal, relief.xyz) + relief.w;
    pixel = blend_colour(max(brighter, 0.0) * mix(darkest, brightest, leaf.tone), cover);
}
