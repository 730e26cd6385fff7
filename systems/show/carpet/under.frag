// An opaque layer beneath the carpet.
#include "lib/tone.glsl"

in vec3 color;

out vec4 pixel;

void main() {
    pixel = vec4(shown_of(color), 1.0);
}
