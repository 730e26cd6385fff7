// Writes how deep the picture is, where anything has been drawn that hides what the host has drawn.

#include "engine/gl/smaller.glsl"

uniform bool whole;  // whether `enlarge` does it where the host has drawn nothing

out vec4 pixel;

void main() {
    if (whole && !has_host(depth_before())) {
        discard;
    }
    float drawn = texture(deep, at).r;
    if (behind(drawn, texture(before, middle_of(at)).r) >= 0.0) {
        discard;
    }
    pixel = vec4(0.0);
    gl_FragDepth = drawn;
}
