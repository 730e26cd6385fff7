// How the grass of the carpet stands at a corner of the mesh, and where the carpet lies over it.
#include "systems/show/carpet/border.glsl"
#include "systems/show/carpet/lit.glsl"
#include "systems/show/carpet/mesh.glsl"
#include "systems/show/carpet/sight.glsl"
#include "lib/mown.glsl"
#ifdef TRODDEN
#include "systems/press/press.glsl"
#endif

const float STOPPED = 0.6;  // how deep a line of sight comes in the grass before it is stopped, of its height: about
const float FARTHEST = 5.0; // how much farther ahead ground is looked at, at most, than close by
const float NEAR_CELLS = 4.0;  // how far off that is, in cells of the terrain
const float LIES = 0.05;  // how high the carpet lies where all grass does, of its height
const float UNCUT = 1e9;      // where all stands: above all grass [m]
const float SPARSEST = 0.02;  // density of grass that tells a corner what grows about it
const float EDGE = 0.01;    // a corner counts as on both sides of a patch's edge that is so near [m]

uniform ByKind raised; // by kind: height of the carpet above the ground [m]

struct Laid {
    float ground;  // height of the ground [m]
    float share;   // how much of what is seen is carpet's
    ByKind grows;  // how densely each kind grows
    float left;    // up to which height it is left to stand [m]
    float tall;    // height of the carpet [m]
    float tops;    // height of the tops that stand out against what is behind a crest, of that
    float lies;    // what is left of that where grass is trodden
    float lowered; // how much lower it lies than where no strips stand [m]
    float dense;   // leaf area seen from the side, of the ground's area
    vec2 rise;     // of the ground, along x and z
    float crest;   // how fast the rise falls off along the line of sight [1/m]
    float stands;  // how high the grass stands, of its height at rest
    vec2 message;  // the wind's
    float slope;   // of the line of sight, to the ground
    float along;   // how far it passes over a crest there
    float past;    // what a line of sight meets that passes over a rim, as past_rim has it
};

float lowest_share(vec2 place) {
    ivec2 low = ivec2(floor((place - EDGE) * patches_a_metre)), high = ivec2(floor((place + EDGE) * patches_a_metre));
    return min(min(share_at(low), share_at(high)), min(share_at(ivec2(low.x, high.y)), share_at(ivec2(high.x, low.y))));
}

// How high grass stands that a message bends, of its height at rest.
float standing(ByKind grows, vec2 message) {
    ByKind area = areas(grows);
    float high = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        high += OF(area, kind) * lodged(bending(kind, message));
    return total(area) > TINY ? high / total(area) : 1.0;
}

// How fast the rise of the ground falls off along a line of sight of some slope [1/m]: where it is, or where it goes on through
// the grass, if ground falls away from it there. The ground is `here` so high [m].
float curved_at(vec2 place, float here, vec2 rise, float slope, float tall) {
    float near_by = max(NEAR_CELLS * terrain_cell, 2.0 * spaced);
    float far = clamp(STOPPED * tall / max(slope, FLATTEST), near_by, FARTHEST * near_by);
    vec2 way = heading_to(place);
    float bulges = (2.0 * here - height_at(place + way * near_by) - height_at(place - way * near_by)) / (near_by * near_by);
    float falls = 2.0 * (here + dot(rise, way) * far - height_at(place + way * far)) / (far * far);
    return max(bulges, falls);
}

vec2 rising_at(vec2 at) {
    vec2 step = vec2(max(terrain_cell, spaced), 0.0);
    return vec2(height_at(at + step.xy) - height_at(at - step.xy), height_at(at + step.yx) - height_at(at - step.yx)) / (2.0 * step.x);
}

const int ABOUT = 5, ALL_ABOUT = 9;  // a corner of the mesh, its neighbours before, behind and beside it, and aslant

vec2 about(vec2 place, int number) {
    ivec2 aslant = ivec2(number - ABOUT) >> ivec2(0, 1) & 1, straight = ivec2(number > 2, number == 1 || number == 2);
    vec2 way = number < ABOUT ? vec2(straight) * (number % 2 == 0 ? 1.0 : -1.0) : vec2(aslant) * 2.0 - 1.0;
    return place + way * spaced;
}

#ifdef EDGED
// The grass of a corner of the mesh, where pixels see how much of it there is: the densest about.
ByKind densest_about(vec2 place) {
    ByKind densest = all_kinds(0.0);
    for (int number = 0; number < ABOUT; number++) {
        ByKind grows = grows_at(about(place, number));
        if (total(grows) > total(densest))
            densest = grows;
    }
    return total(densest) > SPARSEST ? densest : all_kinds(1.0 / float(KINDS));
}
#endif

