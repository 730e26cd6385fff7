// A twig on its card: it is lit in the card's own axes, in which the picture has how its leaves lie.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/pictured.glsl"

in vec2 on;
flat in vec4 from_sun;
flat in vec3 from_eye;
flat in vec3 sunlit;
flat in vec3 skylit;
flat in vec3 hazy;
flat in vec3 strewn;

out vec4 pixel;

void main() {
    Pictured leaf = pictured(on);
    must_cover(leaf.cover);
    vec3 normal = normalize(leaf.lies);
    float lit = dot(normal, from_sun.xyz) * -sign(dot(normal, from_eye));
    Light light = Light(sunlit * leaf_sends(lit, strewn), skylit, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(pigment_of(leaf.tone * from_sun.w, leaf.wood), 1.0, AMONG_LEAVES), light), leaf.cover);
}
