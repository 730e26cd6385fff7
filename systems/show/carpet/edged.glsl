// Where lines of sight enter grass that ends or has been cut: the mesh is too coarse for its edges. The carpet's mesh lies
// where whole grass would be, and pixels look along the line of sight for where it comes to what stands.
#include "lib/mown.glsl"
#include "lib/canopy.glsl"
#include "lib/terrain.glsl"
#include "systems/show/carpet/sight.glsl"

uniform ByKind raised; // by kind: height of the carpet above the ground [m]

const float STEPS = 16.0;      // places looked at on the way to level ground at most
const float MOST_STEPS = 32.0, LONGER = 1.12;  // where ground falls away from it: how many at most, and by how much each is longer then
const float OUT_OF_IT = 1.5;   // so high above the mesh it has come out of the grass over a crest, of the mesh's height
const float SHORTEST_STEP = 0.08;  // way over the ground between two of them at least [m]
const int HALVINGS = 3;        // of the last step, to the edge
const float FARTHEST_ENTERED = 40.0;  // way over the ground that is looked along at most [m]
const float NO_GRASS = 0.004;  // height of the carpet up to which there is none [m]
const float ROUNDED = 1e-3;    // what of the mesh's height is taken for rounding

// The height of the carpet over the ground where grass grows so and is left so high [m].
float carpet_high(ByKind grows, float left) {
    float high = 0.0;
    for (int group = 0; group < GROUPS; group++)
        high += dot(grows[group], min(raised[group], left));
    return high / max(total(grows), 1.0);
}

float left_here(vec2 place) {
    return anything_is_cut() ? left_at(place) : tallest_grass;
}

// A line of sight from the mesh on, over the ground.
struct Way {
    vec3 from;
    vec2 heading;
    float falls;   // by how much it goes down a metre [m/m]
    float ground;  // how high it begins over a ground that is by as much higher than the terrain as the mesh is there [m]
    float high;    // how high the mesh lies over the ground [m]
    float raises;  // and of how high the carpet is on level ground
    float slope;   // of the line of sight to the ground
    float curvature;   // how fast the rise of the ground falls off along it [1/m]
    float pixels;  // how high whole grass is in the picture: so many places on the way are told apart
};

Way way_from(vec3 place, float high, float raises, float slope, float curvature) {
    vec3 ray = place - eye;
    float pixels = ceil(high * pixels_a_metre() / length(ray)), ground = high - place.y + height_near(place.xz);
    return Way(place, heading_to(place.xz), -ray.y / max(length(ray.xz), TINY), ground, high, raises, slope, curvature, pixels);
}

// How far over the ground it goes on until it comes to that, or is past where it comes nearest to it over a crest [m].
float to_ground(Way way) {
    float slope = max(way.slope, FLATTEST), turns = slope * slope - 2.0 * way.curvature * way.high;
    return 2.0 * way.high / (slope + sqrt(max(turns, 0.0)));
}

// How high it is over the ground, so far on [m].
float over_ground(Way way, float at) {
    vec2 there = way.from.xz + way.heading * at;
    return way.from.y - way.falls * at - height_near(there) + way.ground;
}

// How far it is below the top of the grass, so far over the ground [m]; below 0 over it, and where none stands.
float below_top(Way way, float at) {
    vec2 there = way.from.xz + way.heading * at;
    float stands = way.raises * carpet_high(grows_at(there), left_here(there));
    return stands > NO_GRASS ? stands - over_ground(way, at) + ROUNDED * way.high : -1.0;
}

// How far over the ground it goes on until it comes to grass [m], below 0 where it comes to none; whether it does so from the side.
float enters(Way way, out bool aside) {
    float most = min(to_ground(way), FARTHEST_ENTERED), step = most / clamp(min(ceil(most / SHORTEST_STEP), way.pixels), 1.0, STEPS);
    float at = 0.0, below, number = 0.0, high = way.high;
    aside = false;
    while ((below = below_top(way, at)) < 0.0) {
        if (++number > MOST_STEPS || at >= FARTHEST_ENTERED || high <= 0.0 || high >= OUT_OF_IT * way.high)
            return -1.0;
        step *= number > STEPS ? LONGER : 1.0;
        at += step;
        high = over_ground(way, at);
    }
    // On even grass it came from above; at an edge it comes in from the side.
    float outside = max(at - step, 0.0), above = clamp(at - below / max(way.slope, FLATTEST), outside, at);
    if (below_top(way, above) >= -ROUNDED * way.high)
        return above;
    aside = true;
    for (int halving = 0; halving < HALVINGS; halving++) {
        float middle = 0.5 * (above + at);
        bool is_inside = below_top(way, middle) >= 0.0;
        above = is_inside ? above : middle;
        at = is_inside ? middle : at;
    }
    return at;
}

const float NEARLY_HALF = 0.49;  // of a step: so the last place looked at is still above the ground
const float FEWEST_PARTS = 2.0, PARTS = 6.0;  // places looked at on the way through grass, up to where it comes out, far off and near by
const float LEAVES_ENOUGH = 3.0;  // leaves that a line of sight meets until nothing is seen behind them

// How much is hidden of what lies behind grass that a line of sight has come to: less where it comes out again before it is
// stopped. It has met the leaves above the height where it comes out, of those that are left.
float hidden_behind(Way way, float at, bool aside, ByKind area, float left) {
    float slope = max(way.slope, FLATTEST), enters_at = over_ground(way, at), none = leaves_above(left, area);
    float parts = clamp(way.pixels, FEWEST_PARTS, PARTS), step = enters_at / (slope * parts + TINY);
    float before = aside ? leaves_above(min(enters_at, left), area) : none;
    for (float part = 1.0; part <= parts; part += 1.0) {
        float there = at + step * (part - 0.5), met = (leaves_above(min(over_ground(way, there), left), area) - before) / slope;
        if (met > LEAVES_ENOUGH)
            return 1.0;
        there += NEARLY_HALF * step;
        if (below_top(way, there) < 0.0)  // over a crest, outlines say how much is hidden
            return over_ground(way, there) > way.high ? 1.0 : 1.0 - comes_through(max(met, 0.0));
    }
    return 1.0;
}

// A place so much farther over the ground on the line of sight.
vec3 farther(vec3 place, float way) {
    vec3 ray = place - eye;
    return place + ray * (way / max(length(ray.xz), TINY));
}

// The depth of one place, by how much it is more than another's.
float deeper(vec3 place, vec3 other) {
    return depth_of(clip * vec4(place, 1.0)) - depth_of(clip * vec4(other, 1.0));
}
