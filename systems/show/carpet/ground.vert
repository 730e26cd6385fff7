// One instance is one square tile of the ground; its grid slides into the next coarser one with distance, so that
// tiles of different fineness meet without cracks.
#include "lib/light.glsl"
#include "lib/terrain.glsl"

in vec2 corner;  // of the grid, 0 .. GRID
in vec4 tile;    // x, z [m]; spacing [m]; distance at which the next coarser spacing has taken over [m]

out vec3 place;

#ifdef CARPET  // with UNDER, an opaque layer beneath the carpet, which the tips of outlines stand out from
#include "systems/show/carpet/border.glsl"
const float SUNK = 2.5;  // leaves that a line of sight has met where nothing is seen through them
const float THROUGH_CREST = 1.6;  // the same over a crest, as the reference shows it
const float LAIN = 0.9;  // how much deeper the layer beneath is sunk along an outline where grass lies: tips stand out there, too
const vec2 BEHIND = vec2(0.01, 0.05);  // slopes at which ground falls away from the eye: hardly, and wholly
const float SHADED = 0.6;  // how far down what is seen stands, of how deep is seen into the grass
uniform ByKind raised; // by kind: height of the carpet above the ground [m]

out float carpet;
out vec2 rise;   // of the ground, along x and z
out ByKind met;  // by kind: how much of what a line of sight meets
#if KINDS > 4
ByKind tipped;
#else
out ByKind tipped;// by kind: how much of its tips is met, of what its images show
#endif
#ifdef HEADS
out ByKind riper;// by kind: how much more of its heads than an image shows; all the others at 1, none at -1
#endif
out float crest; // how fast the rise falls off along the line of sight [1/m]
out float tall;  // height of the grass [m]
out float dense; // leaf area seen from the side, of the ground's area
#include "systems/show/carpet/lit.glsl"
#if KINDS > 4 || defined(UNDER)
float stands;
#else
out float stands; // how high it stands, of its height at rest
#endif
#ifndef UNDER
#if KINDS > 4
float strips_before;
#else
out float strips_before;  // how much strips show of what lines of sight come through above the carpet
#endif

out vec3 direct;  // light on leaves of the kinds that are met: the sun's
out vec3 open_to; // the sky's
out vec4 reach;   // what they mirror; leaves that the sun's light meets; leaf area above them, and from there to the ground
out float lies;   // how many more leaves are met, for how grass is bent
#if KINDS > 4
vec3 dry;
#else
out vec3 dry;     // factor of their pigment
#endif

