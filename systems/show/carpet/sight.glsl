// Lines of sight that enter the grass of the carpet: how steep they are to the ground, how deep they come and what they meet.
#include "lib/canopy.glsl"
#include "lib/frame.glsl"
#include "systems/show/carpet/grow.py"
#include "systems/show/carpet/ground.py"

const float TINY = 1e-4;  // what no divisor is below [m], or [m/m]
const float CREST = 3.6;  // optical depth of a way over a crest, of a level one's as deep: as the reference shows it
const float RIM = 1.25;  // the same of a way over a rim
const float FARTHEST_SEEN = 15.0;  // how far behind where it enters the grass what it meets lies at most [m]
const float BULGES = 5e-4;  // curvature from which on ground counts as a crest [1/m]
const float EVEN = 1e-5;  // curvature that ground has at least [1/m]
const vec2 LEAVES_BEGIN = vec2(0.5, 2.0);  // how deep lines of sight come along an outline, and where they meet as much as on level ground
const float UPPER = 0.58;  // how much the upper part of a way through the grass counts: there most of it is met
const float BEFORE = 0.27;  // how far before the carpet lines of sight meet the first leaves, in heights over their slope
const float SPREAD = 0.17;  // how far before and behind the mean of what they meet it lies
const float THINNEST = 0.01;  // leaf area that grass has at least, for where it is met
const float THINNEST_LAYER = 1e-6;  // leaf area that a layer of it has at least
const float LEAST_MET = 0.004;  // of a kind, as a part of all that is: of less, nothing is seen
const float LEAST_HEADS = 1e-3;  // part of what is met of a kind that counts as heads at least, and as other leaves
const float LOWEST_GRASS = 0.01;  // how tall grass is at least [m]

const float NO_RIM = 500.0;  // what a line of sight meets, as past_rim has it, from which on it passes over no rim

uniform float outline;  // how high the carpet lies along an outline, of how high it lies elsewhere; 0 where that is the same

// How far below the top of the grass, of its height `tall` [m], a line of sight comes at most that enters it at this slope over
// a crest of this curvature [1/m].
float deepest(float slope, float crest, float tall) {
    return slope * slope / (2.0 * max(crest, EVEN) * max(tall, LOWEST_GRASS));
}

// How high a pixel is at a place [m].
float pixel_at(vec3 place) {
    return distance(place, eye) / pixels_a_metre();
}

// How far ground of this curvature counts as a crest, over which lines of sight pass.
float bulging(float crest) {
    return clamp(crest / BULGES, 0.0, 1.0);
}

// How far a line of sight that comes so deep passes over a crest there.
float along_outline(float deep, float crest) {
    return bulging(crest) * (1.0 - smoothstep(LEAVES_BEGIN.x, LEAVES_BEGIN.y, deep));
}

// How high the carpet lies where a line of sight comes so deep, of how high it lies on level ground. Over a crest lines of sight
// pass through: there it lies where leaves begin. Grass stands so high, of its height at rest.
float lifted(float deep, float crest, float stands) {
    return outline > 0.0 ? mix(1.0, outline * sqrt(stands), along_outline(deep, crest)) : 1.0;
}

// The slope on level ground of a line of sight that goes as far through the grass as one of this slope does over ground
// that bulges, or is hollow: from the top of the grass to the ground, or to where it comes nearest to it.
float level_slope(float slope, float crest, float share, float tall, float stands) {
    share *= lifted(deepest(slope, crest, tall * stands), crest, stands);
    vec2 way = 2.0 * crest * tall * vec2(max(stands / RAISED - share, 0.0), -share);
    way = sqrt(max(slope * abs(slope) + way, 0.0));
    return mix(way.y, way.x, UPPER) / stands;  // bent grass has less of its leaf area across the way
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

// How far along a line of sight what it meets spreads, for each height of the carpet, over the ground [m].
float along_ground(float slope, float tall) {
    return tall / max(slope, LOWEST);
}

// Where images are read for a place of the carpet, which lies so much lower than where no strips stand [m]: where its line of
// sight is as high as that. While the carpet rises where strips give way, what it shows stays where it is.
vec2 shows_at(vec2 place, vec2 heading, float lowered, float slope) {
    return place - heading * min(lowered / max(slope, LOWEST), FARTHEST_SEEN);
}

// Where a line of sight through a place is that has gone on so far over the ground [m].
vec3 gone_on(vec3 place, vec2 way) {
    vec3 ray = place - eye;
    return place + vec3(way.x, ray.y * dot(way, ray.xz) / max(dot(ray.xz, ray.xz), TINY), way.y);
}

// Where leaves are that are seen: the less densely they grow, the farther behind where a line of sight comes to the carpet.
vec3 seen_at(vec3 place, float slope, float tall, float dense) {
    float behind = (sqrt(max(slope, LOWEST) / max(dense, THINNEST)) - BEFORE) * along_ground(slope, tall);
    vec2 on = heading_to(place.xz) * clamp(behind, -FARTHEST_SEEN, FARTHEST_SEEN);
    return vec3(place.x + on.x, place.y, place.z + on.y);
}

// How far the ground that a game draws may be off this one's, up and down: 0.1 m, and 0.05 m by which cells of 4 m sag on a
// hilltop of 40 m radius. How many times that the carpet is taken to be above it, and how far before its own place at most [m].
const float HOSTS_OFF = 0.15, NEAREST_HOSTS = 1.2, MOST_NEARER = 25.0;

// Where a place so `high` over the ground is taken to be, before itself, for no ground to hide it that a game draws about as
// high as this one: where its line of sight, of this slope to the ground, is so high above that.
vec3 before_hosts(vec3 place, float high, float slope) {
    float off = max(NEAREST_HOSTS * HOSTS_OFF - high, 0.0);
    float over = max(slope, TINY) * distance(place.xz, eye.xz);  // how high the eye is above the ground there, as it rises
    return place + (eye - place) * min(off / max(over, off), min(MOST_NEARER / distance(place, eye), 0.5));
}
