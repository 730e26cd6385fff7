// Copies the host's depth into the smaller picture, without colour.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    pixel = vec4(0.0);  // masked off
    gl_FragDepth = texture(host_depth, pixel_centre(at)).r;
}
