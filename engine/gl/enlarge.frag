// Writes the picture where the host has drawn nothing: there it is opaque, whatever the host has drawn beside it.

#include "engine/gl/smaller.glsl"

const float LEAST = 0.05;  // opacity of a gap between the host's things that is too narrow for the smaller picture

out vec4 pixel;

void main() {
    vec4 drawn = sharp(at);
    if (drawn.a < LEAST) {
        discard;
    }
    pixel = vec4(min(drawn.rgb / drawn.a, 1.0), 1.0);
}
