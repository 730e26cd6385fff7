// Outlines: where the carpet ends against what is behind a crest.
#include "systems/show/carpet/sight.glsl"

const float SPIKES = 18.0;  // how much more leaves are met along an outline where taller plants stand
const float TALLER = 0.05;  // how much taller plants count at most, of the mean
const vec2 SPIKES_FROM = vec2(0.8, 1.0);  // shares of the carpet from which on they do: where it sinks, they would swim
const float SHOWN_FROM = 1.0 / 3.0;  // share from which on an outline hides nothing more of its own grass
const float STANDING = 0.9;  // how much it covers at least of what is behind, where strips have just begun to give way
const float NOTHING = 0.004;  // a pixel that covers less shows nothing, in 8 bits
const float LEAST_COVER = 0.05;  // what is seen of grass over a crest stands for all of it where it covers so much at least
const vec2 ENDS = vec2(0.5, 1.5);  // how deep lines of sight come, of the carpet's share, where grass behind is seen, and ground
const float HALF = 0.5;
const float WHOLE = 0.999;    // and one that covers more all

// How much of what is behind an outline the grass hides. A line of sight that passes `deep` below the top of the grass,
// whose leaf area falls off linearly with height, meets leaves of deep^2 times the whole.
float outline_cover(float slope, float crest, float tall, float stands, float dense, float stands_out) {
    slope = max(slope, TINY);
    float deep = deepest(slope, crest, tall * stands);
    float hidden = 1.0 - comes_through(CREST * dense / slope * stands_out * deep * deep);
    return mix(1.0, hidden, smoothstep(0.0, 2.0 * LOWEST_GRASS, tall));  // bare ground is its own outline
}

// How steeply the carpet rises along the line of sight where taller grass begins: there it is seen, though the ground falls
// away behind a crest.
float rises_ahead(vec2 at, float tall) {
    vec2 dx = dFdx(at), dy = dFdy(at), to = heading_to(at), rises = vec2(dFdx(tall), dFdy(tall));
    vec2 way = dot(dx, dx) > dot(dy, dy) ? vec2(dot(dx, to), rises.x) : vec2(dot(dy, to), rises.y);
    return max(way.y * sign(way.x) / max(abs(way.x), TINY), 0.0);
}

// How much more leaves are met there of plants that are so much taller than the mean.
float standing_out(float taller, float share) {
    float spikes = SPIKES * clamp((share - SPIKES_FROM.x) / (SPIKES_FROM.y - SPIKES_FROM.x), 0.0, 1.0);
    return exp(spikes * clamp(taller, -TALLER, TALLER));
}