// Write the light on what is met.
void light_up(float slope, vec2 message) {
    vec3 there = seen_at(place, slope, tall, dense);
    Lie here = lie_at(there.xz);
    vec2 messages[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        messages[kind] = message;
    Sum sum = summed(met, slope, there, here, messages);
    direct = sum.direct;
    open_to = sum.open_to;
    reach = sum.shade;
    lies = sum.lies;
    dry = stretch_seen(there, slope, tall);
}
#endif

#ifdef HEADS
uniform ByKind bears;  // by kind: whether it has any heads
uniform vec2 profile[KINDS * (HEIGHTS + 1)];  // by kind and height: how much of its leaf area is above that; of heads
#endif

// What is met of each kind, as parts of all the grass that there is.
#ifdef UNDER
ByKind shared_out(ByKind met, ByKind grows, float slope) {
    float all = max(total(met), 1e-6), least = min(total(grows), 1.0);
    for (int group = 0; group < GROUPS; group++)
        met[group] = met[group] / all * least;
    return met;
}
#else
// Images show how much a kind hides where it grows densely and alone. A line of sight that meets half of its leaves is
// stopped by more than half as many, and leaves of two kinds stop more than either.
ByKind shared_out(ByKind met, ByKind grows, float slope) {
    float all = max(total(met), 1e-6), alone = 0.0, area = total(areas(grows));
    for (int kind = 0; kind < KINDS; kind++) {
        float shows = 1.0 - exp(-OF(leaf, kind) / slope);
#ifdef HEADS
        shows = OF(bears, kind) > 0.0 ? 1.0 : shows;  // its image is taken in parts of its mean
#endif
        alone += OF(met, kind) / all * shows;
    }
    float hides = (1.0 - exp(-area / slope)) / max(alone, 1e-4);
    for (int group = 0; group < GROUPS; group++)
        met[group] = met[group] / all * hides;
    return met;
}
#endif

const vec2 LOW = vec2(0.1, 0.4);  // slopes of lines of sight up to which it counts where they meet the ground, and no more
const float GRAZING = 0.005;  // a line of sight counts as at least so steep, for the kinds that it meets

// How much of what a line of sight meets is of each kind: taller kinds hide the others at a low angle. The grass is
// taken in layers from the top, up to `below` of its height; its leaf area falls off linearly with height, except among
// kinds of which some bear heads: those bring the profiles of theirs.

#ifdef HEADS
const int LAYERS = 12;

// How much of a kind's leaf area is above a height, of its canopy's: in all, and of heads.
vec2 profile_above(int kind, float height) {
    float at = min(height / HIGHEST, 1.0) * float(HEIGHTS);
    int low = min(int(at), HEIGHTS - 1), own = kind * (HEIGHTS + 1) + low;
    return mix(profile[own], profile[own + 1], at - float(low));
}

// The same with the heads that some kinds have. How much more of them is met than an image shows, where such a kind grows
// alone, -1 to 1, is written to `riper`.
ByKind kinds_met(ByKind grows, float slope, float left, float below) {
    float top = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(grows, kind) > 0.004 ? OF(crown, kind) * HIGHEST : 0.0);
    top = min(top, left);
    ByKind met = all_kinds(0.0), of_heads = met, alone = met, heads_alone = met, through_alone = all_kinds(1.0);
    float through = 1.0, image_slope = max(slope, LOWEST), from = 1.0;
    below /= mix(HIGHEST, 1.0, smoothstep(0.9, 1.0, below));  // strips take away from the canopy, not from lone heads above it
    vec2 above[KINDS];
    for (int kind = 0; kind < KINDS; kind++)
        above[kind] = profile_above(kind, top / OF(crown, kind));
    for (int layer = 1; layer <= LAYERS; layer++) {
        // The lower a line of sight, the more it meets in the topmost.
        float part = float(layer) / float(LAYERS), to = 1.0 - part * part;
        float inside = clamp((below - to) / (from - to), 0.0, 1.0);
        ByKind stop = all_kinds(0.0), some = stop;
        for (int kind = 0; kind < KINDS; kind++) {
            vec2 above_here = profile_above(kind, to * top / OF(crown, kind)), here = above_here - above[kind];
            above[kind] = above_here;
            OF(stop, kind) = here.x * OF(leaf, kind);
            OF(some, kind) = here.y / max(here.x, 1e-6);
        }
        from = to;
        float sum = weighed(stop, grows), stopped = through * (1.0 - exp(-inside * sum / slope));
        for (int group = 0; group < GROUPS; group++) {
            vec4 share = stopped * stop[group] * grows[group] / max(sum, 1e-6);
            vec4 stopped_alone = through_alone[group] * (1.0 - exp(-stop[group] / image_slope));
            met[group] += share;
            of_heads[group] += share * some[group];
            alone[group] += stopped_alone;
            heads_alone[group] += stopped_alone * some[group];
            through_alone[group] -= stopped_alone;
        }
        through -= stopped;
    }
    for (int group = 0; group < GROUPS; group++) {
        vec4 seen = of_heads[group] / max(met[group], 1e-6), usual = heads_alone[group] / max(alone[group], 1e-6);
        vec4 more = seen - usual;
        riper[group] = mix(more / max(usual, 1e-3), more / max(1.0 - usual, 1e-3), greaterThan(seen, usual));
    }
    return shared_out(met, grows, slope);
}
#else
ByKind kinds_met(ByKind grows, float slope, float left, float below) {
    float top = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        top = max(top, OF(grows, kind) > 0.004 ? OF(crown, kind) : 0.0);
    top = min(top, left) * below;
    ByKind met = all_kinds(0.0);
    float through = 1.0;
    for (int layer = 0; layer < 4; layer++) {
        float height = top * (0.875 - 0.25 * float(layer));
        ByKind stop = all_kinds(0.0);
        for (int kind = 0; kind < KINDS; kind++) {
            float canopy_height = OF(crown, kind);
            OF(stop, kind) = OF(grows, kind) * OF(leaf, kind) * 2.0 * max(1.0 - height / canopy_height, 0.0) * top / canopy_height;
        }
        float sum = total(stop);
        float stopped = through * (1.0 - exp(-0.25 * sum / slope));
        for (int group = 0; group < GROUPS; group++)
            met[group] += stopped * stop[group] / max(sum, 1e-6);
        through -= stopped;
    }
    return shared_out(met, grows, slope);
}
#endif