// How high the carpet lies where grass is trodden about a corner of the mesh, of its height: the lowest, so that what a game
// lays there lies free. Where all of it lies, its top is as low as the ground, but for blades that lie over one another.
float lies_about(vec2 place, ByKind grows) {
    float lowest = 1.0;
#ifdef TRODDEN
    ByKind area = areas(grows);
    float all = max(total(area), TINY);
    for (int number = 0; number < ALL_ABOUT; number++) {
        vec2 at = about(place, number);
        if (!trodden_at(at))
            continue;
        float stands_up = 0.0;
        for (int kind = 0; kind < KINDS; kind++) {
            vec2 bend = bending(kind, pressing(at, kind));
            stands_up += OF(area, kind) * max(1.0 - dot(bend, bend), 0.0);
        }
        lowest = min(lowest, max(stands_up / all, LIES));
    }
#endif
    return lowest;
}

const float TALLEST = 4.0;  // power by which taller kinds count more, of which a few are enough to hide what is behind a crest

// How high the tops of all kinds are that are seen over a crest, of their mean height.
float tops_of(ByKind grows, float left) {
    float sum = 0.0, mean = 0.0, all = max(total(grows), TINY);
    for (int kind = 0; kind < KINDS; kind++) {
        float high = min(OF(raised, kind), left);
        mean += OF(grows, kind) * high;
        sum += OF(grows, kind) * pow(high, TALLEST);
    }
    return mean > TINY ? pow(sum / all, 1.0 / TALLEST) * all / mean : 1.0;
}

// How grass grows and stands at a corner of the mesh.
void sow(inout Laid laid, vec2 place) {
#ifdef EDGED
    laid.grows = densest_about(place);
    laid.left = UNCUT;
    laid.tall = 0.0;
    for (int kind = 0; kind < KINDS; kind++)
        laid.tall = max(laid.tall, OF(raised, kind));
#else
    laid.grows = grows_at(place);
    laid.left = anything_is_cut() ? left_about(place, spaced) : UNCUT;
    laid.tall = 0.0;
    for (int group = 0; group < GROUPS; group++)
        laid.tall += dot(laid.grows[group], min(raised[group], laid.left));
    laid.tall /= max(total(laid.grows), 1.0);
#endif
    laid.tops = tops_of(laid.grows, laid.left);
    laid.lies = lies_about(place, laid.grows);
    laid.dense = weighed(laid.grows, areas(leaves_left(laid.left)));
}

#include "systems/show/carpet/rim.glsl"

// How grass stands at a place of the ground, which is raised to the carpet.
Laid laid_on(inout vec3 place) {
    Laid laid;
    laid.ground = place.y;
    laid.share = lowest_share(place.xz);
    sow(laid, place.xz);
    laid.rise = rising_at(place.xz);
    float high = laid.share * laid.tall * laid.lies;
    place.y += high;
    laid.crest = curved_at(place.xz, laid.ground, laid.rise, viewing_slope(laid.rise, place), laid.tall);
    laid.message = message_at(place.xz);
    laid.stands = standing(laid.grows, laid.message);
    float deep = deepest(max(viewing_slope(laid.rise, place), 0.0), laid.crest, laid.tall * laid.stands);
    float lifts = lifted(deep, laid.crest, laid.stands);
    laid.along = along_outline(deep, laid.crest);
    float at_rim = lifted(0.0, BULGES, laid.stands);
    laid.past = past_rim(place + vec3(0.0, high * (at_rim - 1.0), 0.0), laid.ground, laid.tall * laid.stands / RAISED);
    lifts = laid.past < NO_RIM ? at_rim : lifts;
    place.y += high * (lifts - 1.0);
    laid.lowered = (1.0 - laid.share) * laid.tall * laid.lies * lifts;
    laid.slope = viewing_slope(laid.rise, place);
    return laid;
}

const vec2 LOW = vec2(0.1, 0.4);  // slopes of lines of sight up to which it counts where they meet the ground, and no more

// The ground that is seen between blades: from a low angle it lies metres behind, where lines of sight come out of the grass.
vec3 seen_behind(vec3 place, float ground, float slope) {
    float over = max(place.y - ground, 0.0) * (1.0 - smoothstep(LOW.x, LOW.y, slope));
    return on_ground(place.xz + heading_to(place.xz) * min(over / max(slope, LOWEST), FARTHEST_SEEN));
}

// How each kind grows at a place of the ground that is seen from a corner of the mesh.
ByKind grown_at(vec2 place, Laid laid) {
#ifdef EDGED
    return laid.grows;
#else
    return grows_at(place);
#endif
}
