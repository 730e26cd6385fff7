// Where and how finely the carpet's images are read: turned to the line of sight, drawn out along it, and sheared as the wind
// bends the grass.

// The rotation that turns the line of sight into the heading of the images that are taken: of four headings, one on each
// patch. So blades are drawn out along the line of sight, from wherever they are seen.
vec2 turned(vec2 heading, int side) {
    vec2 image = side == 0 ? vec2(0.0, -1.0) : side == 1 ? vec2(1.0, 0.0) : side == 2 ? vec2(0.0, 1.0) : vec2(-1.0, 0.0);
    return vec2(dot(image, heading), image.y * heading.x - image.x * heading.y);
}

vec2 rotated(vec2 v, vec2 by) {
    return vec2(by.x * v.x - by.y * v.y, by.y * v.x + by.x * v.y);
}

const float SHARP = 0.6;        // size of what is taken from the images for a pixel, of the pixel's own: filtering takes more than it
const float FLATTEST = 0.005;   // a line of sight counts as at least so steep, for how far blades are drawn out along it
const vec2 ROOTS_SEEN = vec2(0.25, 0.9);  // viewing slopes from which on it is seen how far apart blades stand, and that alone
const float GRAIN = 1.5;        // how far images are from their mean, for what filtering takes away
const vec2 GRAIN_ABOVE = vec2(1.19, 2.3);  // the same from above, and from so far that a pixel takes in whole tufts
const float ALIKE = 0.6;        // how the two steepest images correlate
const vec2 TUFTS = vec2(0.12, 0.4);  // breadths of a pixel from which on it takes in tufts, and whole ones [m]
const float EVENER = 0.15;      // from above, how much less uneven grass is that lies
const float EVENER_ASIDE = 0.6; // the same from the side
const float FEATURE = 0.3;      // height of what can be told apart in the grass from the side, of the grass's

// How far the leaves of a patch are moved that the wind bends [m], and how high they stand, of their height at rest. It is one
// wind for all of a patch: images that are sheared here and there otherwise would curl.
vec3 blown_on(ivec2 cell) {
    vec2 message = message_at((vec2(cell) + 0.5) * patch_side);
    vec3 sum = vec3(0.0);
    for (int kind = 0; kind < KINDS; kind++) {
        vec2 bend = bending(kind, message);
        sum += OF(met, kind) * vec3(SWAYS * OF(crown, kind) * bend, lodged(bend));
    }
    return total(met) > 1e-3 ? sum / total(met) : vec3(0.0, 0.0, 1.0);
}

const float TIPS = 1.7;      // how far bent grass moves its tips, of how far it moves the leaves that are seen
const float TOO_STEEP = 1.7; // viewing slope from which on hardly any of it is seen
const float SHORTEST = 0.35; // blades that lean towards the eye are so long at least, of how long they are seen at rest

// How images of grass at rest are sheared along the line of sight for blades in them to lean as grass does that the wind has
// `blown` so. From straight above, where blades have no length in them, they are not: what is far from a patch's middle would swim.
vec2 sheared(vec3 blown, float slope) {
    float steeper = slope * slope / (TOO_STEEP * TOO_STEEP), leant = 1.0 / (1.0 + steeper * steeper);
    return leant * TIPS * blown.xy * max(slope, slopes[0]) / (max(tall, LEAST) * blown.z);
}

// A way over the ground, as images have it in which blades stand upright that lean so.
vec2 leant_back(vec2 way, vec2 heading, vec2 leans) {
    return way - leans * dot(way, heading) / max(1.0 + dot(leans, heading), SHORTEST);
}

// Where in the images of two slopes something is, how finely they are read, and how broad a pixel is across its blades, in
// patches.
struct Reading {
    vec2 low;
    vec2 high;
    float level;  // of the mip-maps
    float across;
};

// What is read of the images of a cell, turned to the line of sight. `seen` is of elevation_seen.
Reading reading(ivec2 cell, vec2 heading, vec2 turn, vec3 blown, vec2 seen, float slope, float on_level) {
    vec2 leans = sheared(blown, on_level), beside = vec2(-heading.y, heading.x);
    vec2 at = leant_back((place.xz - blown.xy) / patch_side - vec2(cell) - 0.5, heading, leans);
    // From the side blades are drawn out along the line of sight as they are seen, and not as at the slopes of the images.
    vec2 longer = max(on_level, FLATTEST) / vec2(slopes[int(seen.x)], slopes[int(seen.x) + 1]) - 1.0;
    longer *= dot(at, heading) * (1.0 - smoothstep(ROOTS_SEEN.x, ROOTS_SEEN.y, on_level));
    // From a low angle a pixel is a long stripe of ground, but blades are drawn out as far: what counts is how broad it is
    // across them.
    vec2 dx = leant_back(dFdx(place.xz), heading, leans) / patch_side, dy = leant_back(dFdy(place.xz), heading, leans) / patch_side;
    float across = max(max(abs(dot(dx, beside)), abs(dot(dy, beside))), 1e-6);
    // Over a crest a line of sight meets plants one by one, as on level ground.
    float finer = SHARP * clamp(slope / on_level, 0.25, 1.0) * inversesqrt(max(1.0 + dot(leans, heading), SHORTEST));
    float level = log2(across * finer * float(textureSize(images, 0).x));
    return Reading(rotated(at + heading * longer.x, turn) + 0.5, rotated(at + heading * longer.y, turn) + 0.5, level, across);
}

// How far what is read is from its mean, of how far it is in images, of grass that stands so high, of its height at rest.
float grain_of(Reading read, vec2 seen, float slope, float upright) {
    float steep = smoothstep(0.05, 0.3, slope), above = smoothstep(0.0, 2.0, slope);
    float tufts = smoothstep(TUFTS.x, TUFTS.y, read.across * patch_side);
    float filtered = clamp(log2(read.across * float(textureSize(images, 0).x)) + 0.4, 0.0, 1.0);
    // Two images are flatter once they are mixed: as much is put back (Heitz and Neyret, High-Performance By-Example Noise,
    // 2018). From the side they have nothing to do with one another; from above they show the same tufts.
    float alike = seen.x < float(SLOPES - 2) ? 0.0 : ALIKE, other = 1.0 - seen.y;
    float mixed = seen.y * seen.y + other * other + 2.0 * alike * seen.y * other;
    float grain = mix(1.0, mix(GRAIN, mix(GRAIN_ABOVE.x, GRAIN_ABOVE.y, tufts), steep), filtered) * inversesqrt(mixed);
    grain *= 1.0 - max(EVENER * above * (1.0 - stands) / LODGED, EVENER_ASIDE * (1.0 - above) * (1.0 - upright));
    // Far away a pixel is higher than what can be told apart in the grass: it is the mean of several.
    return grain * mix(inversesqrt(1.0 + read.across * patch_side / (FEATURE * max(tall, LEAST))), 1.0, steep);
}