// How high grass stands that a message bends, of its height at rest.
float standing(ByKind grows, vec2 message) {
    ByKind area = areas(grows);
    float high = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        high += OF(area, kind) * lodged(bending(kind, message));
    return total(area) > 1e-4 ? high / total(area) : 1.0;
}

// Up to which height a line of sight has met no strips, of the grass's height: where strips stand out of the carpet, it has
// met the tops of grass on them.
float left_by_strips(float met_carpet) {
    // Where the carpet itself gives way to strips, these leave more to it than their heights tell.
    return mix(1.0, mix(RAISED, 1.0, met_carpet), carpet * carpet * carpet * carpet);
}

const float STOPPED = 0.6;  // how deep a line of sight comes in the grass before it is stopped, of its height: about
const float FARTHEST = 5.0; // how much farther ahead ground is looked at, at most, than close by

// How fast the rise of the ground falls off along a line of sight of some slope [1/m]: where it is, or where it goes on through
// the grass, if ground falls away from it there.
float curved_at(vec2 place, vec2 rise, float slope) {
    float near_by = max(4.0 * terrain_cell, 2.0 * tile.z), here = height_at(place);
    float far = clamp(STOPPED * tall / max(slope, 0.005), near_by, FARTHEST * near_by);
    vec2 way = normalize(place - eye.xz + 1e-4);
    float bulges = (2.0 * here - height_at(place + way * near_by) - height_at(place - way * near_by)) / (near_by * near_by);
    float falls = 2.0 * (here + dot(rise, way) * far - height_at(place + way * far)) / (far * far);
    return max(bulges, falls);
}

#ifndef UNDER
const float UNEVENNESS = 0.4;

// How much higher or lower the carpet lies where it gives way to strips, of the grass's height. A row of strips that lies as
// the carpet does would come out of it all at once; so it does here and there.
float uneven(vec2 place) {
    return UNEVENNESS * sin(5.3 * place.x + 0.7) * sin(4.7 * place.y + 0.2 * place.x);
}
#endif

float lowest_share(vec2 place) {
    ivec2 low = ivec2(floor((place - 0.01) / patch_side)), high = ivec2(floor((place + 0.01) / patch_side));
    return min(min(share_at(low), share_at(high)), min(share_at(ivec2(low.x, high.y)), share_at(ivec2(high.x, low.y))));
}
#endif

#if !defined(MOWN) || defined(UNDER)
out vec3 soil_seen;  // its radiance
#else
vec3 soil_seen;
#endif
#ifdef MOWN
out vec3 sunlit;    // radiance of the soil without any grass: the sun's
out vec3 skylit;    // the sky's
out vec2 to_light;  // how many leaves their light meets
#endif
// No more than 60 numbers are sure to come through: with many kinds, pixels work out themselves what they can.
#if KINDS > 4
ByKind leaf_area;
vec4 veil;
vec3 lush;
#else
#ifdef MOWN
out ByKind leaf_area; // by kind, of the ground's
#endif
out vec4 veil;  // haze before it, and how much
out vec3 lush;  // pigment of the understorey, of that of the ground between
#endif

