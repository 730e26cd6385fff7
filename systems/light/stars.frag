// A star's spot: what it adds to the display colour of the sky behind it.
#include "lib/tone.glsl"

in vec2 aside;
flat in vec3 added;
flat in vec3 background;
out vec4 pixel;

void main() {
    vec3 light = background + exp(dot(aside, aside) * -0.5) * added;
    pixel = vec4(tone_mapped(light) - tone_mapped(background), 0.0);
}
