// A twig on its card: it is lit in the card's own axes, in which the picture has how its leaves lie. A small one is lit as a whole.
#include "lib/light.glsl"
#include "systems/trees/leaf.glsl"
#include "systems/trees/shown.glsl"
#include "systems/trees/pictured.glsl"

in vec2 on;
#ifdef SMALL
flat in vec3 darkest;
flat in vec3 brightest;
flat in vec3 barked;
#else
flat in vec4 from_sun;
flat in vec3 from_eye;
flat in vec3 direct;
flat in vec3 strewn;
flat in vec3 skylit;
flat in vec3 hazy;
#endif

out vec4 pixel;

void main() {
    Pictured leaf = pictured(on);
    must_cover(leaf.cover);
#ifdef SMALL
    pixel = covered(mix(mix(darkest, brightest, leaf.tone), barked, leaf.wood), leaf.cover);
#else
    float lit = dot(leaf.lies, from_sun.xyz) * inversesqrt(max(dot(leaf.lies, leaf.lies), LEAST_SQUARE));
    lit = dot(leaf.lies, from_eye) < 0.0 ? lit : -lit;
    Light light = Light(strewn + direct * through_leaf(lit), skylit, hazy, 0.0, 0.0, vec2(0.0));
    pixel = drawn(shade(Surface(pigment_of(leaf.tone * from_sun.w, leaf.wood), 1.0, AMONG_LEAVES), light), leaf.cover);
#endif
}
