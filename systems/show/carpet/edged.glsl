// Where lines of sight enter grass that ends or has been cut, as the mesh is too coarse for its edges. The mesh lies as high as uncut
// grass, and each pixel marches along its line of sight from there to the grass that stands.
#include "lib/mown.glsl"
#include "lib/canopy.glsl"
#include "lib/terrain.glsl"
#include "systems/show/carpet/sight.glsl"

uniform ByKind raised; // by kind: height of the carpet above the ground [m]

const float STEPS = 16.0;  // most steps down to level ground
const float MOST_STEPS = 32.0, LONGER = 1.12;  // where ground falls away: most steps, and growth of each step
const float OUT_OF_IT = 1.5;  // height at which it has left the grass over a crest, as a multiple of the mesh's
const float SHORTEST_STEP = 0.08;  // shortest step over the ground [m]
const int HALVINGS = 3;  // bisections of the last step, to find the edge
const float FARTHEST_ENTERED = 40.0;  // longest search over the ground [m]
const float NO_GRASS = 0.004;  // height of the carpet up to which there is no grass [m]
const float ROUNDED = 1e-3;  // tolerance for rounding, as a fraction of the mesh's height

// Height of the carpet over the ground for these densities and a cut height [m].
float carpet_height(ByKind densities, float cut_height) {
    float high = 0.0;
    for (int group = 0; group < GROUPS; group++)
        high += dot(densities[group], min(raised[group], cut_height));
    return high / max(total(densities), 1.0);
}

// Height to which grass is cut at a place [m].
float cut_height_here(vec2 place) {
    return anything_is_cut() ? cut_height_at(place) : tallest_grass;
}

// A line of sight from the mesh on; positions on it are distances over the ground.
struct Way {
    vec3 from;
    vec2 heading;
    float fall;       // its descent [m/m]
    float ground;     // height of height_filtered over the mesh's ground at its start [m]
    float high;       // height of the mesh over the ground [m]
    float mesh_lift;  // the same, as a fraction of the carpet's height on level ground
    float slope;      // slope to the ground [m/m]
    float curvature;  // curvature of the ground along it [1/m]
    float pixels;     // height of uncut grass in the picture [pixels]: more steps than that show nothing
};

Way way_from(vec3 place, float high, float mesh_lift, float slope, float curvature) {
    vec3 ray = place - eye;
    float pixels = ceil(high * pixels_per_metre() / length(ray)), ground = high - place.y + height_filtered(place.xz);
    return Way(place, heading_to(place.xz), -ray.y / max(length(ray.xz), TINY), ground, high, mesh_lift, slope, curvature, pixels);
}

// Distance until it hits the ground, or is past the point nearest to it over a crest [m].
float distance_to_ground(Way way) {
    float slope = max(way.slope, FLATTEST), turns = slope * slope - 2.0 * way.curvature * way.high;
    return 2.0 * way.high / (slope + sqrt(max(turns, 0.0)));
}

// Height over the ground at a distance [m].
float height_over_ground(Way way, float at) {
    vec2 there = way.from.xz + way.heading * at;
    return way.from.y - way.fall * at - height_filtered(there) + way.ground;
}

// Depth below the top of the grass at a distance [m]; negative above it, and where no grass stands.
float depth_below_top(Way way, float at) {
    vec2 there = way.from.xz + way.heading * at;
    float stands = way.mesh_lift * carpet_height(density_at(there), cut_height_here(there));
    return stands > NO_GRASS ? stands - height_over_ground(way, at) + ROUNDED * way.high : -1.0;
}

// Distance at which it enters grass [m], negative if it meets none; `aside` tells whether it enters from the side.
float entry_distance(Way way, out bool aside) {
    float most = min(distance_to_ground(way), FARTHEST_ENTERED);
    float step = most / clamp(min(ceil(most / SHORTEST_STEP), way.pixels), 1.0, STEPS);
    float at = 0.0, below, number = 0.0, high = way.high;
    aside = false;
    while ((below = depth_below_top(way, at)) < 0.0) {
        if (++number > MOST_STEPS || at >= FARTHEST_ENTERED || high <= 0.0 || high >= OUT_OF_IT * way.high)
            return -1.0;
        step *= number > STEPS ? LONGER : 1.0;
        at += step;
        high = height_over_ground(way, at);
    }
    // On even grass it enters from above, at an edge from the side.
    float outside = max(at - step, 0.0), above = clamp(at - below / max(way.slope, FLATTEST), outside, at);
    if (depth_below_top(way, above) >= -ROUNDED * way.high)
        return above;
    aside = true;
    for (int halving = 0; halving < HALVINGS; halving++) {
        float middle = 0.5 * (above + at);
        bool is_inside = depth_below_top(way, middle) >= 0.0;
        above = is_inside ? above : middle;
        at = is_inside ? middle : at;
    }
    return at;
}

const float NEARLY_HALF = 0.49;  // of a step, so that the last place tested is still above the ground
const float FEWEST_PARTS = 2.0, PARTS = 6.0;  // places tested on the path through grass, far away and nearby
const float LEAVES_ENOUGH = 3.0;  // optical depth behind which nothing is seen

// Opacity of the grass that a line of sight has entered: below 1 if it leaves the grass again before it is stopped. Then it has met the
// uncut leaves above the height at which it leaves.
float hidden_behind(Way way, float at, bool aside, ByKind area, float cut_height) {
    float slope = max(way.slope, FLATTEST), enters_at = height_over_ground(way, at), none = leaf_area_above(cut_height, area);
    float parts = clamp(way.pixels, FEWEST_PARTS, PARTS), step = enters_at / (slope * parts + TINY);
    float before = aside ? leaf_area_above(min(enters_at, cut_height), area) : none;
    for (float part = 1.0; part <= parts; part += 1.0) {
        float there = at + step * (part - 0.5);
        float met = (leaf_area_above(min(height_over_ground(way, there), cut_height), area) - before) / slope;
        if (met > LEAVES_ENOUGH)
            return 1.0;
        there += NEARLY_HALF * step;
        if (depth_below_top(way, there) < 0.0)  // over a crest, outlines give the opacity
            return height_over_ground(way, there) > way.high ? 1.0 : 1.0 - transmittance(max(met, 0.0));
    }
    return 1.0;
}

// The point of the line of sight through a place that is `way` [m] farther over the ground.
vec3 moved_along(vec3 place, float way) {
    vec3 ray = place - eye;
    return place + ray * (way / max(length(ray.xz), TINY));
}

// Depth of a place minus that of another.
float depth_beyond(vec3 place, vec3 other) {
    return window_depth(clip * vec4(place, 1.0)) - window_depth(clip * vec4(other, 1.0));
}
