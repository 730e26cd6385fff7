// The canopy as a medium: how high it stands, how much leaf area is above a height, and what light gets through it.
#include "lib/sown.glsl"
#include "lib/through.glsl"
#include "systems/space/canopy.py"

// How high the canopy stands where `bend` bends it, of its height at rest: where all grass lies, its tips are the top.
float lodged(vec2 bend) {
    return 1.0 - LODGED * min(dot(bend, bend), 1.0);
}

// Leaf area above a height [m], where each kind has so much. It thins out towards the top of each.
float leaves_above(float height, ByKind area) {
    float over = 0.0;
    for (int group = 0; group < GROUPS; group++) {
        vec4 above = max(1.0 - height / max(crown[group], LOWEST_CROWN), 0.0);
        over += dot(area[group], above * above);
    }
    return over;
}

// Leaf area above a kind's top and between that and the ground.
vec2 leaves_over(ByKind grows, int k) {
    ByKind area = areas(grows);
    float over = leaves_above(OF(crown, k), area);
    return vec2(over, total(area) - over);
}

const float FILLS = 0.75;  // leaf area between a kind's top and the ground goes by the depth squared so far, and then cubed

// Leaf area above height `h` in a kind's canopy, of which 1 is the top; `leaves` are of leaves_over.
float leaves_above(float h, vec2 leaves) {
    float deep = clamp(1.0 - h, 0.0, 1.0);
    return leaves.x + leaves.y * deep * deep * (FILLS + (1.0 - FILLS) * deep);
}

// How deep in the canopy, of its height, so much of its leaf area has been passed, from above: to 1 %.
float depth_passed(float part) {
    return sqrt(part / (FILLS + (1.0 - FILLS) * sqrt(part)));
}

const float OPEN_SKY = 1.6;  // leaves that the sky's light meets, of those seen from the side
const float FLATTEST_SUN = 0.08;  // sine of the sun's elevation over the slope that counts at least, for how many leaves it meets

// How many leaves are met on a way, of those seen from the side, that goes so far over the ground for each metre of height: leaves
// that lie in all directions as the faces of an ellipsoid do, which looks as large from above and from the side as they do
// (Campbell, Extinction coefficients for radiation in plant canopies, 1986). It is told the square of that.
float leaves_on_way(int kind, float square) {
    return sqrt(square + OF(lying, kind) * OF(lying, kind));
}

// The same of the sun's light, where its elevation over the slope has this sine.
float sun_way(int kind, float high) {
    high = max(high, FLATTEST_SUN);
    return leaves_on_way(kind, max(1.0 / (high * high) - 1.0, 0.0));
}

// The mean depth in the grass, of its height, of what a line of sight meets whose way to the ground has this optical depth.
// Leaf area falls off linearly with height, so that above the depth d lies d^2 of it: the mean of what is met tends to 2/3
// where it is thin and to sqrt(pi) / 2 over the root of the optical depth where it is dense. This joins both, to 4 %.
const float THIN_MEAN = 5.0625;  // (2/3)^-4
const float DENSE_MEAN = 1.2732;  // 4 / pi

vec3 depth_met(vec3 optical_depth) {
    optical_depth *= DENSE_MEAN;
    return inversesqrt(sqrt(THIN_MEAN + optical_depth * optical_depth));
}

float depth_met(float optical_depth) {
    return depth_met(vec3(optical_depth)).x;
}