void main() {
    vec2 flat_at = tile.xy + corner * tile.z;
    float slide = clamp(distance(flat_at, eye.xz) / tile.w * 4.0 - 3.0, 0.0, 1.0);
    flat_at -= fract(corner * 0.5) * 2.0 * tile.z * slide;
    place = vec3(flat_at, height_at(flat_at)).xzy;
#ifdef CARPET
    carpet = lowest_share(flat_at);
    ByKind grows = grows_at(flat_at);
#ifdef MOWN
    float left = left_about(flat_at, tile.z);
    dense = weighed(grows, areas(leaves_left(left)));
#else
    const float left = 1e9;
    dense = total(areas(grows));
#endif
    tall = 0.0;
    for (int group = 0; group < GROUPS; group++)
        tall += dot(grows[group], min(raised[group], left));
    tall /= max(total(grows), 1.0);
    vec2 step = vec2(max(terrain_cell, tile.z), 0.0);
    rise = vec2(height_at(flat_at + step.xy) - height_at(flat_at - step.xy),
                height_at(flat_at + step.yx) - height_at(flat_at - step.yx)) / (2.0 * step.x);
    place.y += carpet * tall;
    crest = curved_at(flat_at, rise, viewing_slope(rise, place));
    vec2 message = message_at(flat_at);
    stands = standing(grows, message);
    float deep = deepest(max(viewing_slope(rise, place), 0.0), crest, tall * stands);
    place.y += carpet * tall * (lifted(deep, crest, stands) - 1.0);
#ifndef UNDER
    place.y += carpet * (1.0 - carpet) * tall * uneven(flat_at);
#endif
#ifdef UNDER
    // It lies as deep in the grass as is seen into it: from above, and through a crest of this curvature.
    float sunk = sqrt(SUNK * max(viewing_slope(rise, place), 0.0) / max(dense, 1e-3));
    float over_crest = stands * pow(THROUGH_CREST * sqrt(2.0 * max(crest, 0.0) * tall * stands) / (CREST * max(dense, 1e-3)), 0.667);
    over_crest += LAIN * (1.0 - stands) * clamp(crest / BULGES, 0.0, 1.0) * clamp(1.0 - viewing_slope(rise, place) / BEHIND.y, 0.0, 1.0);
    float behind = clamp((-viewing_slope(rise, place) - BEHIND.x) / (BEHIND.y - BEHIND.x), 0.0, 1.0);  // nobody sees it
    behind *= clamp(4.0 * (eye.y - place.y), 0.0, 1.0);  // from within the grass, what stands around is seen
    sunk = max(clamp(max(sunk, over_crest), 0.05, 1.0), behind);
    place.y -= carpet * tall * sunk;
#endif
    float slope = max(viewing_slope(rise, place), GRAZING);
    vec2 came = come_through(flat_at, slope, carpet, tall, stands);
    float on_level = max(level_slope(max(viewing_slope(rise, place), 0.0), crest, carpet, tall, stands), GRAZING);
    met = kinds_met(grows, on_level, left, left_by_strips(1.0 - came.x));
    tipped = tips_met(grows, on_level);
#ifndef UNDER
    strips_before = came.x;
    light_up(viewing_slope(rise, place), message);
#endif
#endif
    vec2 ground_at = flat_at;
#ifdef CARPET
    // Between blades ground is seen that lies behind, where lines of sight come out of the grass: from a low angle, metres.
    float over = max(place.y - height_at(flat_at), 0.0) * (1.0 - smoothstep(LOW.x, LOW.y, slope));
    ground_at += normalize(flat_at - eye.xz + 1e-4) * min(over / max(slope, STEEP), FARTHEST_SEEN);
#endif
    vec3 ground = vec3(ground_at, height_at(ground_at)).xzy;
    Lie lies = lie_at(ground_at);
    ByKind stand = grows_at(ground_at);
#ifdef MOWN
#ifdef CARPET
    leaf_area = areas(grows);
#else
    leaf_area = areas(stand);
#endif
    soil_seen = soil_light(ground, lies, stand, weighed(leaf_area, leaves_left(left_about(flat_at, tile.z))));
    vec3 pigment = soil_pigment(lies, stand);
    sunlit = pigment * pigment * sunlight * (SOIL_SENDS * lies.high * sun_seen(ground, lies.past));
    skylit = pigment * pigment * skylight;
    to_light = vec2(sun_way(0, lies.high), OPEN_SKY);
#else
    soil_seen = soil_light(ground, lies, stand, total(areas(stand)));
#endif
    lush = understorey_of(lies, stand);
#ifdef UNDER
    vec3 usual = lying_pigment(textureLod(repeating, vec2(0.5), COARSEST).gb, lush);
    soil_seen *= usual * usual;
    vec3 under = vec3(0.0);
    Lie here = lie_at(flat_at);
    for (int kind = 0; kind < KINDS; kind++) {
        Light lit = light_on(kind, vec2(0.0), place, here, grows);
        float deep = 0.1 + SHADED * sunk, high = 0.9 - SHADED * sunk;
#ifdef MOWN
        lit = mown_to(left, lit, kind, leaf_area);
        high *= min(left / max(OF(crown, kind), 0.01), 1.0);
        deep = 1.0 - high;
#endif
        vec3 pigment = mix(mix(kinds[kind].root, kinds[kind].tip, kinds[kind].bloom), kinds[kind].root, deep) * stretch(here.slow);
        under += OF(met, kind) * shade(leaf_at(pigment, high), lit);
    }
    // Where grass grows thinly or not at all, what lies beneath is the soil.
    soil_seen = mix(soil_seen, soil_seen * (1.0 - total(met)) + under, carpet);
#endif
    veil = vec4(haze_light(place), haze_at(place));
    gl_Position = clip * vec4(place, 1.0);
#ifdef UNDER
    gl_Position.z += 1e-6 * gl_Position.w;  // kilometres away depths are too coarse to part the two layers
#endif
}
