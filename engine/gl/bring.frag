// Brings the host's depth over, and no colour.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    pixel = vec4(0.0);  // it is not written
    gl_FragDepth = texture(before, middle_of(at)).r;
}
