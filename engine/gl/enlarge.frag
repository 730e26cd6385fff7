// Writes the picture's colour, opaque, and its depth where the host has drawn nothing, even next to what the host has drawn. With TILED,
// the host has drawn nothing at all; then depth is written with DEEP alone, on tiles where the picture has any.

#include "engine/gl/smaller.glsl"

const float LEAST = 0.05;  // opacity in a gap between the host's things that is too narrow for the smaller picture
const float OPAQUE = 0.9;  // opacity from which no thing of the host's is near, whose depth the smaller picture would have here

out vec4 pixel;

void main() {
#ifndef TILED
    if (is_drawn(host_depth_here())) {
        discard;
    }
#endif
    vec4 drawn = upsampled(at);
    if (drawn.a < LEAST) {
        discard;
    }
    pixel = vec4(min(drawn.rgb / drawn.a, 1.0), 1.0);
#if defined(DEEP) || !defined(TILED)
    gl_FragDepth = drawn.a < OPAQUE ? farthest : texture(small_depth, at).r;
#endif
}
