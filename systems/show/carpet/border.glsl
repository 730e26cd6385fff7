// What stands on strips before the carpet, where the one gives way to the other.
#include "lib/shares.glsl"
#include "systems/around/appearance.py"
#include "systems/show/carpet/sight.glsl"

const float THIRD = 1.0 / 3.0, SMOOTH_ROOT = 0.4;  // the inverse of a smooth step near its begin, by powers of the root of a third of it
const float TOPS = 0.85;  // height up to which the leaf area falls off linearly, of the tallest tip's: as strips show it

// How high strips stand where the carpet has this share, of their full height: they rise first, and then it sinks. The share is a
// smooth step; this is where it is on its way, within 0.001 up to where strips are full grown.
float grown_by(float share) {
    float root_of = sqrt((1.0 - share) * THIRD), sunk = root_of * (1.0 + root_of * (THIRD + SMOOTH_ROOT * root_of));
    return smoothstep(0.0, 1.0, (SINKS + (1.0 - SINKS) * sunk) / GROWN);
}

// What a line of sight of this slope has come through above the carpet, which has this share: how much strips show there, in
// the mean, and the leaf area that stands on them, of the grass's. The carpet is so `tall` [m], and grass stands so high, of
// its height at rest.
vec2 come_through(vec2 place, float slope, float share, float tall, float stands) {
    const int PARTS = 3;
    float least = RAISED * share, shows = 0.0, leaves = 0.0, step = max(stands - least, 0.0) / float(PARTS);
    vec2 way = -heading_to(place) * (tall / (RAISED * max(slope, TINY)));
    for (int part = 0; part < PARTS; part++) {
        float above = step * (float(part) + 0.5);
        float there = share_at(ivec2(floor((place + way * above) * patches_a_metre)));
        shows += (1.0 - there) / float(PARTS);
        if (there < 1.0) {
            vec2 heights = least + vec2(above) + vec2(-0.5, 0.5) * step;
            vec2 under = max(1.0 - heights / (TOPS * stands * grown_by(there)), 0.0);
            leaves += under.x * under.x - under.y * under.y;
        }
    }
    return vec2(shows, leaves);
}
