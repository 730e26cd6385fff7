// How high up nobody sees what stands on the ground: at a low angle, leaves before it hide it.
#include "lib/canopy.glsl"
#include "lib/mown.glsl"

const float HIDDEN = 3.0;  // leaves that a line of sight has met where the rest of its way is left out: 5 % comes through, down to dark roots
const float TRAIL = 0.5;  // how broad a trail may be, right before what is hidden, on which all grass lies [m]
const int AHEAD = 5;  // stretches of a line of sight, from the trail on, each twice as long as the one before it
const float MIDDLE = 1.5;  // how far off the middle of a stretch is, of how far off and long that is
const int HALVINGS = 5;  // steps in which the height is found

// What a line of sight meets half-way along a stretch: how far off that is, how high ground lies over the root, and leaves there.
struct Ahead {
    float away;
    float ground;
    ByKind area;
};

Ahead ahead_of(vec3 root, vec2 toward, float away) {
    vec2 place = root.xz + toward * away, on = (place - terrain_origin) / terrain_size;
    Ahead ahead = Ahead(away, height_filtered(place) - root.y, leaf_areas(density_at(place)));
    bool counts = all(lessThan(abs(on - 0.5), vec2(0.5))) && away < distance(root.xz, eye.xz);
    for (int group = 0; group < GROUPS; group++)
        ahead.area[group] *= counts ? 1.0 : 0.0;
    return ahead;
}

// Leaves that a line of sight has met that comes down to `high` over the root. Leaf area falls off linearly with height.
float met_before(Ahead stretches[AHEAD], float high, float slope, float stands) {
    float met = 0.0;
    for (int number = 0; number < AHEAD; number++) {
        Ahead one = stretches[number];
        float over = max(high + one.away * slope - one.ground, 0.0), each_metre = 0.0;
        for (int group = 0; group < GROUPS; group++) {
            vec4 tall = max(crown[group] * stands, LOWEST_CROWN);
            each_metre += dot(one.area[group], 2.0 * max(1.0 - over / tall, 0.0) / tall);
        }
        met += each_metre * one.away / MIDDLE;
    }
    return met;
}

// Up to which height [m] grass is hidden that roots there, is at most so `tall`, and stands so high, of its height at rest. Where
// any is cut, or is missing that the map knows of, nothing is.
float hidden_to(vec3 root, float tall, float stands) {
    if (anything_is_cut() || anything_open > 0.5)
        return 0.0;
    float away = max(distance(eye.xz, root.xz), TRAIL);
    Ahead stretches[AHEAD];
    for (int number = 0; number < AHEAD; number++)
        stretches[number] = ahead_of(root, (eye.xz - root.xz) / away, MIDDLE * TRAIL * exp2(float(number)));
    vec2 between = vec2(0.0, tall);
    for (int halving = 0; halving < HALVINGS; halving++) {
        float middle = 0.5 * (between.x + between.y);
        if (met_before(stretches, middle, (eye.y - root.y - middle) / away, stands) > HIDDEN)
            between.x = middle;
        else
            between.y = middle;
    }
    return between.x;
}
