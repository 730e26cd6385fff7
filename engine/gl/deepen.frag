// Writes how deep the picture is, where anything has been drawn that hides the host's.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    float drawn = texture(deep, at).r;
    if (behind(drawn, texture(before, middle_of(at)).r) >= 0.0) {
        discard;
    }
    pixel = vec4(0.0);
    gl_FragDepth = drawn;
}
