// What a line of sight meets where it enters the grass of the carpet.
#include "lib/frame.glsl"

const float CREST = 3.6;  // leaves met over a crest, of those that a level line of sight as deep would meet: as the reference shows it
const float FARTHEST_SEEN = 15.0;  // how far behind where it enters the grass what it meets lies at most [m]
const float STEEP = 0.02;  // a line of sight counts as at least so steep, for how deep it goes

uniform float outline;  // how high the carpet lies along an outline, of how high it lies elsewhere; 0 where that is the same

// How far below the top of the grass, of its height `tall`, a line of sight comes at most that enters it at this slope: over
// a crest of this curvature it would have to be higher by so much.
float deepest(float slope, float crest, float tall) {
    return slope * slope / (2.0 * max(crest, 1e-5) * max(tall, 0.01));
}

const float BULGES = 5e-4;  // curvature from which on ground counts as a crest [1/m]

// How high the carpet lies where a line of sight comes so deep, of how high it lies on level ground: where lines of sight pass
// through, over a crest, it is where leaves begin, of grass that stands so high, of its height at rest.
float lifted(float deep, float crest, float stands) {
    float along = clamp(crest / BULGES, 0.0, 1.0) * (1.0 - smoothstep(0.5, 2.0, deep));
    return outline > 0.0 ? mix(1.0, outline * sqrt(stands), along) : 1.0;
}

// How deep in the grass what a line of sight meets is, of its height, that meets so many leaves: the mean of what is met of
// leaf area that falls off linearly with height, to 4 %.
vec3 depth_met(vec3 leaves) {
    leaves *= 1.273;
    return inversesqrt(sqrt(5.06 + leaves * leaves));
}

float depth_met(float leaves) {
    return depth_met(vec3(leaves)).x;
}

const float UPPER = 0.58;  // how much the upper part of a way through the grass counts: there most of it is met

// The slope on level ground of a line of sight that goes as far through the grass as one of this slope does over ground
// that bulges, or is hollow: from the top of the grass to the ground, or to where it comes nearest to it.
float level_slope(float slope, float crest, float share, float tall, float stands) {
    share *= lifted(deepest(slope, crest, tall * stands), crest, stands);
    vec2 way = 2.0 * crest * tall * vec2(max(stands / RAISED - share, 0.0), -share);
    way = sqrt(max(slope * abs(slope) + way, 0.0));
    return mix(way.y, way.x, UPPER) / stands;  // bent grass has less of its leaf area across the way
}

// Tangent of the angle between the line of sight and ground that rises by `rise` along x and z.
float viewing_slope(vec2 rise, vec3 place) {
    vec3 ray = place - eye;
    return (dot(rise, ray.xz) - ray.y) / max(length(ray.xz), 1e-4);
}

const float BEFORE = 0.27;  // how far before the carpet lines of sight meet the first leaves, in heights over their slope
const float SPREAD = 0.17;  // how far before and behind the mean of what they meet it lies

// How far along a line of sight what it meets spreads, for each height of the carpet, over the ground [m].
float along_ground(float slope, float tall) {
    return tall / max(slope, STEEP);
}

// Where leaves are that are seen: the less densely they grow, the farther behind where a line of sight comes to the carpet.
vec3 seen_at(vec3 place, float slope, float tall, float dense) {
    float behind = (sqrt(max(slope, STEEP) / max(dense, 0.01)) - BEFORE) * along_ground(slope, tall);
    vec2 on = normalize(place.xz - eye.xz + 1e-4) * clamp(behind, -FARTHEST_SEEN, FARTHEST_SEEN);
    return vec3(place.x + on.x, place.y, place.z + on.y);
}
