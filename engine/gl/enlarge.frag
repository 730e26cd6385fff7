// Writes the picture where the host has drawn nothing: there it is opaque, whatever the host has drawn beside it, and as deep
// as it was drawn.

#include "engine/gl/smaller.glsl"

const float LEAST = 0.05;  // opacity of a gap between the host's things that is too narrow for the smaller picture
const float OPAQUE = 0.9;  // from which on nothing of the host's is near by, whose depth stands in the smaller picture too

out vec4 pixel;

void main() {
    if (has_host(depth_before())) {
        discard;
    }
    vec4 drawn = sharp(at);
    if (drawn.a < LEAST) {
        discard;
    }
    pixel = vec4(min(drawn.rgb / drawn.a, 1.0), 1.0);
    gl_FragDepth = drawn.a < OPAQUE ? farthest : texture(deep, at).r;
}
