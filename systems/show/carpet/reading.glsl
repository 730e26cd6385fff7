// Place and mip level at which the carpet's images are read: turned to the line of sight, stretched along it, and sheared as the wind
// bends the grass.
#include "lib/random.glsl"
#include "systems/show/carpet/lit.glsl"

uniform sampler2DArray images;  // Carpet.texels of grow.py
uniform float slopes[SLOPES];   // viewing slopes of the images
uniform ByKind first;           // by kind: first layer of the images
uniform ByKind coming;          // the same for what the kind is to become
uniform ivec3 stock;            // patch models; seed; coarsest level of the images

const float SHARP = 0.6;  // size of the footprint read for a pixel, relative to the pixel: filtering widens it
const vec2 LONGEST = vec2(0.25, 1.0);  // factors of that over a crest: least, and greatest
const vec2 ROOTS_SEEN = vec2(0.25, 0.9);  // viewing slopes between which the spacing of blades takes over from their length
const vec2 STEEP = vec2(0.05, 0.3);  // viewing slopes between which grass ceases to be seen from the side
const vec2 ABOVE = vec2(0.0, 2.0);  // viewing slopes between which it comes to be seen from above
const float GRAIN = 1.5;  // gain of contrast that makes up for filtering
const vec2 GRAIN_ABOVE = vec2(1.19, 2.3);  // the same from above, and from so far above that a pixel covers tufts
const float FILTERED = 0.4;  // mip level, below the finest, at which filtering begins to reduce contrast
const float ALIKE = 0.6;  // correlation of the two steepest images
const vec2 TUFTS = vec2(0.12, 0.4);  // widths of a pixel between which it comes to cover tufts [m]
const float EVENER = 0.15;  // loss of contrast of flat grass, from above
const float EVENER_ASIDE = 0.6;  // the same from the side
const float FEATURE = 0.3;  // height of features seen from the side, as a fraction of the grass's
const float TIPS = 1.7;  // displacement of tips, relative to that of the leaves that are seen
const float TOO_STEEP = 1.7;  // viewing slope from which on hardly any of the lean is seen
const float SHORTEST = 0.35;  // least projected length of blades that lean towards the eye, relative to rest
const float THINNEST_PIXEL = 1e-6;  // least width of a pixel, in patches

// What is constant over a patch.
struct Patch {
    ivec2 cell;
    int model;   // index of its patch model
    int side;    // index of the heading of its images
    vec3 blown;  // displacement of its leaves in the wind (x, z) [m]; their height, as a fraction of that at rest
};

const uint UPPER_HALF = 16u;  // of the random bits: it chooses the heading, the lower half the model

// Displacement of leaves per message of the wind, averaged over the kinds that are met [m].
float sway_of(ByKind met, vec2 message) {
    float sum = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        sum += OF(met, kind) * OF(crown, kind) * length(bending(kind, message));
    return SWAYS * sum / (max(total(met), TINY) * max(length(message), TINY));
}

// The patch of a place, with the sway of sway_of and the height `stands` relative to rest. One message of the wind counts for all of a
// patch: images sheared differently from place to place would curl.
Patch patch_at(vec2 at, float sway, float stands) {
    ivec2 cell = ivec2(floor(at * patches_per_metre));
    uint random_bits = hash3(stock.y, cell.x, cell.y);
    vec2 message = near_message_at((vec2(cell) + 0.5) * patch_side);
    return Patch(cell, int(random_bits % uint(stock.x)), int(random_bits >> UPPER_HALF) & (HEADINGS - 1), vec3(sway * message, stands));
}

// Rotation, as (cos, sin), that turns the line of sight into the heading of a patch's images, one of four. So blades are stretched along
// the line of sight from wherever they are seen.
vec2 image_turn(vec2 heading, int side) {
    vec2 image = (side & 1) == 0 ? -heading.yx : vec2(heading.x, -heading.y);
    return side < 2 ? image : -image;
}

vec2 rotated(vec2 v, vec2 by) {
    return vec2(by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y);
}

// The line of sight of a pixel.
struct Sight {
    vec2 heading;    // unit vector over the ground
    float slope;     // slope to the ground [m/m]
    float on_level;  // from level_slope
    float above;     // degree to which grass is seen from above, in [0, 1]
    float share;     // the carpet's share of the grass, in [0, 1]
    vec2 dx;         // offset over the ground to the next pixel across [m]
    vec2 dy;         // the same for the next pixel up [m]
};

// Shear of images along the line of sight, by which blades in them lean as grass does that the wind has `blown` (Patch). From straight
// above, where blades have no length, there is none: what is far from a patch's middle would swim.
vec2 image_shear(vec3 blown, float slope, float tall) {
    float steeper = slope * slope / (TOO_STEEP * TOO_STEEP), leant = 1.0 / (1.0 + steeper * steeper);
    return leant * TIPS * blown.xy * max(slope, LOWEST) / (max(tall, LOWEST_GRASS) * blown.z);
}

