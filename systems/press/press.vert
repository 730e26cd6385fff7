// Bending of pressed grass as transform feedback, for tests that compare the twin with numpy.
#include "systems/press/press.glsl"

in vec2 place;   // ground position [m]
in float grass;  // kind of grass

out vec2 lies;

void main() {
    lies = pressing(place, int(grass));
    gl_Position = vec4(lies, 0.0, 1.0);
}
