// Writes how deep the picture is, where anything has been drawn that hides the host's.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    ivec2 texel = min(ivec2(place_in_it()), size - 1);
    float drawn = texelFetch(deep, texel, 0).r;
    if (drawn >= depth_before(texel)) {
        discard;
    }
    pixel = vec4(0.0);
    gl_FragDepth = drawn;
}
