// Outlines: the silhouette of the carpet against what is behind a crest.
#include "systems/show/carpet/sight.glsl"

const vec2 SPIKES_FROM = vec2(0.8, 1.0);  // shares of the carpet from which on they count: where it sinks, they would swim
const float SHOWN_FROM = 1.0 / 3.0;  // share from which on an outline hides none of its own grass
const float STANDING = 0.9;  // least coverage that is drawn where strips have just begun to give way
const float NOTHING = 0.004;  // coverage below which a pixel shows nothing, in 8 bits
const float LEAST_COVER = 0.05;  // least coverage of grass over a crest whose colour stands for all of it
const float HALF = 0.5;

const float LINES_IN_PIXEL = 4.0;  // their number
const float ENOUGH = 2.8;  // mean optical depth at which taller plants make no difference

// Optical depths over a crest, of the lines of sight IN_PIXEL of a pixel of this height [m]. One that passes at a relative depth d below
// the top of the grass meets d^2 of its leaf area, which falls off linearly with height, on a path that goes by the root of d.
vec4 leaves_over_crest(float slope, float curvature, float tall, float stands, float leaf_area, float pixel) {
    float curved = 2.0 * max(curvature, LEAST_CURVATURE), high = max(tall * stands, LOWEST_GRASS);
    float leaves = CREST * leaf_area * inversesqrt(curved) / (high * high);
    vec4 all = max(slope * abs(slope) / curved + IN_PIXEL * pixel - outline_raise(curvature, pixel), 0.0);
    return leaves * all * sqrt(all) + OPAQUE * max(1.0 - tall / (2.0 * LOWEST_GRASS), 0.0);
}

// Mean opacity of a pixel whose lines of sight have these optical depths.
float outline_cover(vec4 met) {
    return 1.0 - dot(transmittance(met), vec4(1.0)) / LINES_IN_PIXEL;
}

// Slope of a line of sight to the mesh as if that were not raised along an outline.
float slope_below(float slope, float curvature, float pixel) {
    return slope > 0.0 ? sqrt(max(slope * slope - 2.0 * curvature * outline_raise(curvature, pixel), 0.0)) : slope;
}

// Slope at which the carpet rises along the line of sight where taller grass begins: that is seen although the ground falls away behind
// a crest.
float carpet_rise_ahead(vec2 at, float tall) {
    vec2 dx = dFdx(at), dy = dFdy(at), to = heading_to(at), rises = vec2(dFdx(tall), dFdy(tall));
    vec2 way = dot(dx, dx) > dot(dy, dy) ? vec2(dot(dx, to), rises.x) : vec2(dot(dy, to), rises.y);
    return max(way.y * sign(way.x) / max(abs(way.x), TINY), 0.0);
}

// Factor of the leaves met along an outline, for plants taller than the mean by a fraction `taller`.
float spike_factor(float taller, float share) {
    float spikes = SPIKES * clamp((share - SPIKES_FROM.x) / (SPIKES_FROM.y - SPIKES_FROM.x), 0.0, 1.0);
    return exp(spikes * clamp(taller, -TALLER, TALLER));
}
