// The canopy as a participating medium: its height, the leaf area above a height, and the optical depth of rays through it.
#include "lib/sown.glsl"
#include "lib/through.glsl"
#include "systems/space/canopy.py"

// Height of a canopy that is bent by `bend`, as a part of its height at rest.
float lodged(vec2 bend) {
    return 1.0 - LODGED * min(dot(bend, bend), 1.0);
}

// Leaf area index above a height [m], from the leaf area of each kind, which falls off towards its top.
float leaf_area_above(float height, ByKind area) {
    float over = 0.0;
    for (int group = 0; group < GROUPS; group++) {
        vec4 above = max(1.0 - height / max(crown[group], LOWEST_CROWN), 0.0);
        over += dot(area[group], above * above);
    }
    return over;
}

// Leaf area index above a kind's top, and below it.
vec2 leaf_area_split(ByKind densities, int k) {
    ByKind area = leaf_areas(densities);
    float over = leaf_area_above(OF(crown, k), area);
    return vec2(over, total(area) - over);
}

const float FILLS = 0.75;  // part of a kind's leaf area that grows with the square of the depth; the rest grows with its cube

// Leaf area index above height `h` in a kind's canopy, 0 on the ground and 1 at the top; `leaves` is its leaf_area_split.
float leaf_area_above(float h, vec2 leaves) {
    float deep = clamp(1.0 - h, 0.0, 1.0);
    return leaves.x + leaves.y * deep * deep * (FILLS + (1.0 - FILLS) * deep);
}

// Depth below the canopy's top, as a part of its height, above which lies `part` of the leaf area: inverts leaf_area_above, to 1 %.
float depth_of_leaf_area(float part) {
    return sqrt(part / (FILLS + (1.0 - FILLS) * sqrt(part)));
}

const float OPEN_SKY = 1.6;  // extinction of the sky's light: optical depth for each 1 of leaf area seen from the side
const float FLATTEST_SUN = 0.08;  // least sine of the sun's elevation over the slope, for its extinction

// Extinction along a ray: its optical depth for each 1 of leaf area seen from the side. `square` is the square of how far the ray
// goes over the ground for each metre of height. Leaves face all ways as the surface of an ellipsoid does (Campbell, Extinction
// coefficients for radiation in plant canopies, 1986).
float extinction_along(int kind, float square) {
    return sqrt(square + OF(lying, kind) * OF(lying, kind));
}

// Extinction of sunlight, by the sine of the sun's elevation over the slope.
float sun_extinction(int kind, float high) {
    high = max(high, FLATTEST_SUN);
    return extinction_along(kind, max(1.0 / (high * high) - 1.0, 0.0));
}

// Mean depth, as a part of the grass's height, at which a line of sight meets leaves, by its optical depth down to the ground.
// Above the depth d lies d^2 of the leaf area, as that falls off linearly with height. So the mean tends to 2/3 in thin grass, and
// to sqrt(pi) / 2 over the root of the optical depth in dense grass. This joins both, to 4 %.
const float THIN_MEAN = 5.0625;  // (2/3)^-4
const float DENSE_MEAN = 1.2732;  // 4 / pi

vec3 mean_depth_met(vec3 optical_depth) {
    optical_depth *= DENSE_MEAN;
    return inversesqrt(sqrt(THIN_MEAN + optical_depth * optical_depth));
}

float mean_depth_met(float optical_depth) {
    return mean_depth_met(vec3(optical_depth)).x;
}
