// Lays the picture over all that the host has drawn.

#include "engine/gl/smaller.glsl"

out vec4 pixel;

void main() {
    pixel = sharp(at);
}
