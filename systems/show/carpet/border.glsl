// What lines of sight meet on strips before the carpet, where strips give way to the carpet.
#include "lib/shares.glsl"
#include "systems/around/appearance.py"
#include "systems/show/carpet/sight.glsl"

const float THIRD = 1.0 / 3.0, SMOOTH_ROOT = 0.4;  // inverse of smoothstep near 0: a series in the root of a third of its value
const float TOPS = 0.85;  // height at which a linear profile of leaf area ends, relative to the tallest tip: as strips show it

// Height of strips where the carpet has this share, as a fraction of their full height: strips rise first, then the carpet sinks. The
// share is a smoothstep of progress, which is recovered within 0.001 up to where strips are fully grown.
float strip_growth(float share) {
    float root_of = sqrt((1.0 - share) * THIRD), sunk = root_of * (1.0 + root_of * (THIRD + SMOOTH_ROOT * root_of));
    return smoothstep(0.0, 1.0, (SINKS + (1.0 - SINKS) * sunk) / GROWN);
}

// What a line of sight meets on strips above the carpet: their mean share, and their leaf area as a fraction of the grass's. `share` is
// the carpet's share at its own place, `tall` its height [m], `stands` the height of the grass relative to rest.
vec2 strips_met(vec2 place, float slope, float share, float tall, float stands) {
    const int PARTS = 3;
    float least = RAISED * share, shows = 0.0, leaves = 0.0, step = max(stands - least, 0.0) / float(PARTS);
    vec2 way = -heading_to(place) * (tall / (RAISED * max(slope, TINY)));
    for (int part = 0; part < PARTS; part++) {
        float above = step * (float(part) + 0.5);
        float there = share_at(ivec2(floor((place + way * above) * patches_per_metre)));
        shows += (1.0 - there) / float(PARTS);
        if (there < 1.0) {
            vec2 heights = least + vec2(above) + vec2(-0.5, 0.5) * step;
            vec2 under = max(1.0 - heights / (TOPS * stands * strip_growth(there)), 0.0);
            leaves += under.x * under.x - under.y * under.y;
        }
    }
    return vec2(shows, leaves);
}
