// Messages to receivers, captured into a buffer: to compare a wind's twin with its numpy.
#include "systems/wind/hear.glsl"

in vec2 place;      // ground position [m]
in float grass;     // kind of grass
in float still;     // 1 for one without the small oscillations
in float receiver;  // number

out vec2 message;

void main() {
    message = hear(place, int(grass), still > 0.5, int(receiver));
    gl_Position = vec4(message, 0.0, 1.0);
}
