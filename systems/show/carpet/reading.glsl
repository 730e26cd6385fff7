// Where and how finely the carpet's images are read: turned to the line of sight, drawn out along it, and sheared as the wind
// bends the grass.
#include "lib/random.glsl"
#include "systems/show/carpet/lit.glsl"

uniform sampler2DArray images;  // place along the blade, height, twice the azimuth (or what is an eye's), coverage; premultiplied
uniform float slopes[SLOPES];   // their viewing slopes
uniform ByKind first;           // by kind: first layer of the images
uniform ByKind coming;          // the same of what it is to be
uniform ivec3 stock;            // patch models; seed; coarsest level of the images

const float SHARP = 0.6;  // size of what is taken from the images for a pixel, of the pixel's own: filtering takes more
const vec2 LONGEST = vec2(0.25, 1.0);  // how much finer that is over a crest: at most, and at least
const vec2 ROOTS_SEEN = vec2(0.25, 0.9);  // viewing slopes from which on it is seen how far apart blades stand, and that alone
const vec2 STEEP = vec2(0.05, 0.3);  // viewing slopes from which on grass is seen from the side hardly, and not
const vec2 ABOVE = vec2(0.0, 2.0);  // from which on it is seen from above a little, and wholly
const float GRAIN = 1.5;  // how far images are from their mean, for what filtering takes away
const vec2 GRAIN_ABOVE = vec2(1.19, 2.3);  // the same from above, and from so far that a pixel takes in whole tufts
const float FILTERED = 0.4;  // level of the mip-maps at which filtering begins to take grain away, below the finest
const float ALIKE = 0.6;  // how the two steepest images correlate
const vec2 TUFTS = vec2(0.12, 0.4);  // breadths of a pixel from which on it takes in tufts, and whole ones [m]
const float EVENER = 0.15;  // from above, how much less uneven grass is that lies
const float EVENER_ASIDE = 0.6;  // the same from the side
const float FEATURE = 0.3;  // height of what can be told apart in the grass from the side, of the grass's
const float TIPS = 1.7;  // how far bent grass moves its tips, of how far it moves the leaves that are seen
const float TOO_STEEP = 1.7;  // viewing slope from which on hardly any of it is seen
const float SHORTEST = 0.35;  // blades that lean towards the eye are so long at least, of how long they are seen at rest
const float THINNEST_PIXEL = 1e-6;  // breadth that a pixel has at least, in patches

// What is the same all over a patch.
struct Patch {
    ivec2 cell;
    int model;   // which of the patch models grows there
    int side;    // which of the four headings' images are taken
    vec3 blown;  // how far its leaves are moved that the wind bends [m], and how high they stand, of their height at rest
};

const uint UPPER_HALF = 16u;  // of what is drawn: where the lower one draws the model, it draws the heading

// How far leaves sway that a message moves, in the mean over the kinds that are met: of the message [m].
float sway_of(ByKind met, vec2 message) {
    float sum = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        sum += OF(met, kind) * OF(crown, kind) * length(bending(kind, message));
    return SWAYS * sum / (max(total(met), TINY) * max(length(message), TINY));
}

// The patch of a place whose leaves sway so far, of the wind's message [m], and stand so high, of their height at rest. It is
// one wind for all of a patch: images that are sheared here and there otherwise would curl.
Patch patch_at(vec2 at, float sway, float stands) {
    ivec2 cell = ivec2(floor(at * patches_per_metre));
    uint drawn = hash3(stock.y, cell.x, cell.y);
    vec2 message = message_at((vec2(cell) + 0.5) * patch_side);
    return Patch(cell, int(drawn % uint(stock.x)), int(drawn >> UPPER_HALF) & (HEADINGS - 1), vec3(sway * message, stands));
}

// The rotation that turns the line of sight into the heading of the images that are taken: of four headings, one on each
// patch. So blades are drawn out along the line of sight, from wherever they are seen.
vec2 turned(vec2 heading, int side) {
    vec2 image = (side & 1) == 0 ? -heading.yx : vec2(heading.x, -heading.y);
    return side < 2 ? image : -image;
}

vec2 rotated(vec2 v, vec2 by) {
    return vec2(by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y);
}

// The line of sight of a pixel.
struct Sight {
    vec2 heading;    // over the ground
    float slope;     // to the ground
    float on_level;  // that of one on level ground which goes as far through the grass: of level_slope
    float above;     // how far grass is seen from above
    float share;     // how much of what is seen is carpet's
    vec2 dx;         // the way over the ground to the next pixel across,
    vec2 dy;         // and up [m]
};

// How images of grass at rest are sheared along the line of sight for blades in them to lean as grass does that the wind has
// `blown` so. From straight above, where blades have no length in them, they are not: what is far from a patch's middle would swim.
vec2 sheared(vec3 blown, float slope, float tall) {
    float steeper = slope * slope / (TOO_STEEP * TOO_STEEP), leant = 1.0 / (1.0 + steeper * steeper);
    return leant * TIPS * blown.xy * max(slope, LOWEST) / (max(tall, LOWEST_GRASS) * blown.z);
}

