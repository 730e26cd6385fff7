// Writes the picture's depth where the picture hides something of the host's.

#include "engine/gl/smaller.glsl"

uniform bool whole;  // whether `enlarge` writes depth where the host has drawn nothing

out vec4 pixel;

void main() {
    if (whole && !is_drawn(host_depth_here())) {
        discard;
    }
    float drawn = texture(small_depth, at).r;
    if (farther_by(drawn, texture(host_depth, pixel_centre(at)).r) >= 0.0) {
        discard;
    }
    pixel = vec4(0.0);
    gl_FragDepth = drawn;
}
