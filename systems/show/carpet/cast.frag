// Light is stopped in the grass at random (Beer, 1852), with the profile of leaf area of lib/canopy.glsl: each pixel draws its depth.
#include "lib/canopy.glsl"
#include "lib/random.glsl"

uniform vec3 light;

in vec3 place;
in float mesh_share;
in float grass_height;
in float optical_depth;

const float LEVEL = 0.02;  // least sine of the elevation of light

// A random number in [0, 1) for the pixel.
float random_at(int number) {
    return unit(hash3(int(gl_FragCoord.x), int(gl_FragCoord.y), number));
}

void main() {
    float met = -log(max(1.0 - random_at(0), LEAST_LENGTH));  // optical depth at which it is stopped
    if (met > optical_depth || random_at(1) > mesh_share)
        discard;
    vec3 from = normalize(light - place);
    vec4 there = clip * vec4(place - from * (grass_height * depth_of_leaf_area(met / optical_depth) / max(from.y, LEVEL)), 1.0);
    gl_FragDepth = window_depth(there);
}
