// Light is stopped in the grass by chance (Beer, 1852), where leaf area lies as lib/canopy.glsl has it. So each pixel draws a lot.
#include "lib/canopy.glsl"
#include "lib/random.glsl"

uniform vec3 light;

in vec3 place;
in float mesh_share;
in float high;
in float stops;

const float LEVEL = 0.02;  // sine of the elevation of light that counts at least

float lot(int number) {
    return unit(hash3(int(gl_FragCoord.x), int(gl_FragCoord.y), number));
}

void main() {
    float met = -log(max(1.0 - lot(0), LEAST_LENGTH));  // leaves that it meets before it is stopped
    if (met > stops || lot(1) > mesh_share)
        discard;
    vec3 from = normalize(light - place);
    vec4 there = clip * vec4(place - from * (high * depth_passed(met / stops) / max(from.y, LEVEL)), 1.0);
    gl_FragDepth = depth_of(there);
}
