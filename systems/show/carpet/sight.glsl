// Lines of sight that enter the grass of the carpet: their slope to the ground, their depth in the grass, and what they meet.
#include "lib/canopy.glsl"
#include "lib/frame.glsl"
#include "systems/show/carpet/grow.py"
#include "systems/show/carpet/ground.py"

const float TINY = 1e-4;  // least divisor [m], or [m/m]
const float CREST = 3.6;  // optical depth of a path over a crest, relative to a level path as deep: matches the reference
const float RIM = 1.25;  // the same over a rim
const float FARTHEST_SEEN = 15.0;  // largest distance from where a line of sight enters the grass to what it meets [m]
const float CREST_CURVATURE = 5e-4;  // curvature from which on ground counts fully as a crest [1/m]
const float LEAST_CURVATURE = 1e-5;  // least curvature that divides [1/m]
const vec2 LEAVES_BEGIN = vec2(0.5, 2.0);  // depths of lines of sight at an outline, and where they meet as much as on level ground
const float UPPER = 0.58;  // weight of the upper part of a path through the grass, where most leaves are met
const float BEFORE = 0.27;  // distance before the carpet at which lines of sight meet the first leaves, in heights over slope
const float THINNEST = 0.01;  // least leaf area index for finding where leaves are met
const float THINNEST_LAYER = 1e-6;  // least leaf area index of a layer
const float LEAST_MET = 0.004;  // least share of a kind in what is met that is drawn
const float LEAST_HEADS = 1e-3;  // least share of heads, and of other leaves, in what is met of a kind
const float LOWEST_GRASS = 0.01;  // least height of grass [m]

const float OPAQUE = 12.0;  // optical depth of bare ground, which is its own outline
const float HIGHER = 0.3;  // depth of an outline below the mesh, which is raised by half a pixel [pixels]: as high as that of every blade
const vec4 IN_PIXEL = vec4(-0.375, -0.125, 0.125, 0.375);  // lines of sight that sample a pixel, as fractions of its height

const float SPIKES = 18.0;  // exponential growth of the leaves met along an outline, for each 1 of `taller`
const float TALLER = 0.05;  // largest relative height of taller plants that counts
const vec2 ENDS = vec2(0.5, 1.5);  // greatest depths, relative to the carpet's share, of lines of sight that see grass behind, and ground

const float NO_RIM = 500.0;  // value of rim_path_at from which on a line of sight passes over no rim

// Greatest depth that a line of sight reaches below the top of the grass, as a fraction of its height `tall` [m], where it enters at
// this slope over ground of this curvature [1/m].
float deepest(float slope, float curvature, float tall) {
    return slope * slope / (2.0 * max(curvature, LEAST_CURVATURE) * max(tall, LOWEST_GRASS));
}

// Degree to which ground of this curvature counts as a crest, in [0, 1].
float crest_amount(float curvature) {
    return clamp(curvature / CREST_CURVATURE, 0.0, 1.0);
}

// Raise of an outline over a crest [m], for pixels of this height [m]: none on a game's own ground, where nothing is behind the edge.
float outline_raise(float curvature, float pixel) {
#ifdef EDGED
    return 0.0;
#else
    return over_hosts > 0.0 ? 0.0 : HIGHER * crest_amount(curvature) * pixel;
#endif
}

// Depth below the mesh, not raised, from which on all lines of sight of a pixel of this height [m] pass below an outline [m].
float outline_fade(float pixel) {
    return (IN_PIXEL.w - (0.5 - HIGHER)) * pixel;
}

// Degree to which a line of sight with this greatest depth passes over a crest, in [0, 1].
float crest_weight(float deep, float curvature) {
    return crest_amount(curvature) * (1.0 - smoothstep(LEAVES_BEGIN.x, LEAVES_BEGIN.y, deep));
}