// A way over the ground, as images have it in which blades stand upright that lean so.
vec2 leant_back(vec2 way, vec2 heading, vec2 leans) {
    return way - leans * dot(way, heading) / max(1.0 + dot(leans, heading), SHORTEST);
}

// Where in the images of two slopes something is, and how finely they are read.
struct Reading {
    int elevation;  // the first of the two
    float next;     // how far the line of sight is on the way to the second
    vec2 low;       // where in the first
    vec2 high;      // where in the second
    float level;    // of the mip-maps
    float across;   // how broad a pixel is across its blades, in patches
};

// Which of the viewing elevations' images a ray sees: the number of the first of two, plus how far it is on the way to the next.
// At a low angle the way is told by how deep in the grass what it meets is in the mean, so that the mean of two images is as
// deep; from above, where it meets leaves as the reciprocal of its slope, by the slope's logarithm.
float elevation_seen(float slope, float leaf_area) {
    const int HIDES = 2;  // so many of the lowest images show grass that hides most of itself
    slope = max(slope, slopes[0]);
    int low = 0;
    for (int next = 1; next < SLOPES - 1; next++)
        low += int(slope > slopes[next]);
    vec3 of = vec3(slope, slopes[low], slopes[low + 1]), at = low < HIDES ? mean_depth_met(max(leaf_area, THINNEST) / of) : log(of);
    return float(low) + clamp((at.x - at.y) / (at.z - at.y), 0.0, 1.0);
}

// What is read of the images of a patch, those of an elevation, turned to the line of sight.
Reading reading(Patch own, Sight sight, vec2 at, float tall, float elevation) {
    int low = min(int(elevation), SLOPES - 2);
    vec2 turn = turned(sight.heading, own.side);
    vec2 leans = sheared(own.blown, sight.on_level, tall), beside = vec2(-sight.heading.y, sight.heading.x);
    vec2 here = leant_back((at - own.blown.xy) * patches_per_metre - vec2(own.cell) - 0.5, sight.heading, leans);
    // From the side blades are drawn out along the line of sight as they are seen, and not as at the slopes of the images.
    vec2 longer = max(sight.on_level, FLATTEST) / vec2(slopes[low], slopes[low + 1]) - 1.0;
    longer *= dot(here, sight.heading) * (1.0 - smoothstep(ROOTS_SEEN.x, ROOTS_SEEN.y, sight.on_level));
    // From a low angle a pixel is a long stripe of ground, but blades are drawn out as far: what counts is how broad it is
    // across them.
    vec2 dx = leant_back(sight.dx, sight.heading, leans) * patches_per_metre, dy = leant_back(sight.dy, sight.heading, leans) * patches_per_metre;
    float across = max(max(abs(dot(dx, beside)), abs(dot(dy, beside))), THINNEST_PIXEL);
    // Over a crest a line of sight meets plants one by one, as on level ground.
    float finer = SHARP * clamp(sight.slope / max(sight.on_level, TINY), LONGEST.x, LONGEST.y);
    finer *= inversesqrt(max(1.0 + dot(leans, sight.heading), SHORTEST));
    float level = log2(across * finer * float(textureSize(images, 0).x));
    return Reading(low, elevation - float(low), rotated(here + sight.heading * longer.x, turn) + 0.5,
                   rotated(here + sight.heading * longer.y, turn) + 0.5, level, across);
}

// How far what is read is from its mean, of how far it is in images, of grass that stands so high, of its height at rest.
float grain_of(Reading read, Sight sight, float tall, float stands, float upright) {
    float steep = smoothstep(STEEP.x, STEEP.y, sight.slope);
    float tufts = smoothstep(TUFTS.x, TUFTS.y, read.across * patch_side);
    float filtered = clamp(log2(read.across * float(textureSize(images, 0).x)) + FILTERED, 0.0, 1.0);
    // Two images are flatter once they are mixed: as much is put back (Heitz and Neyret, High-Performance By-Example Noise,
    // 2018). From the side they have nothing to do with one another; from above they show the same tufts.
    float alike = read.elevation < SLOPES - 2 ? 0.0 : ALIKE, other = 1.0 - read.next;
    float mixed = read.next * read.next + other * other + 2.0 * alike * read.next * other;
    float grain = mix(1.0, mix(GRAIN, mix(GRAIN_ABOVE.x, GRAIN_ABOVE.y, tufts), steep), filtered) * inversesqrt(mixed);
    grain *= 1.0 - max(EVENER * sight.above * (1.0 - stands) / LODGED, EVENER_ASIDE * (1.0 - sight.above) * (1.0 - upright));
    // Far away a pixel is higher than what can be told apart in the grass: it is the mean of several.
    return grain * mix(inversesqrt(1.0 + read.across * patch_side / (FEATURE * max(tall, LOWEST_GRASS))), 1.0, steep);
}
