// Draws the picture over everything that the host has drawn.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    pixel = upsampled(at);
}
