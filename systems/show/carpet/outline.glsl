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

const float HIGHER = 0.4;  // how much higher it counts along an outline, which is thin in the pixels that it ends in: the mesh lies half of one [pixels]
const vec4 IN_PIXEL = vec4(-0.375, -0.125, 0.125, 0.375);  // where lines of sight pass that stand for all of a pixel, of its height
const float LINES_IN_PIXEL = 4.0;  // how many these are
const float ENOUGH = 2.8;  // leaves that are met in the mean where taller plants make no difference
const float OPAQUE = 12.0;  // optical depth of bare ground, which is its own outline

// How much higher that is for a crest of this curvature, in pixels so high [m]: on a game's own ground the edge has none behind it.
float counts_higher(float curvature, float pixel) {
#ifdef EDGED
    return 0.0;
#else
    return over_hosts > 0.0 ? 0.0 : HIGHER * crest_amount(curvature) * pixel;
#endif
}

// How many leaves lines of sight meet over a crest, in the parts of a pixel so high [m]. One that passes `deep` below the top of the
// grass, whose leaf area falls off linearly with height, meets deep^2 of the whole over a way that goes by the root of how deep it
// passes.
vec4 met_over(float slope, float curvature, float tall, float stands, float leaf_area, float pixel) {
    float curved = 2.0 * max(curvature, LEAST_CURVATURE), high = max(tall * stands, LOWEST_GRASS);
    float leaves = CREST * leaf_area * inversesqrt(curved) / (high * high);
    vec4 all = max(slope * abs(slope) / curved + IN_PIXEL * pixel - counts_higher(curvature, pixel), 0.0);
    return leaves * all * sqrt(all) + OPAQUE * max(1.0 - tall / (2.0 * LOWEST_GRASS), 0.0);
}

// How much of what is behind an outline the grass hides that lines of sight meet, in the mean over a pixel.
float outline_cover(vec4 met) {
    return 1.0 - dot(comes_through(met), vec4(1.0)) / LINES_IN_PIXEL;
}

// The slope at which a line of sight of some slope would come to the mesh if it were no higher along an outline.
float slope_below(float slope, float curvature, float pixel) {
    return slope > 0.0 ? sqrt(max(slope * slope - 2.0 * curvature * counts_higher(curvature, pixel), 0.0)) : slope;
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