// Height of the carpet, as a fraction of that on level ground, for a line of sight with this greatest depth. Over a crest, where lines
// of sight pass through the grass, the carpet lies at the first leaves. `stands` is the height of the grass relative to rest.
float carpet_lift(float deep, float curvature, float stands) {
    return mix(1.0, HIGHER_OUTLINE * sqrt(stands), crest_weight(deep, curvature));
}

// Slope of a line of sight on level ground whose path through the grass is as long as that at this slope over curved ground: from
// the top of the grass to the ground, or to the point nearest to it.
float level_slope(float slope, float curvature, float share, float tall, float stands) {
    share *= carpet_lift(deepest(slope, curvature, tall * stands), curvature, stands);
    vec2 way = 2.0 * curvature * tall * vec2(max(stands / RAISED - share, 0.0), -share);
    way = sqrt(max(slope * abs(slope) + way, 0.0));
    return mix(way.y, way.x, UPPER) / stands;  // bent grass has less of its leaf area across the path
}

// The unit vector over the ground from the eye to a place.
vec2 heading_to(vec2 place) {
    return normalize(place - eye.xz + TINY);
}

// Tangent of the angle between the line of sight and ground that rises by `rise` along x and z.
float viewing_slope(vec2 rise, vec3 place) {
    vec3 ray = place - eye;
    return (dot(rise, ray.xz) - ray.y) / max(length(ray.xz), TINY);
}

// Distance over the ground in which a line of sight falls by the height of the carpet [m].
float ground_spread(float slope, float tall) {
    return tall / max(slope, LOWEST);
}

// Place at which images are read for a place of the carpet, which lies `lowered` [m] below its height without strips: where the line
// of sight has that height. So what the carpet shows keeps its place in the picture while it rises.
vec2 image_place(vec2 place, vec2 heading, float lowered, float slope) {
    return place - heading * min(lowered / max(slope, LOWEST), FARTHEST_SEEN);
}

// The point of the line of sight through a place that is `way` (x, z) farther over the ground [m].
vec3 moved_along(vec3 place, vec2 way) {
    vec3 ray = place - eye;
    return place + vec3(way.x, ray.y * dot(way, ray.xz) / max(dot(ray.xz, ray.xz), TINY), way.y);
}

// Mean place of the leaves that are seen: the thinner the grass, the farther behind the place on the carpet.
vec3 leaf_place(vec3 place, float slope, float tall, float leaf_area) {
    float behind = (sqrt(max(slope, LOWEST) / max(leaf_area, THINNEST)) - BEFORE) * ground_spread(slope, tall);
    vec2 on = heading_to(place.xz) * clamp(behind, -FARTHEST_SEEN, FARTHEST_SEEN);
    return vec3(place.x + on.x, place.y, place.z + on.y);
}

// HOSTS_OFF: largest height difference between a game's own ground and this one [m]: 0.1 m, and 0.05 m by which cells of 4 m sag on a
// hilltop of 40 m radius. NEAREST_HOSTS: least height over this ground that the carpet's depth has, in HOSTS_OFF. MOST_NEARER: largest
// shift of its depth towards the eye [m].
const float HOSTS_OFF = 0.15, NEAREST_HOSTS = 1.2, MOST_NEARER = 25.0;

// The point on the line of sight whose depth a place `high` [m] over the ground takes, so that a game's own ground, which is about as
// high as this one, does not hide it. `slope` is that of the line of sight to the ground. The smaller the carpet's `share`, the nearer
// it stays to its own place: else it would hide the strips that stand there, and show the game's ground in a line.
vec3 before_hosts(vec3 place, float high, float slope, float share) {
    float off = max(NEAREST_HOSTS * HOSTS_OFF - high, 0.0);
    float over = max(slope, TINY) * distance(place.xz, eye.xz);  // height of the eye above the plane of the ground there
    return place + (eye - place) * (share * min(off / max(over, off), min(MOST_NEARER / distance(place, eye), 0.5)));
}