// An offset over the ground of leaning grass, in images of upright grass.
vec2 unsheared(vec2 way, vec2 heading, vec2 leans) {
    return way - leans * dot(way, heading) / max(1.0 + dot(leans, heading), SHORTEST);
}

// Texture coordinates and mip level in the images of two slopes.
struct Reading {
    int elevation;  // index of the first slope
    float blend;    // weight of the second
    vec2 low;       // coordinates in the first
    vec2 high;      // coordinates in the second
    float level;    // mip level
    float across;   // width of a pixel across the blades, in patches
};

// Fractional index of the viewing slope among `slopes`. At a low angle it is linear in the mean depth at which leaves are met, so that
// the mean of two images has that depth; from above, where leaves met go by the reciprocal of the slope, in the slope's logarithm.
float elevation_index(float slope, float leaf_area) {
    const int HIDES = 2;  // number of the lowest images, in which grass hides most of itself
    slope = max(slope, slopes[0]);
    int low = 0;
    for (int next = 1; next < SLOPES - 1; next++)
        low += int(slope > slopes[next]);
    vec3 of = vec3(slope, slopes[low], slopes[low + 1]), at = low < HIDES ? mean_depth_met(max(leaf_area, THINNEST) / of) : log(of);
    return float(low) + clamp((at.x - at.y) / (at.z - at.y), 0.0, 1.0);
}

// Coordinates and level for a place in the images of its patch, turned to the line of sight, at a fractional index of slopes.
Reading reading(Patch grass_patch, Sight sight, vec2 at, float tall, float elevation) {
    int low = min(int(elevation), SLOPES - 2);
    vec2 turn = image_turn(sight.heading, grass_patch.side);
    vec2 leans = image_shear(grass_patch.blown, sight.on_level, tall), beside = vec2(-sight.heading.y, sight.heading.x);
    vec2 here = unsheared((at - grass_patch.blown.xy) * patches_per_metre - vec2(grass_patch.cell) - 0.5, sight.heading, leans);
    // From the side, blades are stretched along the line of sight as at its own slope, not as at the slopes of the images.
    vec2 longer = max(sight.on_level, FLATTEST) / vec2(slopes[low], slopes[low + 1]) - 1.0;
    longer *= dot(here, sight.heading) * (1.0 - smoothstep(ROOTS_SEEN.x, ROOTS_SEEN.y, sight.on_level));
    // At a low angle a pixel's footprint is a long stripe of ground, but blades are stretched as far: its width across them counts. Mip
    // levels (levels.py) are means over its length.
    vec2 dx = unsheared(sight.dx, sight.heading, leans) * patches_per_metre;
    vec2 dy = unsheared(sight.dy, sight.heading, leans) * patches_per_metre;
    float across = max(max(abs(dot(dx, beside)), abs(dot(dy, beside))), THINNEST_PIXEL);
    // Over a crest a line of sight meets plants one by one, as on level ground.
    float finer = SHARP * clamp(sight.slope / max(sight.on_level, TINY), LONGEST.x, LONGEST.y);
    finer *= inversesqrt(max(1.0 + dot(leans, sight.heading), SHORTEST));
    float level = log2(across * finer * float(textureSize(images, 0).x));
    return Reading(low, elevation - float(low), rotated(here + sight.heading * longer.x, turn) + 0.5,
                   rotated(here + sight.heading * longer.y, turn) + 0.5, level, across);
}

// Gain of contrast about the mean of images. `stands` and `upright` are heights relative to rest: in the wind here, and of the patch.
float grain_scale(Reading read, Sight sight, float tall, float stands, float upright) {
    float steep = smoothstep(STEEP.x, STEEP.y, sight.slope);
    float tufts = smoothstep(TUFTS.x, TUFTS.y, read.across * patch_side);
    float filtered = clamp(log2(read.across * float(textureSize(images, 0).x)) + FILTERED, 0.0, 1.0);
    // Mixing two images lowers their variance, which is restored here (Heitz and Neyret, High-Performance By-Example Noise, 2018).
    // From the side they are uncorrelated; from above they show the same tufts.
    float alike = read.elevation < SLOPES - 2 ? 0.0 : ALIKE, other = 1.0 - read.blend;
    float mixed = read.blend * read.blend + other * other + 2.0 * alike * read.blend * other;
    float grain = mix(1.0, mix(GRAIN, mix(GRAIN_ABOVE.x, GRAIN_ABOVE.y, tufts), steep), filtered) * inversesqrt(mixed);
    grain *= 1.0 - max(EVENER * sight.above * (1.0 - stands) / LODGED, EVENER_ASIDE * (1.0 - sight.above) * (1.0 - upright));
    // Far away a pixel is higher than features of the grass, and averages several.
    return grain * mix(inversesqrt(1.0 + read.across * patch_side / (FEATURE * max(tall, LOWEST_GRASS))), 1.0, steep);
}
